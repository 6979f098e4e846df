"""Cost as the number of legs grows: the same landing on 3, 4, 6 and 8 legs at equal azimuths."""

from __future__ import annotations

from math import pi
from pathlib import Path
from statistics import median

import plots
from full import FMUS, built, snapshot
from packs import ROOT
from tables import Row, write_json, write_table

from orchestrator.master.result import RunResult
from orchestrator.scenario.expand import expand
from orchestrator.scenario.read import check_table, merge, read_table
from orchestrator.simulation import Simulation, draw_up

SCENARIO = ROOT / "scenarios" / "apollo11_adams.toml"
NUMBERS = (3, 4, 6, 8)
STOP = 0.5  # s
REPEATS = 3


def landing(legs: int, stop: float) -> RunResult:
    """Apollo 11 Adams-like with another number of legs; their struts and footpads stay as they are."""
    names = [str(number) for number in range(1, legs + 1)]
    changes = {"stop_time": stop, "fmus": str(FMUS), "each": {"leg": names}, "record": {"variables": ["body.body.position"]}}
    tree = merge(read_table(SCENARIO), changes)
    turns = {name: (2.0 * pi * number / legs + pi) % (2.0 * pi) - pi for number, name in enumerate(names)}
    tree["units"]["leg{leg}"]["parameters"]["azimuth"] = turns
    simulation = Simulation(draw_up(expand(check_table(tree, SCENARIO.name), SCENARIO.name, ()), SCENARIO))
    try:
        return simulation.run()
    finally:
        simulation.close()


def run(out: Path) -> list[Row]:
    snapshot()
    landing(3, 0.01)
    rows = []
    for legs in NUMBERS:
        results = [landing(legs, STOP) for _ in range(REPEATS)]
        wall, units = median(r.wall_time for r in results), median(r.wall_time_units for r in results)
        first = results[0]
        steps = len(first.log)
        rows.append({
            "legs": legs, "units": len(first.unit_records), "accepted": first.accepted, "rejected": first.rejected,
            "unit_steps": sum(r.steps for r in first.unit_records), "wall_s": wall, "ms per attempted step": wall / steps * 1e3,
            "ms per step and leg": wall / steps / legs * 1e3, "share outside units": 1.0 - units / wall, "message": first.message,
        })
    write_json(out, "legs", rows)
    write_table(out, "legs", rows, f"{STOP:g} s simulated; medians of {REPEATS} runs. {built()}")
    plots.lines(rows, out / "bench_legs.png", "legs", ["ms per attempted step"], ("legs", "wall time per attempted macro step, ms"), log="")
    return rows
