"""A unit that does not take an interval: why, and which one to try instead."""

from __future__ import annotations

from typing import NamedTuple

from orchestrator.errors import StepError
from orchestrator.master.judge import StepLimits, halve
from orchestrator.master.plan import Job
from orchestrator.master.settings import NANOSECONDS

SHORTEST = 1_000
"""ns: an early return nearer to the start than this is no step."""


class Refusal(NamedTuple):
    job: Job
    why: str
    """In the unit's own words, where it has any."""
    reached: int | None = None
    """ns: the time up to which it did step (lastSuccessfulTime); None where it did not."""

    @property
    def name(self) -> str:
        return self.job.slave.name

    @property
    def kind(self) -> str:
        """For the log."""
        return f"early return of {self.name}" if self.reached is not None else f"discard by {self.name}"


def refusal(job: Job, time: int, interval: int) -> Refusal:
    """Of a step that was just discarded; ns."""
    said = job.slave.messages[-1] if job.slave.messages else "it gave no message"
    reached = time if job.slave.reached is None else round(job.slave.reached * NANOSECONDS)
    return Refusal(job, said, reached if SHORTEST <= reached - time < interval else None)


def next_attempt(refused: Refusal, time: int, interval: int, limits: StepLimits, honour: bool) -> int:
    """The interval to try after a refusal, ns: up to where the unit came, else half. A StepError where nothing shorter is allowed.

    `honour`: an early return is followed once for each accepted step, so that a unit cannot lead the run in ever smaller circles.
    """
    if refused.reached is not None and honour:
        return refused.reached - time
    shorter = halve(interval, limits)
    if shorter is None:
        raise StepError(
            f"{refused.name}: refused the step at t = {time / NANOSECONDS:.9g} s even at the smallest interval,"
            f" {interval / NANOSECONDS:.3g} s: {refused.why}"
        )
    return shorter


def stuck_error(refused: Refusal, stuck: str, time: int, interval: int) -> StepError:
    """A unit refused and another (or itself) has stepped and cannot go back."""
    came = f", came to {refused.reached / NANOSECONDS:.9g} s" if refused.reached is not None else ""
    return StepError(
        f"{refused.name}: refused the step at t = {time / NANOSECONDS:.9g} s of {interval / NANOSECONDS:.3g} s{came}"
        f" and {stuck} cannot roll back: {refused.why}; lower max_interval"
    )
