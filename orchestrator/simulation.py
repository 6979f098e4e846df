"""From a scenario to a result: the one place where scenario, FMI and master meet."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from orchestrator.blueprint import Blueprint, draw_up, read_scenario
from orchestrator.checkpoint.schedule import Schedule
from orchestrator.checkpoint.snapshot import Snapshot, put
from orchestrator.crash import last_words
from orchestrator.errors import OrchestratorError, RunError, TrustError, UnitError, nearest
from orchestrator.fmi.load import load
from orchestrator.fmi.unit import FmuUnit
from orchestrator.master.converter import Converter
from orchestrator.master.master import Master
from orchestrator.master.result import RunResult, UnitRecord
from orchestrator.master.settings import MasterSettings, in_ns
from orchestrator.master.slave import Kind, Slave, Value
from orchestrator.master.start import solve_start
from orchestrator.master.system import System
from orchestrator.master.trust import distrust
from orchestrator.master.until import Until
from orchestrator.scenario.model import StartTable
from orchestrator.scenario.parameters import SETTABLE, numbers

Progress = Callable[[float], None]
START_TRIES = 4


def _leave(message: str) -> None:
    """End the process with a line: what a unit that hangs or has crashed leaves no other way."""
    sys.stderr.write(f"error: {message}\n")
    sys.stderr.flush()
    os._exit(RunError.exit_code)


class Simulation:
    """Loaded units under a master; `run` or `resume` once."""

    def __init__(self, blueprint: Blueprint, slaves: Sequence[Slave] | None = None) -> None:
        """`slaves` replaces the FMUs by other units of the same names and interfaces."""
        self.blueprint = blueprint
        table = blueprint.scenario.table
        if slaves is None:
            slaves = [load(unit.name, blueprint.interfaces[unit.name], unit.isolate) for unit in blueprint.scenario.units]
        wanted = blueprint.derived or [[]] * len(slaves)
        slaves = [Converter(slave, derived) if derived else slave for slave, derived in zip(slaves, wanted, strict=True)]
        once = frozenset(unit.name for unit in blueprint.scenario.units if unit.once)
        self.system = System(slaves, blueprint.links, blueprint.pairs, once, blueprint.recorded, blueprint.zero, blueprint.located)
        settings = MasterSettings(**table.master.model_dump(exclude={"order", "locate"}), record_interval=table.record.interval)
        self.master = Master(self.system, settings)
        if table.until is not None:
            self.master.until = Until(self.master.plan.board, blueprint.bounds, in_ns(table.until.hold))
        self.on_hang: Callable[[RunResult], None] | None = None
        """What to do with the run so far when a unit does not come back; called from another thread, must leave the process."""

    def run(self, on_step: Progress | None = None, schedule: Schedule | None = None) -> RunResult:
        """Initialise, step to the end, collect. A unit that fails while stepping ends the run with what there is so far."""
        if schedule is not None:
            schedule.check(self.master)
        with self._last_words():
            self.initialise()
            self._watch_trials()
            self.master.prepare()
            if schedule is not None:
                schedule.begin(self.master, self.blueprint, fresh=True)
            return self._go(on_step, schedule)

    def initialise(self) -> None:
        """To the start: outputs consistent round the system, the start condition solved."""
        table = self.blueprint.scenario.table
        try:
            if table.start is None:
                self._initialise(self.blueprint.values)
            else:
                self._solve_start(table.start)
        except UnitError:
            self._refuse_complaints()  # the cause of a start that cannot be solved, if a unit named one
            raise
        self._refuse_complaints()

    def resume(self, snapshot: Snapshot, on_step: Progress | None = None, schedule: Schedule | None = None) -> RunResult:
        """Go on from a checkpoint of this blueprint, to the same result."""
        with self._last_words():
            self._initialise(self.blueprint.values)
            self._watch_trials()
            self.master.prepare()
            put(self.master, snapshot)
            if schedule is not None:
                schedule.begin(self.master, self.blueprint, fresh=False)
            return self._go(on_step, schedule)

    def stop(self) -> None:
        """End after the present step; the result is then marked interrupted."""
        self.master.stop_requested = True

    def close(self) -> None:
        for slave in self.system.slaves:
            slave.close()

    def _go(self, on_step: Progress | None, schedule: Schedule | None) -> RunResult:
        def after_step(time: float) -> None:
            if schedule is not None:
                schedule.after_step()
            if on_step is not None:
                on_step(time)

        message = ""
        try:
            self._watch()
            self.master.run(after_step)
            if schedule is not None and not self.master.complete:
                schedule.interrupt()
        except RunError as error:
            message = str(error)
        return self._result(message)

    def _last_words(self) -> AbstractContextManager[None]:
        """Where somebody takes what there is of a run when a unit hangs, he takes it when one crashes, too."""

        def say(signal: str) -> None:
            accused = self.master.watchdog.accused(signal) or f"{FmuUnit.called} ({signal}); mend the unit"
            (self.master.watchdog.on_hang or _leave)(accused)

        return nullcontext() if self.on_hang is None else last_words(say)

    def _watch_trials(self) -> None:
        """Before the run there is nothing to be kept of a unit that hangs, but its name."""
        self.master.watchdog.on_hang = None if self.on_hang is None else _leave

    def _watch(self) -> None:
        on_hang = self.on_hang
        if on_hang is not None:
            self.master.watchdog.on_hang = lambda message: on_hang(self._result(message))

    def _refuse_complaints(self) -> None:
        """A UnitError in the units' own words if any could not be initialised: their outputs are mere start values then."""
        said = [f"{slave.name}: {words}" for slave in self.system.slaves if (words := getattr(slave, "complaint", ""))]
        if said:
            raise UnitError(f"{self.blueprint.scenario.where}: {'; '.join(said)}")

    def _initialise(self, values: Sequence[dict[str, Value]]) -> None:
        table = self.blueprint.scenario.table
        self.master.initialise(table.start_time, table.stop_time, values)

    def _solve_start(self, start: StartTable) -> None:
        """Vary one parameter until the smallest of the watched outputs has the asked value."""
        unit, name = self._varied(start)
        watched = [(place, output) for place, outputs in enumerate(self.blueprint.zero) for output in outputs]
        variable = self.system.slaves[unit].interface.variables[name]

        def residual(x: float) -> float:
            self.blueprint.values[unit][name] = x
            self._initialise(self.blueprint.values)
            return min(self.master.value(place, output) for place, output in watched) - start.value

        guess = float(self.blueprint.values[unit].get(name, variable.start or 0.0))
        what = f"{', '.join(self.blueprint.scenario.zero)} = {start.value:g} by varying {start.vary}"
        guess = self._bearable(residual, guess, abs(variable.nominal))
        residual(solve_start(residual, guess, abs(variable.nominal), what))

    def _bearable(self, residual: Callable[[float], float], guess: float, step: float) -> float:
        """The guess, or the first of a few beyond it at which no unit complains: a pad deep in the ground says nothing of its gap."""
        for k in range(START_TRIES):
            residual(guess + k * step)
            if not any(getattr(slave, "complaint", "") for slave in self.system.slaves):
                return guess + k * step
        return guess

    def _varied(self, start: StartTable) -> tuple[int, str]:
        where = self.blueprint.scenario.where
        unit, _, name = start.vary.partition(".")
        names = list(self.blueprint.interfaces)
        if unit not in names:
            raise UnitError(f'{where}: start.vary: no unit "{unit}"; {nearest(unit, names)}')
        variables = self.blueprint.interfaces[unit].variables
        known = [v.name for v in variables.values() if v.kind is Kind.REAL and v.causality in SETTABLE]
        if name not in known:
            raise UnitError(f'{where}: start.vary: unit {unit} has no real parameter "{name}"; {nearest(name, known)}')
        return names.index(unit), name

    def _result(self, message: str) -> RunResult:
        master, table, scenario = self.master, self.blueprint.scenario.table, self.blueprint.scenario
        accepted = sum(row.accepted for row in master.log)
        complete = master.complete and not message  # at the stop time, too, a unit may fail: its last row is not there
        interrupted = not master.complete and not message
        trust = "" if message or interrupted else distrust(master, self.blueprint.scenario.where)
        if interrupted:
            message = "interrupted by the user; everything up to there is kept"
        shown = {f"{u}.{name}": i.variables[name] for u, i in self.blueprint.interfaces.items() for name in i.variables}
        columns = master.recorder.columns()
        return RunResult(
            name=self.blueprint.path.stem if self.blueprint.path else "scenario",
            title=table.title,
            scenario=scenario.as_run(),
            scenario_path=self.blueprint.path,
            scenario_sha256=self.blueprint.sha256,
            start_time=table.start_time,
            stop_time=table.stop_time,
            times=master.recorder.times,
            columns=columns,
            units={name: shown[name].unit for name in columns},
            descriptions={name: shown[name].description for name in columns},
            log=master.log,
            ledger=master.ledger.rows(),
            connections=master.connections(),
            unit_records=[self._unit_record(place) for place in range(len(self.system.slaves))],
            accepted=accepted,
            rejected=len(master.log) - accepted,
            unresolved=master.unresolved,
            wall_time=master.wall_time,
            wall_time_units=sum(slave.seconds for slave in self.system.slaves),
            complete=complete,
            trusted=complete and not trust,
            interrupted=interrupted,
            message=message or trust,
            warnings=master.warnings,
            unit_messages=[f"{slave.name}: {text}" for slave in self.system.slaves for text in slave.messages],
            paper=table.paper,
            results=table.results,
            parameters=self._parameters(),
            variant=scenario.where.partition("#")[2],
        )

    def _parameters(self) -> dict[str, float]:
        known: dict[str, float] = {}
        for (name, interface), given in zip(self.blueprint.interfaces.items(), self.blueprint.values, strict=True):
            known |= numbers(name, interface, given)
        return known

    def _unit_record(self, place: int) -> UnitRecord:
        slave, master = self.system.slaves[place], self.master
        repeated = master.repeated[place]
        passes = master.settings.passes
        stepped = f"{passes} passes, rolled back between" if repeated and passes > 1 else "1 pass" if repeated else "once per accepted step"
        return UnitRecord(
            name=slave.name,
            fmu=slave.interface.path.name if slave.interface.path else "",
            sha256=slave.interface.sha256,
            model_name=slave.interface.model_name,
            guid=slave.interface.guid,
            fmi_version=slave.interface.fmi_version,
            generation_tool=slave.interface.generation_tool,
            capabilities=dict(slave.interface.capabilities),
            rollback=master.rollback[place],
            stepped=stepped,
            steps=slave.steps,
            seconds=slave.seconds,
            parameters=dict(self.blueprint.values[place]),
            trial=master.trials[place],
        )


def fault(result: RunResult) -> OrchestratorError | None:
    """What the command line must report, and with which exit code; None when all is well or the user interrupted."""
    if result.interrupted or result.trusted:
        return None
    return TrustError(result.message) if result.complete else RunError(result.message)


def run_scenario(path: Path, overrides: Sequence[str] = (), changes: dict[str, Any] | None = None) -> RunResult:
    """For scripts and tests: read, load, run, free."""
    simulation = Simulation(draw_up(read_scenario(path, overrides, changes), path))
    try:
        return simulation.run()
    finally:
        simulation.close()


__all__ = ["Blueprint", "Simulation", "draw_up", "fault", "read_scenario", "run_scenario"]
