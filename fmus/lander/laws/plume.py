"""Ground effect of the engine's plume: the exhaust under the vehicle stagnates and pushes it up as it comes near the ground."""

from math import exp
from typing import NamedTuple

from .compiled import jit


class Plume(NamedTuple):
    """An exponential in height, the simplest law that fades."""

    share: float  # of the thrust, at rest height; 0: none
    height: float  # m, over which it falls to 1/e
    rest_height: float  # of B's origin when the vehicle stands, m


@jit
def plume_force(plume: Plume, thrust: float, position: float) -> float:
    """ΔT = κ T exp(-h/h_0), h = x - x_rest, N, along +X of B. thrust T, N; position x: of B's origin along L's x, m."""
    if plume.share == 0.0:
        return 0.0
    return plume.share * thrust * exp(-(position - plume.rest_height) / plume.height)
