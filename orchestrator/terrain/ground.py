"""The ground a run stood on, from what its units were given: for the run's directory and its picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.master.result import UnitRecord
from orchestrator.terrain.hand_over import MAP

Array = NDArray[np.float64]
COPY = "terrain.npy"


@dataclass(frozen=True)
class Ground:
    """Heights (m) over Y and Z of L (m), all of the same shape; of no size without a map. Craters and boulders as rows of numbers."""

    y: Array
    z: Array
    heights: Array
    craters: list[list[float]]
    boulders: list[list[float]]


def ground_of(records: Sequence[UnitRecord]) -> Ground | None:
    """None where no unit was given a relief."""
    given = next((it.parameters for it in records if any(name.startswith("terrain.") for name in it.parameters)), None)
    if given is None:
        return None
    empty = np.zeros((0, 0))
    y, z, heights = _placed(given) if given.get(MAP) else (empty, empty, empty)
    return Ground(y, z, heights, _rows(given, "craters", 5), _rows(given, "boulders", 4))


def repeatable(scenario: Mapping[str, Any], records: Sequence[UnitRecord], folder: Path) -> dict[str, Any]:
    """The scenario with its height map in the run's folder: the tile the units had, to the bit, in place of the file it came from."""
    given = next((it.parameters for it in records if it.parameters.get(MAP)), None)
    if given is None or not isinstance(scenario.get("terrain"), dict) or "file" not in scenario["terrain"]:
        return dict(scenario)
    north, east, step_north, step_east = _numbers(given)
    heights = np.load(str(given[MAP]))
    np.save(folder / COPY, heights[::-1])
    wide = 2.0 * max(abs(north), abs(east), heights.shape[0] * step_north, heights.shape[1] * step_east)
    place = {"file": COPY, "pixel": [step_north, step_east], "unit": "m", "origin": [-east, -north], "extent": wide}
    return {**scenario, "terrain": scenario["terrain"] | place}


def _numbers(given: Mapping[str, Any]) -> tuple[float, float, float, float]:
    north, east = (float(given[f"terrain.map_corner[{i}]"]) for i in (1, 2))
    return north, east, float(given["terrain.map_step[1]"]), float(given["terrain.map_step[2]"])


def _placed(given: Mapping[str, Any]) -> tuple[Array, Array, Array]:
    """Y, Z and height of every node of the map."""
    north, east, step_north, step_east = _numbers(given)
    heights = np.load(str(given[MAP]))
    norths, easts = np.meshgrid(
        north + step_north * np.arange(heights.shape[0]), east + step_east * np.arange(heights.shape[1]), indexing="ij"
    )
    heading = float(given.get("terrain.heading", 0.0))
    return easts * cos(heading) - norths * sin(heading), easts * sin(heading) + norths * cos(heading), heights


def _rows(given: Mapping[str, Any], name: str, width: int) -> list[list[float]]:
    """A vector's elements in rows, those with a size."""
    values = [float(given[f"terrain.{name}[{i}]"]) for i in range(1, len(given) + 1) if f"terrain.{name}[{i}]" in given]
    rows = [values[i : i + width] for i in range(0, len(values) - width + 1, width)]
    return [row for row in rows if row[2] > 0.0]
