"""Where every millisecond of a full-vehicle run goes: units by name, FMI calls by kind, recording, the master."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

import full
import plots
from tables import Row, write_json, write_table

from orchestrator.fmi.slave2 import Fmi2Unit
from orchestrator.simulation import Simulation, draw_up, read_scenario

CALLS = ("set inputs", "get outputs", "save", "restore", "observe")


class TimedUnit(Fmi2Unit):
    """Keeps the wall time of its FMI calls by kind; doStep is the rest of `step`."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.spent = dict.fromkeys(("doStep", *CALLS), 0.0)
        timed = {"_send": "set inputs", "_fetch": "get outputs", "save": "save", "restore": "restore", "observe": "observe"}
        for method, kind in timed.items():
            setattr(self, method, partial(self._timed, getattr(self, method), kind))
        self._inner_step = super().step

    def step(self, time: float, interval: float) -> Any:
        before = self.spent["set inputs"] + self.spent["get outputs"]
        begin = perf_counter()
        status = self._inner_step(time, interval)
        self.spent["doStep"] += perf_counter() - begin - (self.spent["set inputs"] + self.spent["get outputs"] - before)
        return status

    def _timed(self, method: Callable[[], None], kind: str) -> None:
        begin = perf_counter()
        method()
        self.spent[kind] += perf_counter() - begin

    def forget(self) -> None:
        self.spent = dict.fromkeys(self.spent, 0.0)


def run(out: Path) -> list[Row]:
    """One run with timed units, after one without them for the total."""
    full.snapshot()
    changes = {"stop_time": full.STOP, "fmus": str(full.FMUS)}
    full.ours(0.01, 1e-3, 1e-5)
    plain = Simulation(draw_up(read_scenario(full.SCENARIO, (), changes), full.SCENARIO)).run()
    blueprint = draw_up(read_scenario(full.SCENARIO, (), changes), full.SCENARIO)
    units = [TimedUnit(name, face.path, face) for name, face in blueprint.interfaces.items()]
    simulation = Simulation(blueprint, units)
    recording = [0.0]
    record = simulation.master.recorder.record

    def timed_record(*arguments: Any) -> None:
        begin = perf_counter()
        record(*arguments)
        recording[0] += perf_counter() - begin

    simulation.master.recorder.record = timed_record  # type: ignore[method-assign]
    prepare = simulation.master.prepare

    def prepare_and_forget() -> None:
        prepare()
        for unit in units:
            unit.forget()

    simulation.master.prepare = prepare_and_forget  # type: ignore[method-assign]
    result = simulation.run()
    rows = [row_of(unit, result.wall_time) for unit in units]
    inside = sum(sum(unit.spent.values()) for unit in units)
    rows.append(whole("recording", recording[0], result.wall_time))
    rows.append(whole("master", result.wall_time - inside - recording[0], result.wall_time))
    rows.append(whole("all", result.wall_time, result.wall_time))
    simulation.close()
    note = (
        f"{full.STOP:g} s simulated, {result.accepted} steps accepted, {result.rejected} rejected; ms of wall time."
        f" Without the timers the same run takes {plain.wall_time * 1e3:.0f} ms: {full.STOP / plain.wall_time:.2f} times real time,"
        f" {1.0 - plain.wall_time_units / plain.wall_time:.0%} of it outside the units. {full.built()}"
    )
    write_json(out, "profile", rows)
    write_table(out, "profile", rows, note)
    plots.bars([row for row in rows if row["what"] != "all"], out / "bench_profile.png", "what", "total", "wall time, ms")
    return rows


def row_of(unit: TimedUnit, wall: float) -> Row:
    total = sum(unit.spent.values())
    spent = {kind: seconds * 1e3 for kind, seconds in unit.spent.items()}
    return {"what": unit.name, "steps": unit.steps, **spent, "total": total * 1e3, "share": total / wall,
            "µs per doStep": unit.spent["doStep"] / max(unit.steps, 1) * 1e6}


def whole(what: str, seconds: float, wall: float) -> Row:
    empty = dict.fromkeys(("doStep", *CALLS))
    return {"what": what, "steps": None, **empty, "total": seconds * 1e3, "share": seconds / wall, "µs per doStep": None}
