"""Units that are repeated together until what they exchange at the end of the interval agrees.

Within a block inputs run linearly from their value at the start to that at the end. Ends that come from units stepped earlier in the
block are known; the others, z, are assumed, and found by quasi-Newton: z = g(z), g what those units answer. Predicted by extrapolation.

    error estimate:  H/6·max(|Δv|, lever·|Δω|),  Δ = M (z − z₁),  z₁ = extrapolated from the last two ends
                                                                    (z at the start, where a unit gets the mean of a line)

z − z₁ = H² z̈: a line departs from a parabola by an impulse of z̈ H³/12, and M turns an end value into a velocity by H/2 times the mobility.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from math import inf, nan, prod

import numpy as np
from numpy.typing import NDArray

from orchestrator.master.estimate import Norms
from orchestrator.master.interface_newton import InterfaceNewton
from orchestrator.master.plan import Job, Places, Plan, companion
from orchestrator.master.ports import MotionPort
from orchestrator.master.refusal import Refusal
from orchestrator.master.settings import NANOSECONDS, MasterSettings
from orchestrator.master.system import Link, Scheme

Vector = NDArray[np.float64]
StepOne = Callable[[Job, int], Refusal | None]
"""Steps a unit over an interval, ns, from inputs that stand ready."""
PARABOLA = 3
IMPULSE = 1.0 / 6.0


class Hold(IntEnum):
    """What stands for a line where a unit takes no slopes: its mean, but its end for one found to answer to nothing but the end."""

    UNTRIED = 0
    MEAN = 1
    END = 2


@dataclass
class Lines:
    """One unit's inputs that run linearly: slopes where it takes them, else one value."""

    slope: Places
    slope_start: Places
    slope_end: Places
    held: Places
    held_start: Places
    held_end: Places
    hold: Hold = Hold.UNTRIED

    @property
    def approximate(self) -> bool:
        """Whether one value stands for a line, and not exactly."""
        return bool(self.held.size) and self.hold is not Hold.END

    def write(self, board: Vector, u: Vector, interval: float) -> None:
        if self.slope.size:
            u[self.slope] = (board[self.slope_end] - board[self.slope_start]) / interval
        if self.held.size:
            end = board[self.held_end]
            u[self.held] = end if self.hold is Hold.END else 0.5 * (board[self.held_start] + end)


