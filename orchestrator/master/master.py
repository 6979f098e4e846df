"""The loop: attempt, judge, undo or accept. Specified in docs/decisions/0003-master.md."""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from time import perf_counter

from orchestrator.errors import StepError
from orchestrator.master.checks import check_finite, truly_rolls_back
from orchestrator.master.estimate import HeldEstimate, ModelEstimate, MotionEstimate, larger
from orchestrator.master.judge import SETTLING, StepLimits, Verdict, fit_to_stop, halve, judge, step_limits
from orchestrator.master.plan import Job, Phase, make_plan
from orchestrator.master.ports import held_ports, motion_ports
from orchestrator.master.recorder import Ledger, Recorder
from orchestrator.master.result import Attempt
from orchestrator.master.roles import repeated_units, together
from orchestrator.master.settings import NANOSECONDS, MasterSettings, in_ns
from orchestrator.master.slave import Status
from orchestrator.master.start import Values, assemble, initialise
from orchestrator.master.system import System

StepListener = Callable[[float], None]


class Master:
    """Steps a system from start to stop. All public times are in s."""

    MEMORY = ("_time", "_next", "_settling", "unresolved", "wall_time", "warnings", "log", "plan", "recorder", "ledger")
    """What passes from one accepted step to the next outside the units, kept by checkpoints. An object named here has its own."""

    def __init__(self, system: System, settings: MasterSettings | None = None) -> None:
        self.system = system
        self.settings = settings or MasterSettings()
        self.limits: StepLimits = step_limits(self.settings)
        self.plan = make_plan(system)
        self.recorder = Recorder(system, self.plan.board, in_ns(self.settings.record_interval))
        self.ledger = Ledger(system, self.plan.board)
        self.log: list[Attempt] = []
        self.warnings: list[str] = []
        self.unresolved = 0
        self.wall_time = 0.0
        self._settling = 0
        self._next = 0
        """Interval proposed for the next step, ns; 0 before the run has begun."""
        self.stop_requested = False
        """Set it (from a signal handler, say) to end after the present step."""
        self._everyone = list(range(len(system.slaves)))
        self._start_jobs = self.plan.jobs(Phase.FIRST, self._everyone, [False] * len(system.slaves))

    def initialise(self, start: float, stop: float, values: Values) -> None:
        """Outputs at the start, consistent with each other; may be called again with other values."""
        self._time = in_ns(start)
        self._begin, self._stop = self._time, in_ns(stop)
        initialise(self.plan, self._start_jobs, start, stop, values)

    def value(self, unit: int, name: str) -> float:
        """An output, as of now."""
        return float(self.plan.board.now[self.plan.board.start_at(unit, name)])

    def prepare(self) -> None:
        """Test claims of rollback, and settle from that who is stepped how. After `initialise`."""
        system = self.system
        check_finite(self.plan, self._time)
        probe = self.limits.maximum
        self.rollback = [truly_rolls_back(self.plan, unit, self._time, probe, self.warnings) for unit in self._everyone]
        able = [can and slave.name not in system.once for can, slave in zip(self.rollback, system.slaves, strict=True)]
        self.repeated = repeated_units(len(system.slaves), system.links, together(able, self.plan.reduced))
        loop = [unit for unit in self._everyone if self.repeated[unit]]
        rest = [unit for unit in self._everyone if not self.repeated[unit]]
        self._first = self.plan.jobs(Phase.FIRST, loop, self.repeated)
        self._again = self.plan.jobs(Phase.AGAIN, loop, self.repeated)
        self._after = self.plan.jobs(Phase.AFTER, rest, self.repeated)
        self._savers = [slave for slave, can in zip(system.slaves, self.rollback, strict=True) if can]
        self._choose_estimates()
        self._fix_interval()
        for slave in system.slaves:
            slave.steps, slave.seconds = 0, 0.0

    def _choose_estimates(self) -> None:
        """What there is to judge a step by; a warning where there is nothing."""
        system, board, settings, reduced = self.system, self.plan.board, self.settings, self.plan.reduced
        inner = [self.repeated[p.owner] and self.repeated[p.partner] for p in reduced]
        # With no repeated port at all, the models are still measured, after the units that are stepped once.
        self._model_is_late = not any(inner) and bool(inner)
        self._model = ModelEstimate(board, reduced, inner if any(inner) else [True] * len(inner), settings.model_lever)
        if any(inner) and not all(inner):
            label = reduced[inner.index(False)].label
            self.warnings.append(f"{label}: a unit there is stepped once per accepted step, so its model gives no estimate")
        in_loop = repeated_units(len(system.slaves), system.links, [True] * len(system.slaves))
        self._motion = MotionEstimate(board, motion_ports(system, self.repeated), settings.motion_lever)
        self._held = HeldEstimate(board, held_ports(system, self.repeated, in_loop), settings.motion_lever)
        judged = self._model.count or self._held.count or (self._motion.count and settings.passes > 1)
        asked = all(slave.name in system.once for slave, loop in zip(system.slaves, in_loop, strict=True) if loop)
        if any(in_loop) and not judged and not asked:
            self.warnings.append("no port gives an error estimate: every interval is max_interval; check by halving it")

    def _fix_interval(self) -> None:
        """A unit that takes one step size only sets it for all: nothing can then be rejected."""
        for slave in self.system.slaves:
            if not slave.interface.capabilities.get("canHandleVariableCommunicationStepSize", True):
                self.limits = self.limits._replace(minimum=self.limits.maximum)
                self.warnings.append(f"{slave.name}: takes one step size only, so every interval is {self.settings.max_interval:g} s")
                return

    def run(self, on_step: StepListener | None = None) -> None:
        """To the stop time. Raises RunError when a unit fails; what was recorded stays."""
        entered = perf_counter() - self.wall_time
        if not self._next:
            self._next = self.limits.maximum
            self.ledger.open()
            self._record(last=False)
        try:
            while self._time < self._stop and not self.stop_requested:
                self._next = self._advance(self._next)
                self.wall_time = perf_counter() - entered
                if on_step is not None:
                    on_step(self._time / NANOSECONDS)
        finally:
            self.wall_time = perf_counter() - entered

    @property
    def time(self) -> int:
        """ns"""
        return self._time

    @property
    def complete(self) -> bool:
        return self._time >= self._stop

    def _advance(self, wanted: int) -> int:
        """One accepted step, after as many rejected ones as it takes; returns the interval proposed for the next, ns."""
        for slave in self._savers:
            slave.save()
        interval = wanted
        while True:
            interval = fit_to_stop(interval, self._stop - self._time, self.limits)
            refused = self._attempt(interval)
            if refused is None:
                verdict, estimate, limit = self._judged(interval)
                refused = self._finish(interval) if verdict.accepted else None
            if refused is not None:
                interval = self._shrink_after_discard(interval, refused)
                continue
            if verdict.accepted and (self._model_is_late or self._held.count):
                verdict, estimate, limit = self._judged(interval, late=True)
            self._note(interval, estimate, verdict.accepted, self._what_limits(interval, limit, verdict))
            if verdict.accepted:
                self.unresolved += verdict.unresolved
                self._settling = max(0, self._settling - 1)
                self._accept(interval)
                return verdict.next_interval
            self._settling = SETTLING
            self._undo()
            interval = verdict.next_interval

    def _judged(self, interval: int, late: bool = False) -> tuple[Verdict, float, str]:
        """The verdict with the estimate and the port it comes from; `late`, after units were stepped that may not be undone."""
        check_finite(self.plan, self._time)
        length = interval / NANOSECONDS
        estimate = self._motion.estimate(length) if self.settings.passes > 1 else (nan, "")
        if late:
            estimate = larger(estimate, self._held.estimate(length))
            if self._model_is_late:
                self._model.measure()
        if late or not self._model_is_late:
            estimate = larger(self._model.estimate(length), estimate)
        return judge(interval, estimate[0], self.limits, not late, self._settling > 0), *estimate

    def _attempt(self, interval: int) -> Job | None:
        """All passes over one interval. Returns the unit that refused it, if one did."""
        self._model.reset()
        refused = self._sweep(self._first, interval)
        for _ in range(1, self.settings.passes):
            if refused is not None or not self._first:
                break
            if not self._model_is_late:
                self._model.measure()
                self._model.accumulate()
            self._motion.remember()
            for job in self._again:
                job.slave.restore()
            refused = self._sweep(self._again, interval)
        if refused is None and not self._model_is_late:
            self._model.measure()
        return refused

    def _sweep(self, jobs: list[Job], interval: int) -> Job | None:
        board = self.plan.board.values
        time, length = self._time / NANOSECONDS, interval / NANOSECONDS
        for job in jobs:
            assemble(board, job, 0.5 * length)
            if job.slave.step(time, length) is Status.DISCARD:
                return job
        return None

    def _finish(self, interval: int) -> Job | None:
        """Units stepped once. Returns the unit that refused, if one did and everything can be undone."""
        refused = self._sweep(self._after, interval)
        if refused is None:
            if self._after:
                check_finite(self.plan, self._time)
            return None
        stepped = self._after[: self._after.index(refused) + 1]
        stuck = [job.slave.name for job in stepped if not self.rollback[job.unit]]
        if stuck:
            raise StepError(
                f"{refused.slave.name}: refused the step at t = {self._time / NANOSECONDS:.9g} s of {interval / NANOSECONDS:.3g} s"
                f" and {stuck[0]} cannot roll back: {_last(refused)}; lower max_interval"
            )
        return refused

    def _shrink_after_discard(self, interval: int, refused: Job) -> int:
        name = refused.slave.name
        self._note(interval, nan, False, f"discard by {name}")
        self._settling = SETTLING
        shorter = halve(interval, self.limits)
        if shorter is None:
            raise StepError(
                f"{name}: refused the step at t = {self._time / NANOSECONDS:.9g} s even at the smallest interval,"
                f" {interval / NANOSECONDS:.3g} s: {_last(refused)}"
            )
        self._undo()
        return shorter

    def _undo(self) -> None:
        """Every unit that can, back to the start of the interval; the board's start was never left."""
        for slave in self._savers:
            slave.restore()
        self.plan.board.now[:] = self.plan.board.start

    def _accept(self, interval: int) -> None:
        self._time += interval
        self.ledger.enter()
        self._record(last=self._time >= self._stop)
        self.plan.board.start[:] = self.plan.board.now

    def _record(self, last: bool) -> None:
        elapsed = self._time - self._begin
        if self.recorder.is_due(elapsed, last or self.stop_requested):
            for slave in self.system.slaves:
                slave.observe()
            check_finite(self.plan, self._time)
            self.recorder.record(self._time / NANOSECONDS, elapsed)

    def _note(self, interval: int, estimate: float, accepted: bool, limit: str) -> None:
        passes = self.settings.passes if self._first else 1
        self.log.append(Attempt(self._time / NANOSECONDS, interval / NANOSECONDS, passes, estimate, accepted, limit))

    def _what_limits(self, interval: int, port: str, verdict: Verdict) -> str:
        """What keeps the next interval from being longer: the port with the largest estimate, unless it asks for no limit."""
        if verdict.accepted and not verdict.unresolved and self._time + interval == self._stop:
            return "stop time"
        return "max interval" if verdict.next_interval >= self.limits.maximum and not verdict.unresolved else port


def _last(job: Job) -> str:
    return job.slave.messages[-1] if job.slave.messages else "it gave no message"
