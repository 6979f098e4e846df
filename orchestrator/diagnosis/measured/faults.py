"""Faults of the data themselves, found without a model. Each test is shy: what a landing can do is no fault."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.measured.landing import Measured, Series
from orchestrator.diagnosis.measured.noise import noise
from orchestrator.diagnosis.measured.outliers import dropouts, spikes
from orchestrator.diagnosis.measured.stuck import stuck

Array = NDArray[np.float64]
MISSTATED = 5.0  # the noise may be this many times the stated sigma, or this part of it
NO_NOISE = 0.05  # of the stated sigma, below which the data are simulated or smoothed, and whoever states a sigma knows
GAP = 20.0  # intervals between samples
GAP_SHARE = 0.05  # of the record
ENOUGH = 20  # samples, below which a channel is not judged


@dataclass(frozen=True)
class Fault:
    """One line for the report: what is wrong with a channel, and from when to when, in the data's own time."""

    channel: str
    what: str
    from_s: float
    to_s: float


def faults(measured: Measured) -> list[Fault]:
    """All of them. Gaps marked as such (NaN) are none."""
    found = [fault for one in measured.series for fault in _of_series(one)]
    return found + list(_copies(measured.series))


def _of_series(one: Series) -> Iterator[Fault]:
    yield from _gaps(one)
    for place, channel in enumerate(one.channels):
        valid = one.mask[:, place]
        times, values = one.times[valid], one.values[valid, place]
        if len(values) < ENOUGH:
            continue
        sigma = float(one.sigma[place])
        lost = dropouts(times, values, sigma)
        for first, last in lost:
            yield Fault(channel, f"drops to exactly zero for {last - first} samples", float(times[first]), float(times[last - 1]))
        frozen = stuck(one, place)
        if frozen is not None and not any(values[first] == frozen.value == 0.0 for first, _ in lost):
            yield Fault(channel, f"stands still at {frozen.value:.6g} to the last bit while another moves", frozen.from_s, frozen.to_s)
            continue
        kept = np.ones(len(values), dtype=bool)
        for first, last in lost:
            kept[first:last] = False
        times, values = times[kept], values[kept]
        for i, sigmas in spikes(times, values, sigma):
            yield Fault(channel, f"has a spike of {sigmas:.0f} sigma", float(times[i]), float(times[i]))
        yield from _noise_level(one, channel, times, values, sigma)


def _noise_level(one: Series, channel: str, times: Array, values: Array, sigma: float) -> Iterator[Fault]:
    """Too much noise is a fault; too little only where there is some and its colour is known: data without noise are in order."""
    level, is_noise = noise(times, values, one.colour or 0.0)
    ratio = level / sigma
    bound = MISSTATED * (1.0 + 4.0 / len(values) ** 0.5)  # a level found from few samples is uncertain itself
    too_little = NO_NOISE < ratio < 1.0 / bound and one.colour is not None
    if is_noise and (ratio > bound or too_little):
        yield Fault(channel, f"has noise of {level:.3g}, stated as sigma {sigma:.3g}", float(times[0]), float(times[-1]))


def _gaps(one: Series) -> Iterator[Fault]:
    """Stretches without samples that are long beside the usual interval, however irregular, and beside the record."""
    intervals = np.diff(one.times)
    if len(intervals) < ENOUGH:
        return
    usual = max(GAP * float(np.median(intervals)), GAP / 2.0 * float(np.quantile(intervals, 0.9)))
    for i in np.flatnonzero(intervals > max(usual, GAP_SHARE * float(one.times[-1] - one.times[0]))):
        what = f"has no sample for {intervals[i]:.4g} s, usually one every {np.median(intervals):.4g} s"
        yield Fault(", ".join(one.channels), what, float(one.times[i]), float(one.times[i + 1]))


def _copies(series: list[Series]) -> Iterator[Fault]:
    """Channels of body rates and attitude that hold the same numbers as another. Struts may: legs can do the same."""
    channels = [
        (name, one, one.values[:, place])
        for one in series
        for place, name in enumerate(one.channels)
        if name.startswith(("rates.", "attitude.")) and np.ptp(one.values[one.mask[:, place], place]) > 0.0
    ]
    for k, (name, one, values) in enumerate(channels):
        for other, _, others in channels[:k]:
            if len(values) == len(others) >= ENOUGH and np.array_equal(values, others, equal_nan=True):
                yield Fault(name, f"holds the same numbers as {other}", float(one.times[0]), float(one.times[-1]))
