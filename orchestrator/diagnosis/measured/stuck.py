"""A channel that stands still to the last bit while it should not."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.measured.landing import Series
from orchestrator.diagnosis.measured.noise import noise, quantum, runs

Array = NDArray[np.float64]
LONG = 20  # samples
LONG_SHARE = 0.1  # of the record
MOVES = 10.0  # sigma, that another channel of the series moves meanwhile, or this one did before
COARSE = 0.5  # of sigma: a channel quantised so stands still when at rest, whatever the noise
FINE = 1e-3  # of sigma: a channel quantised so stands still when at rest without noise
NOISY = 0.2  # of sigma: below it the data are taken to be without noise


class Frozen(NamedTuple):
    """A value that does not change, from when to when."""

    value: float
    from_s: float
    to_s: float


def stuck(one: Series, place: int) -> Frozen | None:
    """The longest still stretch of a channel, if it is a fault.

    With noise in the data a channel that stands still is stuck, unless it is quantised more coarsely than its noise. Without noise it is
    stuck if it moved before, or stands elsewhere than at zero, while another channel of the series moves by many sigma: a vehicle at
    rest, or in free flight about one axis, holds all its rates.
    """
    valid = one.mask[:, place]
    times, values = one.times[valid], one.values[valid, place]
    first, last = _longest(values)
    if last - first < max(LONG, LONG_SHARE * len(values)):
        return None
    frozen = Frozen(float(values[first]), float(times[first]), float(times[last - 1]))
    sigma = float(one.sigma[place])
    rest = np.delete(values, slice(first, last))
    step = max(quantum(one.values[one.mask[:, k], k]) for k in range(len(one.channels)))
    if step > COARSE * sigma:
        return None
    if _is_noisy(one, place, np.delete(times, slice(first, last)), rest):
        return frozen
    if step > FINE * sigma:
        return None
    moved = first > 0 and np.ptp(values[:first]) > MOVES * sigma
    others_move = any(_moves(one, k, frozen) for k in range(len(one.channels)) if k != place)
    return frozen if others_move and (moved or (frozen.value != 0.0 and len(rest) == 0)) else None


def _longest(values: Array) -> tuple[int, int]:
    stretches = [(first, last + 1) for first, last in runs(np.diff(values) == 0.0)]
    return max(stretches, key=lambda it: it[1] - it[0], default=(0, 0))


def _is_noisy(one: Series, place: int, times: Array, rest: Array) -> bool:
    """Whether the rest of the channel carries noise, or, where there is none, every other channel of the series."""
    if len(rest) >= 2 * LONG:
        level, is_noise = noise(times, rest)
        return is_noise and level > NOISY * one.sigma[place]
    others = [k for k in range(len(one.channels)) if k != place]
    levels = [noise(one.times[one.mask[:, k]], one.values[one.mask[:, k], k]) for k in others]
    return bool(others) and all(it.is_noise and it.level > NOISY * one.sigma[k] for it, k in zip(levels, others, strict=True))


def _moves(one: Series, place: int, frozen: Frozen) -> bool:
    meanwhile = one.mask[:, place] & (one.times >= frozen.from_s) & (one.times <= frozen.to_s)
    values = one.values[meanwhile, place]
    return len(values) > 1 and bool(np.ptp(values) > MOVES * one.sigma[place])
