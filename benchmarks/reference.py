"""What the quarter vehicle does when nothing is cut: one system of equations, Radau at 1e-11."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from math import cos, pi

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

STOP = 0.3
M, m, k, c, L, g = 1233.0, 11.0, 1e6, 1e4, 1.0, 1.62
K, p, C, RAMP = 150000.0, 1.5, 150000.0, 0.1
START = (L + 0.01, 0.01, -1.0, -1.0)


def soil(position: float, velocity: float) -> float:
    """The force on the pad, N: eqs. 6 and 7 without w_b and w_r, never pulling."""
    depth = -position
    if depth <= 0.0:
        return 0.0
    weight = 0.5 * (1.0 - cos(pi * depth / RAMP)) if depth < RAMP else 1.0
    return max(0.0, K * depth**p - weight * C * velocity)


def rates(_: float, state: Sequence[float]) -> list[float]:
    body, pad, u, v = state
    strut = -k * (body - pad - L) - c * (u - v)
    return [u, v, strut / M - g, (soil(pad, v) - strut) / m - g]


@cache
def trajectory() -> tuple[Callable[[NDArray[np.float64]], NDArray[np.float64]], float]:
    """The pad's position as a function of time, and the peak penetration, m.

    Two integrations that meet at the instant of touchdown, so that no step crosses the kink of the law.
    """
    def touch(_: float, state: Sequence[float]) -> float:
        return state[1]
    touch.terminal = True  # type: ignore[attr-defined]
    options = {"method": "Radau", "rtol": 1e-11, "atol": 1e-13, "dense_output": True}
    fall = solve_ivp(rates, (0.0, STOP), START, events=touch, **options)
    rest = solve_ivp(rates, (fall.t[-1], STOP), fall.y[:, -1], max_step=1e-3, **options)

    def position(times: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.where(times < fall.t[-1], fall.sol(np.minimum(times, fall.t[-1]))[1], rest.sol(np.maximum(times, rest.t[0]))[1])

    fine = np.linspace(rest.t[0], STOP, 30001)
    return position, float(-rest.sol(fine)[1].min())


def error(times: Sequence[float], positions: Sequence[float]) -> float:
    """The largest pad position error over the peak penetration; infinite where a position is not a number."""
    position, peak = trajectory()
    t, x = np.asarray(times), np.asarray(positions)
    inside = t <= STOP + 1e-9
    worst = float(np.abs(x - position(np.minimum(t, STOP)))[inside].max()) / peak
    return worst if np.isfinite(worst) else float("inf")
