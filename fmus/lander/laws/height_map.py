"""A tile of measured heights: bicubic convolution between its nodes, with slope and curvature.

R. G. Keys, Cubic convolution interpolation for digital image processing, IEEE Trans. ASSP 29 (1981), a = -1/2: through the nodes, slope
continuous, exact for polynomials of second order, and local: a missing node is felt in the sixteen cells around it and nowhere else.
"""

from math import floor, nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compiled import jit
from .height import Height

Array = NDArray[np.float64]
Weights = tuple[float, float, float, float]


class HeightMap(NamedTuple):
    """Heights (m) of nodes, rows to the north, columns to the east; nan: missing. The map is turned against L about X."""

    heights: Array  # (rows, columns); (0, 0): none
    north: float  # of the first row from L's origin, m
    east: float  # of the first column
    step_north: float  # between rows, m
    step_east: float  # between columns
    cos: float  # of the heading ψ of L's +Z, clockwise from north
    sin: float


@jit
def weights(t: float) -> tuple[Weights, Weights, Weights]:
    """Of the four nodes about a place at t in [0, 1] between the middle two; of the slope; of the curvature."""
    t2 = t * t
    t3 = t2 * t
    return (
        (-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2),
        (-1.5 * t2 + 2.0 * t - 0.5, 4.5 * t2 - 5.0 * t, -4.5 * t2 + 4.0 * t + 0.5, 1.5 * t2 - t),
        (-3.0 * t + 2.0, 9.0 * t - 5.0, -9.0 * t + 4.0, 3.0 * t - 1.0),
    )


@jit
def cell(place: float, count: int) -> int:
    """The node before a place given in steps from the first; -1 where the four nodes about it are not all there."""
    if not 1.0 <= place <= count - 2.0:
        return -1
    return min(floor(place), count - 3)


@jit
def map_height(m: HeightMap, y: float, z: float) -> Height:
    """Height of the map at (y, z) of L, m; nan outside it and beside a missing node."""
    north, east = z * m.cos - y * m.sin, y * m.cos + z * m.sin
    v, u = (north - m.north) / m.step_north, (east - m.east) / m.step_east
    i, j = cell(v, m.heights.shape[0]), cell(u, m.heights.shape[1])
    if i < 0 or j < 0:
        return Height(nan, nan, nan, nan, nan, nan)
    a, b = weights(v - i), weights(u - j)
    h, h_n, h_e, h_nn, h_ne, h_ee = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for p in range(4):
        row, row_e, row_ee = 0.0, 0.0, 0.0
        for q in range(4):
            node = m.heights[i - 1 + p, j - 1 + q]
            row += b[0][q] * node
            row_e += b[1][q] * node
            row_ee += b[2][q] * node
        h += a[0][p] * row
        h_n += a[1][p] * row
        h_e += a[0][p] * row_e
        h_nn += a[2][p] * row
        h_ne += a[1][p] * row_e
        h_ee += a[0][p] * row_ee
    h_n, h_e = h_n / m.step_north, h_e / m.step_east
    h_nn, h_ne, h_ee = h_nn / m.step_north**2, h_ne / (m.step_north * m.step_east), h_ee / m.step_east**2
    c, s = m.cos, m.sin
    return Height(
        h,
        c * h_e - s * h_n,
        s * h_e + c * h_n,
        c * c * h_ee - 2.0 * c * s * h_ne + s * s * h_nn,
        c * s * (h_ee - h_nn) + (c * c - s * s) * h_ne,
        s * s * h_ee + 2.0 * c * s * h_ne + c * c * h_nn,
    )
