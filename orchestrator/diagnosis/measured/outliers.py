"""Samples that no motion can have made: lone spikes, and dropouts to exactly zero."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.measured.noise import noise, quantum, runs

Array = NDArray[np.float64]
SPIKE = 20.0  # sigma, robust
ROUGHER = 6.0  # times what the channel does elsewhere within NEAR samples: a motion too fast for the sampling is no spike
NEAR = 12
SIDE = 3  # samples on either side that a spike is held against
FEWEST = 40  # samples, to know what is usual
AGREEMENT = 0.3  # of the spike, within which both sides must agree: a step is no spike
DROPOUT = 10.0  # sigma from zero, on both sides


def spikes(times: Array, values: Array, sigma: float) -> list[tuple[int, float]]:
    """(sample, deviation in sigma) of samples, one or two in a row, that leave their neighbours and come back."""
    n = len(values)
    if n < FEWEST:
        return []
    scale = max(sigma, noise(times, values).level)
    window = np.lib.stride_tricks.sliding_window_view(values, 2 * SIDE + 1)
    left, right = np.median(window[:, :SIDE], axis=1), np.median(window[:, SIDE + 1 :], axis=1)
    deviation = np.zeros(n)
    deviation[SIDE : n - SIDE] = window[:, SIDE] - 0.5 * (left + right)
    apart = np.zeros(n)
    apart[SIDE : n - SIDE] = np.abs(left - right)
    size = np.abs(deviation)
    suspects = np.flatnonzero((size > SPIKE * scale) & (apart < AGREEMENT * size))
    found = []
    for i in suspects:
        around = np.r_[size[max(0, i - NEAR) : max(0, i - SIDE)], size[i + SIDE + 1 : i + NEAR + 1]]
        if size[i] > ROUGHER * np.quantile(around, 0.9, method="lower") and _is_lone(values, int(i), size[i]):
            found.append((int(i), float(size[i] / scale)))
    return found


def _is_lone(values: Array, i: int, size: float) -> bool:
    """Whether all but one of the samples on either side lie together: the peak of a motion has flanks, a spike has none."""
    near = np.sort(np.r_[values[i - SIDE : i], values[i + 1 : i + SIDE + 1]])
    return bool(min(near[-2] - near[0], near[-1] - near[1]) < AGREEMENT * size)


def dropouts(times: Array, values: Array, sigma: float) -> list[tuple[int, int]]:
    """[first, past the last) sample of stretches of exact zeros between samples of one sign that are far from zero, or to the end."""
    step = quantum(values)
    far = DROPOUT * max(sigma, noise(times, values).level, step)
    found = []
    for first, last in runs(values == 0.0):
        before = values[first - 1] if first else 0.0
        after = values[last] if last < len(values) else before
        to_the_end = last == len(values) and last - first >= 5 and step < 0.5 * sigma  # quantised, rest is exactly zero
        if before * after > 0.0 and min(abs(before), abs(after)) > far and (last < len(values) or to_the_end):
            found.append((first, last))
    return found