class Block:
    """Two or more units, solved together in every pass."""

    def __init__(self, plan: Plan, units: list[int], lines: Sequence[Link], motion: Sequence[MotionPort], settings: MasterSettings) -> None:
        board, rank = plan.board, {unit: at for at, unit in enumerate(units)}
        self.units = units
        self._settings = settings
        self._board = board
        inner = [k for k in lines if k.source_unit in rank and k.target_unit in rank]
        back = dict.fromkeys((k.source_unit, k.source) for k in inner if rank[k.source_unit] >= rank[k.target_unit])
        self._assumed = np.array([board.end_at(*source) for source in back], dtype=np.intp)
        self._answered = np.array([board.now_at(*source) for source in back], dtype=np.intp)
        self._start = np.array([board.start_at(*source) for source in back], dtype=np.intp)
        self._own = {unit: _own_reals(plan, unit) for unit in units}
        self._lines = {unit: _lines(plan, unit, [k for k in inner if k.target_unit == unit], rank) for unit in units}
        self._motion = np.array([board.now_at(p.unit, n) if n else board.zero for p in motion for n in p.names], dtype=np.intp)
        self.label = " with ".join(plan.system.slaves[unit].name for unit in units)
        self._norms = Norms([p.label for p in motion], settings.model_lever) if motion else None
        nominal = np.array([abs(plan.system.slaves[u].interface.variables[name].nominal) or 1.0 for u, name in back])
        self.newton = InterfaceNewton(nominal, len(self._motion))
        self._history = np.full((PARABOLA, 1 + len(back)), nan)
        """Time (s) and value of z at the last accepted steps, newest last; NaN where there were none."""
        self.plain = all(k.scheme is Scheme.PASSES for k in inner)
        """By fixed-point iteration, because that was asked for."""
        self.iterations = 0
        self._remaining = 0.0

    def note_start(self, time: int) -> None:
        """Before an interval: z as it stands."""
        self.newton.note(self._board.values[self._start])
        row = np.concatenate([[time / NANOSECONDS], self._board.values[self._start]])
        if row[0] != self._history[-1, 0]:
            self._history[:-1] = self._history[1:]
            self._history[-1] = row

    def solve(self, jobs: Sequence[Job], gather: Callable[[Job], None], step: StepOne, interval: int, first: bool) -> Refusal | None:
        """Repeat the units until z agrees. `first`: from the prediction, not from the last pass's z."""
        values, length, newton = self._board.values, interval / NANOSECONDS, self.newton
        if first:
            values[self._assumed] = self._extrapolated(length, PARABOLA)
            self.iterations = 0
        newton.begin(length)
        for iteration in range(self._settings.max_iterations):
            if iteration:
                for job in jobs:
                    job.slave.restore()
            self.iterations += 1
            for job in jobs:
                gather(job)
                self._lines[job.unit].write(values, job.u, length)
                refused = step(job, interval) or self._try_memory(job, step, interval)
                if refused is not None:
                    return refused
            z, g = values[self._assumed], values[self._answered]
            if not np.isfinite(g.sum()):
                return Refusal(jobs[-1], "its answer to what was assumed for the end of the interval is not finite")
            correction = newton.correct(z, g, values[self._motion])
            self._remaining = self._weight(correction, length)
            if self._remaining <= self._settings.interface_share * self._settings.tolerance:
                break
            values[self._assumed] = g if self.plain else z + correction
        newton.keep()
        return None

    def estimate(self, interval: float) -> tuple[float, str]:
        """Of the lines' curvature, or of what is left of the iteration where that is more; m."""
        values = self._board.values
        approximate = any(lines.approximate for lines in self._lines.values())
        missed = values[self._assumed] - (values[self._start] if approximate else self._extrapolated(interval, 2))
        return max(IMPULSE * self._weight(missed, interval, known=True), self._remaining), self.label

    @property
    def memory(self) -> Vector:
        """What passes from one interval to the next, for checkpoints."""
        return np.concatenate([[float(self._lines[unit].hold) for unit in self.units], self._history.ravel(), self.newton.memory])

    @memory.setter
    def memory(self, values: Vector) -> None:
        for unit, hold in zip(self.units, values, strict=False):
            self._lines[unit].hold = Hold(int(hold))
        values = values[len(self.units) :]
        self._history.flat[:] = values[: self._history.size]
        self.newton.memory = values[self._history.size :]

    def _try_memory(self, job: Job, step: StepOne, interval: int) -> Refusal | None:
        """Once, after the first step that changed a held unit's outputs: does half the interval lead to the same bits?"""
        lines, own = self._lines[job.unit], self._own[job.unit]
        now, start = self._board.now[own], self._board.start[own]
        if not lines.held.size or lines.hold is not Hold.UNTRIED or not _variable_step(job) or np.array_equal(now, start):
            return None
        whole = now.copy()
        job.slave.restore()
        refused = step(job, interval // 2)
        lines.hold = Hold.MEAN if refused or now.tobytes() != whole.tobytes() else Hold.END
        job.slave.restore()
        lines.write(self._board.values, job.u, interval / NANOSECONDS)
        return step(job, interval)

    def _weight(self, change: Vector, interval: float, known: bool = False) -> float:
        """m by which a change of z would move the units; without a velocity among what they exchange, its share of z."""
        if not change.any():
            return 0.0
        if self._norms is None:
            return self.newton.share(change)
        if not known and not self.newton.can_weigh(change):
            return inf
        return interval * self._norms.largest(self.newton.motion(change))[0]

    def _extrapolated(self, ahead: float, points: int) -> Vector:
        """z at the end of the interval, by the polynomial through its last values."""
        times = [time for time in self._history[:, 0].tolist() if time == time][-points:]
        end = times[-1] + ahead
        weights = [prod((end - other) / (time - other) for other in times if other != time) for time in times]
        return np.asarray(np.array(weights) @ self._history[-len(times) :, 1:])


def _own_reals(plan: Plan, unit: int) -> slice:
    """Where on the board the outputs stand that are fetched after every step."""
    begin = plan.board.offset[unit]
    return slice(begin, begin + plan.coupled[unit])


def _lines(plan: Plan, unit: int, links: Sequence[Link], rank: dict[int, int]) -> Lines:
    board, places = plan.board, plan.input_places(unit)
    sloped: list[tuple[int, int, int]] = []
    held: list[tuple[int, int, int]] = []
    for link in links:
        source = (link.source_unit, link.source)
        end = board.now_at(*source) if rank[link.source_unit] < rank[unit] else board.end_at(*source)
        slope = places.get(companion(link.target, "_slope"), places.get(f"der({link.target})"))
        if slope is not None and link.slope:
            sloped.append((slope, board.start_at(*source), end))
        else:
            held.append((places[link.target], board.start_at(*source), end))
    first, second = (np.array(rows, dtype=np.intp).reshape(-1, 3).T.copy() for rows in (sloped, held))
    return Lines(first[0], first[1], first[2], second[0], second[1], second[2])


def _variable_step(job: Job) -> bool:
    return job.slave.interface.capabilities.get("canHandleVariableCommunicationStepSize", True)
