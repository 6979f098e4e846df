"""Before the first step: start values, consistent outputs, and the solved initial parameter."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from orchestrator.errors import UnitError
from orchestrator.master.plan import Job, Plan
from orchestrator.master.slave import Value, Vector

Values = Sequence[Mapping[str, Value]]


def assemble(board: Vector, job: Job, half: float) -> None:
    """Write a unit's inputs: u = board[first] − half·board[second]; `half` is half the interval, s."""
    board.take(job.first, out=job.u, mode="clip")
    if job.second.size:
        board.take(job.second, out=job.half_rise, mode="clip")
        job.half_rise *= half
        job.u -= job.half_rise


SWEEPS = 40
"""Round the system before its start: enough for a loop of direct feedthrough with a gain of 0.4 to stand to the last digits."""


def initialise(plan: Plan, jobs: Sequence[Job], start: float, stop: float, values: Values) -> str:
    """Sweep values round the system in initialisation mode until nothing changes, then leave it in order; what still changes, in words.

    A unit that computes its outputs only when it leaves initialisation mode is served too: inputs are gathered again before each leave.
    """
    board = plan.board
    board.values[:-1] = 0.0      # the last is 1
    for job in jobs:
        job.slave.set_up(start, stop, values[job.unit])
    unsettled = ""
    for _ in range(max(SWEEPS, len(jobs) + 1)):
        before = board.now.copy()
        for job in jobs:
            assemble(board.values, job, 0.0)
            job.slave.exchange()
            board.start[:] = board.now
        if np.array_equal(before, board.now, equal_nan=True):
            break
    else:
        unsettled = _still_changes(plan, before)
    for job in jobs:
        assemble(board.values, job, 0.0)
        job.slave.begin()
        board.start[:] = board.now
    return unsettled


def _still_changes(plan: Plan, before: Vector) -> str:
    """The output that the last sweep changed most, unless it was by rounding."""
    now = plan.board.now
    change = np.abs(now - before) / np.maximum(np.maximum(np.abs(now), np.abs(before)), 1e-300)
    at = int(np.nan_to_num(change).argmax())
    if not change[at] > 1e-9:
        return ""
    unit, name = plan.board.names[at]
    who = f"{plan.system.slaves[unit].name}.{name}"
    went = f"from {before[at]:.6g} to {now[at]:.6g}"
    return f"{who}: still changes {went} as start values go round the system, so that the first row is not consistent"


def solve_start(residual: Callable[[float], float], guess: float, nominal: float, what: str) -> float:
    """The value at which the residual is zero, by secants.

    `what` names the request for the message. Converged at 1e-12 of the residual's scale or when the value stops moving. A guess that is
    converged already stays as it is: solved once and written down, it gives the same bits again.
    """
    x0, x1 = guess, guess + 1e-2 * max(abs(guess), nominal)
    f0 = residual(x0)
    if abs(f0) <= 1e-12 * abs(x1 - x0):
        return x0
    f1 = residual(x1)
    scale = max(abs(f0), abs(f1), abs(x1 - x0))
    for _ in range(40):
        if abs(f0) < abs(f1):
            x0, x1, f0, f1 = x1, x0, f1, f0
        if abs(f1) <= 1e-12 * scale or abs(x1 - x0) <= 4e-16 * max(abs(x0), abs(x1)):
            return x1
        if f1 == f0:
            raise UnitError(f"start: {what}: stays at {f1:.6g} whatever the value; vary something that moves it")
        x0, x1 = x1, x1 - f1 * (x1 - x0) / (f1 - f0)
        f0, f1 = f1, residual(x1)
    raise UnitError(f"start: {what}: still {f1:.3g} after 40 trials, expects 0; give a start value nearer to the solution")
