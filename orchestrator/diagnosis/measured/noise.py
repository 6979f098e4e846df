"""How noisy a channel is, from its own second differences: a motion that is smooth over three samples drops out."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_MEDIAN_OF_ABSOLUTE = 0.6744897501960817  # of the standard normal distribution
WINDOW = 16  # second differences judged together
ALTERNATING = 0.6  # share of sign changes: 0.73 for white noise's second differences, near 0 for a smooth motion


class Noise(NamedTuple):
    """`level` in the channel's unit; `is_noise` where the quieter half of the record alternates as noise does."""

    level: float
    is_noise: bool


def noise(times: Array, values: Array, colour: float = 0.0) -> Noise:
    """From samples without gaps, at any times; `colour` is the noise's AR(1) coefficient, which takes from second differences.

    d_i = x_i - a x_{i-1} - (1-a) x_{i+1}, a from the times; var d = σ² (1 + a² + (1-a)² - 2 ρ (a + (1-a)) + 2 ρ² a (1-a))
    The level is the median over windows of their median |d|, over 0.6745: a contact's jerks do not count.
    """
    if len(values) < WINDOW + 2:
        return Noise(0.0, False)
    differences = second_differences(times, values, colour)
    windows = differences[: len(differences) // WINDOW * WINDOW].reshape(-1, WINDOW)
    medians = np.median(np.abs(windows), axis=1)
    quiet = windows[medians <= np.median(medians)]
    changes = np.mean(quiet[:, 1:] * quiet[:, :-1] < 0.0)
    return Noise(float(np.median(medians) / _MEDIAN_OF_ABSOLUTE), bool(changes > ALTERNATING))


def second_differences(times: Array, values: Array, colour: float = 0.0) -> Array:
    """Deviation of each inner sample from the line through its neighbours, scaled so that noise of level σ gives level σ."""
    a = (times[2:] - times[1:-1]) / (times[2:] - times[:-2])
    b = 1.0 - a
    variance = 1.0 + a * a + b * b - 2.0 * colour + 2.0 * colour * colour * a * b
    scaled: Array = (values[1:-1] - a * values[:-2] - b * values[2:]) / np.sqrt(variance)
    return scaled


def quantum(values: Array) -> float:
    """The smallest difference between two values that occur: the step of a quantised channel, next to nothing of any other."""
    return float(np.diff(np.unique(values)).min(initial=np.inf)) if np.ptp(values) > 0.0 else 0.0


def runs(same: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """[first, past the last) of each stretch of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], same, [False]]).astype(np.int8)))
    return [(int(first), int(last)) for first, last in edges.reshape(-1, 2)]
