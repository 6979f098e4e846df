"""When first contact was, by the data's clock; and whether channels were swapped or turned round.

Both ask how the base scenario, flown at the prior mean, would fit if the data were read differently. Rough on purpose: a coordinate refines
the time, and a swap must be glaring.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.landing import Course
from orchestrator.diagnosis.observation import Observation, Track, sampled

Array = NDArray[np.float64]
STEP = 0.01  # s, of the clocks tried
NEAR = 0.1  # s: a clock nearer to zero than this means that the data start at first contact; 3 of 47 that did were found beyond 0.06
CLEAR = 0.7  # of the misfit at zero: another clock must be better than this
FLOOR = 0.1  # of a range: how well the base scenario may be expected to fit at all
SWAPPED = 0.25  # of the misfit as read: a swap must be better than this
EXACT = 0.05  # of it: a swap that fits within the floor as well needs less of a misfit as read


def first_contact(observation: Observation, course: Course) -> float:
    """s, the data's time of first contact. Zero where the data's clock fits as it is."""
    if not observation.tracks:
        return _by_contacts(observation, course)
    first = min(t.times[0] for t in observation.tracks if len(t.times))
    last = max(t.times[-1] for t in observation.tracks if len(t.times))
    end = float(course.times[-1])
    shifts = np.arange(np.floor((first - end) / STEP), np.ceil(last / STEP)) * STEP
    shifts = np.unique(np.append(shifts[np.abs(shifts - first) < end + last - first], 0.0))
    costs = np.array([_misfit(observation, course, float(s)) for s in shifts])
    best = int(np.argmin(costs))
    at_zero = float(costs[np.argmin(np.abs(shifts))])
    if first < end and (abs(float(shifts[best])) < NEAR or costs[best] > CLEAR * at_zero):
        return 0.0
    return float(shifts[best])


def _by_contacts(observation: Observation, course: Course) -> float:
    """The same from readings at rest alone: what the instants of contact among them say."""
    seen = [(r.value, course.final.get(r.column, -1.0)) for r in observation.readings if r.kind == "time"]
    late = [there - here for there, here in seen if np.isfinite(there) and here >= 0.0]
    shift = float(np.median(late)) if late else 0.0
    return shift if abs(shift) >= NEAR else 0.0


def _misfit(observation: Observation, course: Course, shift: float) -> float:
    """Mean square distance over the tracks, in units of noise and of a share of the widest range in their series.

    Of the widest: a channel in which hardly anything happens is off by what its prior leaves open, at every clock alike. Before contact the
    vehicle flies free.
    """
    total, count = 0.0, 0
    for places in observation.series.values():
        tracks = [observation.tracks[i] for i in places if len(observation.tracks[i].times)]
        widest = max((float(np.ptp(track.readings)) for track in tracks), default=0.0)
        for track in tracks:
            there = sampled(course, track.column, track.times - shift)
            scale = np.hypot(track.sigma, FLOOR * widest)
            total += float(np.square((track.readings - there) / scale).clip(max=100.0).sum())
            count += len(track.times)
    return total / max(count, 1)


def swapped(observation: Observation, course: Course) -> str:
    """What is wrong with the axes of a series, if another order or other signs fit very much better; else nothing."""
    for series, tracks in _axes(observation):
        shared = reduce(np.intersect1d, [track.times for track in tracks])
        if not len(shared):
            continue
        model = np.column_stack([sampled(course, t.column, shared - observation.shift) for t in tracks])
        data = np.column_stack([t.readings[np.isin(t.times, shared)] for t in tracks])
        scale = np.hypot(max(t.sigma for t in tracks), 0.5 * FLOOR * np.ptp(data))
        costs = {}
        for order in permutations(range(3)):
            for signs in product((1.0, -1.0), repeat=3):
                costs[order, signs] = float(np.square((data[:, order] * np.array(signs) - model) / scale).mean())
        as_read = costs[(0, 1, 2), (1.0, 1.0, 1.0)]
        best = min(costs, key=lambda key: costs[key])
        glaring = costs[best] < SWAPPED * as_read and as_read > 20.0
        if glaring or (costs[best] < min(EXACT * as_read, 1.0) and as_read > 5.0):
            names = [t.channel for t in tracks]
            turned = [("-" if s < 0 else "") + names[i] for i, s in zip(best[0], best[1], strict=True)]
            return (
                f"series {series}: fits {as_read / costs[best]:.0f} times better read as {', '.join(turned)} in place of {', '.join(names)}"
            )
    return ""


def _axes(observation: Observation) -> Iterator[tuple[str, list[Track]]]:
    """Series → its three tracks about the three axes, of rates or of angles; other channels have no axes that could be swapped."""
    for series, places in observation.series.items():
        for prefix in ("rates.", "attitude."):
            own = [observation.tracks[i] for i in places]
            tracks = [track for track in own if track.channel.startswith(prefix) and len(track.times)]
            if len(tracks) == 3:
                yield series, tracks
