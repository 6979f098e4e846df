"""Signature energy after nuisances: how many sigma squared of an effect the nuisances cannot explain.

λ = s' (1 + J J')⁻¹ s, s the effect's change of the white prediction, J the white slopes by nuisances scaled to unit priors.
Twice the largest gain in log likelihood that naming the effect can bring, to first order.
"""

from __future__ import annotations

from collections.abc import Callable
from math import log

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
CLOSE = 0.04  # of the target
TRIES = 9
BACK = 8


def energy(signature: Array, slopes: Array) -> float:
    """λ of white numbers; s's - s'J (1 + J'J)⁻¹ J's is the same and needs no (n, n) matrix."""
    projected = slopes.T @ signature
    inner = np.eye(slopes.shape[1]) + slopes.T @ slopes
    return float(signature @ signature - projected @ np.linalg.solve(inner, projected))


def scaled_to(target: float, energy_at: Callable[[float], float | None], largest: float) -> tuple[float, float] | None:
    """(k, λ) with λ(k) within 4 per cent of the target, 0 < k ≤ largest; None where λ does not reach it.

    λ grows about as k², saturating where the vehicle hardly moves any more: the secant in logarithms, kept inside a bracket.
    """
    low, high = 0.0, largest
    top = energy_at(high)
    for _ in range(BACK):  # an active law may be too strong to be flown
        if top is not None:
            break
        high *= 0.7
        top = energy_at(high)
    if top is None or top < target * (1.0 - CLOSE):
        return None
    k, now, power = high, top, 2.0
    for _ in range(TRIES):
        if abs(now / target - 1.0) <= CLOSE:
            return k, now
        guess = k * (target / now) ** (1.0 / power) if now > 0.0 else 0.0
        guess = guess if low < guess < high else 0.5 * (low + high)
        there = energy_at(guess)
        if there is None:
            return None
        if now > 0.0 and there > 0.0:
            power = min(max(log(there / now) / log(guess / k), 0.3), 4.0)
        low, high = (guess, high) if there < target else (low, guess)
        k, now = guess, there
    return None
