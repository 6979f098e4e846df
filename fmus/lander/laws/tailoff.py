"""The descent engine's thrust after touchdown: a line that decays to zero, or a table, over time since first contact.

    T(τ) = T_b                       before first contact
    T(τ) = T_0 max(0, 1 - τ/τ_d)     parametric, τ = t - t_contact ≥ 0; τ_d = 0 is a cut-off at once
    T(τ) = table                     linear between points, the first value before the first point, zero after the last

Thrust is positive along +X of the body. Both laws are piecewise linear, so that mean and end value over an interval are exact.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .compiled import jit

Floats = NDArray[np.float64]


@jit
def thrust_points(thrust_start: float, decay_time: float, table_time: Any, table_thrust: Any, table_points: int) -> Any:
    """The corners (τ, T) of the law, by rows; zero holds after the last."""
    if table_points > 0:
        corners = np.empty((table_points, 2))
        for i in range(table_points):
            corners[i, 0] = table_time[i]
            corners[i, 1] = table_thrust[i]
        return corners
    corners = np.zeros((2, 2))
    corners[0, 1] = thrust_start
    corners[1, 0] = decay_time
    return corners


@jit
def thrust(tau: float, corners: Any) -> float:
    """T(τ) for τ ≥ 0, continuous from the right."""
    last = corners.shape[0] - 1
    if tau >= corners[last, 0]:
        return 0.0
    if tau < corners[0, 0]:
        return float(corners[0, 1])
    i = 0
    while tau >= corners[i + 1, 0]:
        i += 1
    share = (tau - corners[i, 0]) / (corners[i + 1, 0] - corners[i, 0])
    return float(corners[i, 1] + share * (corners[i + 1, 1] - corners[i, 1]))


@jit
def impulse(tau: float, corners: Any) -> float:
    """∫ T dτ from zero to τ ≥ 0."""
    total = min(max(tau, 0.0), corners[0, 0]) * corners[0, 1]
    for i in range(corners.shape[0] - 1):
        begin, end = max(corners[i, 0], 0.0), min(tau, corners[i + 1, 0])
        if end > begin:
            width = corners[i + 1, 0] - corners[i, 0]
            rate = (corners[i + 1, 1] - corners[i, 1]) / width
            middle = 0.5 * (begin + end) - corners[i, 0]
            total += (end - begin) * (corners[i, 1] + rate * middle)
    return float(total)


@jit
def mean_thrust(tau: float, step: float, corners: Any) -> float:
    """Mean of T over [τ, τ + step], τ ≥ 0."""
    return float((impulse(tau + step, corners) - impulse(tau, corners)) / step)


@jit
def fitted_slope(tau: float, step: float, corners: Any) -> float:
    """Slope of the straight line nearest to T over [τ, τ + step] in the mean square: 12/h³ ∫ (s - h/2) T ds.

    Where T is linear it is T's own slope; across a corner or a jump it keeps the first moment of the thrust.
    """
    cuts = np.empty(corners.shape[0] + 2)
    cuts[0], cuts[1] = tau, tau + step
    for i in range(corners.shape[0]):
        cuts[i + 2] = min(max(corners[i, 0], tau), tau + step)
    cuts.sort()
    moment = 0.0
    for i in range(cuts.size - 1):
        width = cuts[i + 1] - cuts[i]
        if width > 0.0:
            middle = 0.5 * (cuts[i] + cuts[i + 1])
            value = thrust(middle, corners)
            quarter = thrust(middle + 0.25 * width, corners)
            rate = (quarter - value) / (0.25 * width)
            moment += width * (value * (middle - tau - 0.5 * step) + rate * width * width / 12.0)
    return float(12.0 * moment / step**3)
