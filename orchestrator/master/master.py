"""The loop: attempt, judge, undo or accept. Specified in docs/decisions/0003-master.md."""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from time import perf_counter

from orchestrator.errors import RunError, UnitError
from orchestrator.master.checks import check_finite
from orchestrator.master.coupling import check_asked, connection_records, couple
from orchestrator.master.estimates import Estimates
from orchestrator.master.events import Events
from orchestrator.master.guard import Guard
from orchestrator.master.judge import SETTLING, StepLimits, Verdict, fit_to_stop, judge, resume, step_limits
from orchestrator.master.plan import Phase, make_plan
from orchestrator.master.recorder import Ledger, Recorder
from orchestrator.master.refusal import Refusal, next_attempt, stuck_error
from orchestrator.master.result import Attempt, ConnectionRecord
from orchestrator.master.roles import together
from orchestrator.master.settings import NANOSECONDS, MasterSettings, in_ns
from orchestrator.master.slave import Vector
from orchestrator.master.start import Values, initialise
from orchestrator.master.sweep import Sweep, jobs_of
from orchestrator.master.system import System
from orchestrator.master.trials import Trial, warnings_of
from orchestrator.master.until import Until
from orchestrator.master.watchdog import Watchdog

StepListener = Callable[[float], None]


class Master:
    """Steps a system from start to stop. All public times are in s."""

    MEMORY = (
        *("_time", "_next", "_settling", "unresolved", "wall_time", "warnings", "log", "plan", "recorder", "ledger"),
        *("switched", "block_memory", "_guard", "events", "until"),
    )
    """What passes from one accepted step to the next outside the units, kept by checkpoints. An object named here has its own."""

    def __init__(self, system: System, settings: MasterSettings | None = None) -> None:
        self.system = system
        self.settings = settings or MasterSettings()
        self.limits: StepLimits = step_limits(self.settings)
        self.plan = make_plan(system)
        self.recorder = Recorder(system, self.plan.board, in_ns(self.settings.record_interval))
        self.ledger = Ledger(system, self.plan.board)
        self.events = Events(self.plan, self.settings.event_tolerance)
        self.until = Until(self.plan.board)
        self.log: list[Attempt] = []
        self.warnings: list[str] = []
        self.unresolved = 0
        self.wall_time = 0.0
        self.watchdog = Watchdog(self.settings.step_timeout)
        self._settling = 0
        self._switched: list[list[int]] = []
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
        self._initialise_again: Callable[[], str] = lambda: initialise(self.plan, self._start_jobs, start, stop, values)
        self.watchdog.where = lambda: f" at t = {self._time / NANOSECONDS:.9g} s"
        self._unsettled = self._initialise_again()

    def value(self, unit: int, name: str) -> float:
        """An output, as of now."""
        return float(self.plan.board.now[self.plan.board.start_at(unit, name)])

    def prepare(self) -> None:
        """Test claims of rollback, and settle from that who is stepped how. After `initialise`."""
        system = self.system
        check_asked(self.plan)
        check_finite(self.plan, self._time)
        self._try_units()
        able = [can and slave.name not in system.once for can, slave in zip(self.rollback, system.slaves, strict=True)]
        self._able = together(able, self.plan.reduced)
        self._savers = [slave for slave, can in zip(system.slaves, self.rollback, strict=True) if can]
        self._couple()
        self.warnings += [self._unsettled] if self._unsettled else []
        self.warnings += self._estimates.warnings
        self.events.prepare(self.repeated, self.rollback, not self._fix_interval())
        self.warnings += self.events.warnings
        for slave in system.slaves:
            slave.steps, slave.seconds = 0, 0.0

    def _try_units(self) -> None:
        """What each can do; a unit that cannot be put back by its own means is by initialising all again."""
        trials = [Trial(self.plan, unit, self._time, self.watchdog) for unit in self._everyone]
        with self.watchdog:
            for slave, trial in zip(self.system.slaves, trials, strict=True):
                trial.run(min(self.limits.maximum, self._stop - self._time), self.limits.minimum)
                if trial.untrue and slave.name not in self.system.once:
                    claim = f"{slave.name}: claims rollback (canGetAndSetFMUstate), but {trial.untrue}"
                    raise UnitError(f"{claim}; mend the unit, or set its once = true")
                self.warnings += warnings_of(slave.name, trial.record)
        self.trials = [trial.record for trial in trials]
        self.rollback = [record.rollback == "true" for record in self.trials]
        if any(trial.spoilt for trial in trials):
            self._initialise_again()

    def _couple(self) -> None:
        """Everything that follows from how the connections are coupled."""
        self.coupling = couple(self.plan, self._able, {frozenset(pair) for pair in self._switched})
        self.repeated = self.coupling.repeated
        self._sweep = Sweep(self.plan, self.coupling, self.settings, self.watchdog)
        self._passes = self.settings.passes if self.coupling.needs_passes else 1
        once = {at for at, slave in enumerate(self.system.slaves) if slave.name in self.system.once}
        self._guard = Guard(self.plan, [pair for pair in self.coupling.explicit if not pair & once])
        self._estimates = Estimates(self.plan, self.coupling, self._sweep.blocks, self._passes, self.settings)

    def _fix_interval(self) -> bool:
        """A unit that takes one step size only sets it for all: nothing can then be rejected. Whether there is one."""
        for slave in self.system.slaves:
            if not slave.interface.capabilities.get("canHandleVariableCommunicationStepSize", True):
                self._expect_whole_steps(slave.name)
                self.limits = self.limits._replace(minimum=self.limits.maximum)
                self.warnings.append(f"{slave.name}: takes one step size only, so every interval is {self.settings.max_interval:g} s")
                return True
        return False

    def _expect_whole_steps(self, unit: str) -> None:
        length, step = self._stop - self._begin, self.limits.maximum
        if length % step:
            whole = f"master.max_interval of {step / NANOSECONDS:g} s does not divide the run of {length / NANOSECONDS:.9g} s"
            raise UnitError(f"{unit}: takes one step size only, but {whole}; change max_interval or stop_time")

    def run(self, on_step: StepListener | None = None) -> None:
        """To the stop time. Raises RunError when a unit fails; what was recorded stays."""
        entered = perf_counter() - self.wall_time
        if not self._next:
            self._next = self.limits.maximum
            self.ledger.open()
            self._record(last=False)
        try:
            with self.watchdog:
                self._step_to_the_end(entered, on_step)
        finally:
            self.wall_time = perf_counter() - entered

    def _step_to_the_end(self, entered: float, on_step: StepListener | None) -> None:
        while self._time < self._stop and not self.stop_requested:
            self._next = self._advance(self._next)
            self.wall_time = perf_counter() - entered
            self._keep_the_limit()
            if on_step is not None:
                on_step(self._time / NANOSECONDS)

    def _keep_the_limit(self) -> None:
        limit = self.settings.wall_limit
        if 0.0 < limit < self.wall_time and not self.complete:
            asked = f"master.wall_limit of {limit:g} s used up at t = {self._time / NANOSECONDS:.9g} s of {self._stop / NANOSECONDS:g} s"
            slowest = max(self.system.slaves, key=lambda slave: slave.seconds)
            raise RunError(f"{asked}, {slowest.seconds:.0f} s of it by {slowest.name}; raise it, or see what that unit does then")

    def connections(self) -> list[ConnectionRecord]:
        """How each is coupled."""
        return connection_records(self.plan, self.coupling, self._passes)

    @property
    def switched(self) -> list[list[int]]:
        """Pairs of units whose passes were seen not to contract."""
        return self._switched

    @switched.setter
    def switched(self, pairs: list[list[int]]) -> None:
        if pairs != self._switched:
            self._switched = pairs
            self._couple()

    @property
    def block_memory(self) -> Vector:
        """What the quasi-Newton carries from one interval to the next."""
        return self._sweep.memory

    @block_memory.setter
    def block_memory(self, values: Vector) -> None:
        self._sweep.memory = values

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
        self._sweep.time = self._time
        self._sweep.note_start()
        followed, most = False, self._stop - self._time
        while True:
            fitted = min(fit_to_stop(wanted, self._stop - self._time, self.limits), most)
            interval, cut = self.events.cut(fitted, self._time, self.limits, most)
            refused, event = self._attempt(interval), ""
            if refused is None:
                verdict, estimate, limit = self._judged(interval)
                if verdict.accepted:
                    refused, event = self._finish_or_find(interval)
            if refused is not None:
                self._note(interval, nan, False, refused.kind)
                self._settling = SETTLING
                most = wanted = next_attempt(refused, self._time, interval, self.limits, not followed)
                followed = followed or refused.reached is not None
                self._undo()
                continue
            if event:
                self._note(interval, estimate, False, f"event {event}")
                self.events.seek(event, self._time + interval)
                self._undo()
                continue
            if verdict.accepted and self._estimates.late:
                verdict, estimate, limit = self._judged(interval, late=True)
            self._note(interval, estimate, verdict.accepted, cut or self._what_limits(interval, limit, verdict))
            if verdict.accepted:
                self.unresolved += verdict.unresolved
                self._settling = max(0, self._settling - 1)
                self._accept(interval)
                return resume(verdict, interval, wanted, estimate, self.limits) if cut else verdict.next_interval
            self._settling = SETTLING
            self._undo()
            most = wanted = verdict.next_interval  # what was refused is not to come back as the rest up to a stop or an event

    def _finish_or_find(self, interval: int) -> tuple[Refusal | None, str]:
        """Units stepped once, unless an event is seen before; the refusal of one, or the event seen."""
        event = self.events.seen(interval, after=False)
        refused = None if event else self._finish(interval)
        return refused, event if event or refused else self.events.seen(interval, after=True)

    def _judged(self, interval: int, late: bool = False) -> tuple[Verdict, float, str]:
        """The verdict with the estimate and the port it comes from; `late`, after units were stepped that may not be undone."""
        check_finite(self.plan, self._time)
        length = interval / NANOSECONDS
        estimate = self._estimates.of_everything(length) if late else self._estimates.of_passes(length)
        return judge(interval, estimate[0], self.limits, not late, self._settling > 0), *estimate

    def _attempt(self, interval: int) -> Refusal | None:
        """All passes over one interval."""
        self._estimates.model.reset()
        sweep = self._sweep
        refused = sweep.over(sweep.first, interval)
        for _ in range(1, self._passes):
            if refused is not None:
                return refused
            self._estimates.before_pass()
            for job in jobs_of(sweep.again):
                job.slave.restore()
            refused = sweep.over(sweep.again, interval)
        if refused is None:
            self._estimates.after_passes()
        return refused

    def _finish(self, interval: int) -> Refusal | None:
        """Units stepped once. Returns the refusal of one, if everything can be undone."""
        after = self._sweep.after
        refused = self._sweep.over(after, interval)
        if refused is None:
            if after:
                check_finite(self.plan, self._time)
            return None
        jobs = jobs_of(after)
        stepped = jobs[: jobs.index(refused.job) + 1]
        stuck = [job.slave.name for job in stepped if not self.rollback[job.unit]]
        if stuck:
            raise stuck_error(refused, stuck[0], self._time, interval)
        return refused

    def _undo(self) -> None:
        """Every unit that can, back to the start of the interval; the board's start was never left."""
        for slave in self._savers:
            slave.restore()
        self.plan.board.now[:] = self.plan.board.start

    def _accept(self, interval: int) -> None:
        self._guard.check(self._time, interval)
        self._time += interval
        self.events.pass_by(self._time)
        self.ledger.enter()
        self._record(last=self._time >= self._stop)
        self.plan.board.start[:] = self.plan.board.now

    def _record(self, last: bool) -> None:
        elapsed = self._time - self._begin
        due = self.recorder.is_due(elapsed, last)
        if due or self.stop_requested:
            for slave in self.system.slaves:
                slave.observe()
            check_finite(self.plan, self._time)
            self.recorder.record(self._time / NANOSECONDS, elapsed)
            if due and self.until.met(elapsed):  # a row out of turn would be one more than an uninterrupted run looks at
                self._stop = self._time

    def _note(self, interval: int, estimate: float, accepted: bool, limit: str) -> None:
        passes = max(self._passes, self._sweep.iterations)
        self.log.append(Attempt(self._time / NANOSECONDS, interval / NANOSECONDS, passes, estimate, accepted, limit))

    def _what_limits(self, interval: int, port: str, verdict: Verdict) -> str:
        """What keeps the next interval from being longer: the port with the largest estimate, unless it asks for no limit."""
        if verdict.accepted and not verdict.unresolved and self._time + interval == self._stop:
            return "stop time"
        return "max interval" if verdict.next_interval >= self.limits.maximum and not verdict.unresolved else port
