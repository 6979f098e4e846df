"""Step control is arithmetic: judge a step from its estimate. Undoing it is the loop's work."""

from __future__ import annotations

from math import isnan, sqrt
from typing import NamedTuple

from orchestrator.master.settings import MasterSettings, in_ns

SAFETY, SHRINK, GROW = 0.9, 0.2, 2.0
SETTLING = 3
"""Accepted steps after a rejection during which the interval may not grow: it halves the rejections of a vehicle at rest."""


class StepLimits(NamedTuple):
    """Intervals in ns, tolerance in m."""

    minimum: int
    maximum: int
    tolerance: float


class Verdict(NamedTuple):
    accepted: bool
    unresolved: bool
    """Accepted although the estimate exceeds the tolerance, because nothing smaller is allowed."""
    next_interval: int
    """ns"""


def step_limits(settings: MasterSettings) -> StepLimits:
    return StepLimits(in_ns(settings.min_interval), in_ns(settings.max_interval), settings.tolerance)


def judge(interval: int, estimate: float, limits: StepLimits, can_undo: bool = True, settling: bool = False) -> Verdict:
    """H' = H·clip(0.9·√(tolerance/estimate), 0.2, 2), within the limits; the estimate is of second order in H. NaN: there is none.

    `settling`: a rejection was not long ago, so 1 takes the place of 2.
    """
    if isnan(estimate):
        return Verdict(True, False, limits.maximum)
    grow = 1.0 if settling else GROW
    factor = grow if estimate <= 0.0 else min(grow, max(SHRINK, SAFETY * sqrt(limits.tolerance / estimate)))
    proposed = min(limits.maximum, max(limits.minimum, int(interval * factor)))
    if estimate <= limits.tolerance:
        return Verdict(True, False, proposed)
    if interval <= limits.minimum or not can_undo:
        return Verdict(True, True, proposed)
    return Verdict(False, False, min(proposed, interval - 1))


def resume(verdict: Verdict, interval: int, wanted: int, estimate: float, limits: StepLimits) -> int:
    """The next interval after an accepted step that an event cut short: the one wanted before it, as far as the estimate lets it."""
    if verdict.unresolved or isnan(estimate):
        return verdict.next_interval
    room = wanted if estimate <= 0.0 else min(wanted, int(interval * SAFETY * sqrt(limits.tolerance / estimate)))
    return max(verdict.next_interval, room)


def halve(interval: int, limits: StepLimits) -> int | None:
    """The interval to retry with after a unit refused one; None when it was the smallest."""
    return max(limits.minimum, interval // 2) if interval > limits.minimum else None


def fit_to_stop(interval: int, remaining: int, limits: StepLimits) -> int:
    """The interval cut so that the last one ends at the stop time and none is shorter than need be."""
    if remaining >= interval + limits.minimum:
        return interval
    return remaining if remaining <= limits.maximum else remaining // 2
