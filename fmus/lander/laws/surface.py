"""The surface as a thing of its own: how far a point is below it, and its normal there. A plane, for now."""

from math import cos, sin
from typing import NamedTuple

from .compiled import jit
from .vectors import Vector, dot, sub


class Surface(NamedTuple):
    """An inclined plane in L through `origin` (m) with unit `normal`."""

    origin: Vector
    normal: Vector


def inclined_plane(slope: float, azimuth: float, origin: Vector = (0.0, 0.0, 0.0)) -> Surface:
    """Plane with normal N = Rx(azimuth) Ry(slope) x̂, angles in rad: at azimuth 0 the ground rises toward +Z (physics.md)."""
    c, s = cos(slope), sin(slope)
    return Surface(origin, (c, s * sin(azimuth), -s * cos(azimuth)))


@jit
def normal_at(surface: Surface, x: Vector) -> Vector:
    """Unit normal of the surface nearest to the point x (m, L)."""
    return surface.normal


@jit
def depth_at(surface: Surface, x: Vector) -> float:
    """Depth of the point x below the surface along its normal, m; negative above."""
    return -dot(surface.normal, sub(x, surface.origin))


@jit
def gap_at(surface: Surface, x: Vector) -> float:
    """Height of the point x above the surface along L's vertical, m; negative below."""
    return -depth_at(surface, x) / surface.normal[0]
