"""Relief: what lies over the plane of the ground. A height map, craters and boulders, whose heights add up."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compiled import jit
from .crater import Boulder, Crater, boulder_height, crater_height
from .height import Height, sum_of
from .height_map import HeightMap, map_height

Array = NDArray[np.float64]
LEVEL = Height(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class Relief(NamedTuple):
    """A constant of a run: no part of any state."""

    map: HeightMap
    craters: Array  # (n, 5): columns as in Crater
    boulders: Array  # (n, 4): columns as in Boulder


@jit
def relief_height(relief: Relief, y: float, z: float) -> Height:
    """Height over the plane at (y, z) of L; nan where the map has none."""
    h = map_height(relief.map, y, z) if relief.map.heights.size > 0 else LEVEL
    for k in range(relief.craters.shape[0]):
        row = relief.craters[k]
        h = sum_of(h, crater_height(Crater(row[0], row[1], row[2], row[3], row[4]), y, z))
    for k in range(relief.boulders.shape[0]):
        row = relief.boulders[k]
        h = sum_of(h, boulder_height(Boulder(row[0], row[1], row[2], row[3]), y, z))
    return h
