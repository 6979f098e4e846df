"""Height of the ground over a level place, with its slope and curvature: what every part of the relief gives, and what adds up."""

from math import sqrt
from typing import NamedTuple

from .compiled import jit
from .vectors import Matrix, Vector


class Height(NamedTuple):
    """h (m) over the horizontal plane of L, and its derivatives along Y and Z."""

    value: float
    y: float
    z: float
    yy: float  # 1/m
    yz: float
    zz: float


@jit
def sum_of(a: Height, b: Height) -> Height:
    """Heights add, and so do their derivatives."""
    return Height(a.value + b.value, a.y + b.y, a.z + b.z, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz)


@jit
def around(y: float, z: float, r: float, value: float, first: float, over: float, second: float) -> Height:
    """The height of a round thing at (y, z) from its middle, r away: its profile's value, h', h'/r and h''.

    ∇∇h = h'' r̂r̂ᵀ + h'/r (1 - r̂r̂ᵀ); at the middle h'' = h'/r.
    """
    if r < 1e-12:
        return Height(value, 0.0, 0.0, over, 0.0, over)
    a, b = y / r, z / r
    bend = second - over
    return Height(value, first * a, first * b, over + bend * a * a, bend * a * b, over + bend * b * b)


@jit
def normal_of(h: Height) -> Vector:
    """N = (1, -h_y, -h_z)/√(1 + h_y² + h_z²), up."""
    c = 1.0 / sqrt(1.0 + h.y * h.y + h.z * h.z)
    return (c, -c * h.y, -c * h.z)


@jit
def bend_of(h: Height, normal: Vector) -> Matrix:
    """∂N/∂x (1/m), rows N, columns x: (1 - N Nᵀ) ∂g/∂x/|g| with g = (1, -h_y, -h_z); nothing changes along X."""
    c = normal[0]
    by_y = normal[1] * h.yy + normal[2] * h.yz  # -N · ∂g/∂y
    by_z = normal[1] * h.yz + normal[2] * h.zz
    return (
        (0.0, c * normal[0] * by_y, c * normal[0] * by_z),
        (0.0, c * (normal[1] * by_y - h.yy), c * (normal[1] * by_z - h.yz)),
        (0.0, c * (normal[2] * by_y - h.yz), c * (normal[2] * by_z - h.zz)),
    )
