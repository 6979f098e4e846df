"""The surface as a thing of its own: how far a point is below it, and its normal there.

A plane, and on it a relief where there is one. Over the relief a point meets the tangent plane under it (decision 12): N is the normal at
the point's own (Y, Z), its depth is δ = (h - X) N_X, which for a plane is the distance.
"""

from math import cos, sin
from typing import NamedTuple

from .compiled import jit
from .height import Height, normal_of, sum_of
from .relief import Relief, relief_height
from .vectors import Vector, axpy, dot, sub


class Surface(NamedTuple):
    """An inclined plane in L through `origin` (m) with unit `normal`, and what lies on it.

    Without relief the laws are compiled for the plane alone, and are what they were before there was any.
    """

    origin: Vector
    normal: Vector
    relief: Relief | None = None


def inclined_plane(slope: float, azimuth: float, origin: Vector = (0.0, 0.0, 0.0)) -> Surface:
    """Plane with normal N = Rx(azimuth) Ry(slope) x̂, angles in rad: at azimuth 0 the ground rises toward +Z (physics.md)."""
    c, s = cos(slope), sin(slope)
    return Surface(origin, (c, s * sin(azimuth), -s * cos(azimuth)))


@jit
def height_at(surface: Surface, relief: Relief, x: Vector) -> Height:
    """Height of plane and relief together over the level through L's origin, at the point x (m, L)."""
    n, o = surface.normal, surface.origin
    h_y, h_z = -n[1] / n[0], -n[2] / n[0]
    plane = Height(o[0] + h_y * (x[1] - o[1]) + h_z * (x[2] - o[2]), h_y, h_z, 0.0, 0.0, 0.0)
    return sum_of(plane, relief_height(relief, x[1], x[2]))


@jit(inline=True)
def normal_on(surface: Surface, relief: Relief | None, x: Vector) -> Vector:
    """`normal_at`; numba takes out the branch that a type of relief does not need, from an argument only."""
    if relief is None:
        return surface.normal
    return normal_of(height_at(surface, relief, x))


@jit(inline=True)
def depth_on(surface: Surface, relief: Relief | None, x: Vector) -> float:
    """`depth_at`."""
    if relief is None:
        return -dot(surface.normal, sub(x, surface.origin))
    h = height_at(surface, relief, x)
    return (h.value - x[0]) * normal_of(h)[0]


@jit
def gap_on(surface: Surface, relief: Relief | None, x: Vector) -> float:
    """`gap_at`."""
    if relief is None:
        return -depth_at(surface, x) / surface.normal[0]
    return x[0] - height_at(surface, relief, x).value


@jit
def normal_at(surface: Surface, x: Vector) -> Vector:
    """Unit normal of the surface under the point x (m, L)."""
    return normal_on(surface, surface.relief, x)


@jit
def depth_at(surface: Surface, x: Vector) -> float:
    """Depth of the point x below the surface along its normal, m; negative above."""
    return depth_on(surface, surface.relief, x)


@jit
def gap_at(surface: Surface, x: Vector) -> float:
    """Height of the point x above the surface along L's vertical, m; negative below."""
    return gap_on(surface, surface.relief, x)


@jit
def laid_down(relief: Relief | None, normal: Vector, slide: Vector) -> Vector:
    """A slide (m) made elsewhere, in the tangent plane here; on a plane there is nothing to turn."""
    if relief is None:
        return slide
    return axpy(-dot(normal, slide), normal, slide)
