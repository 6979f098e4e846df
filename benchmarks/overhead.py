"""Overhead per macro step: a ring of 2, 6, 12, 24 units that do nothing, twelve numbers each way."""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

import packs
import plots
from tables import Row, write_json, write_table

from orchestrator.master.result import RunResult
from orchestrator.scenario.expand import expand
from orchestrator.scenario.read import check_table
from orchestrator.simulation import Simulation, draw_up

NUMBERS = (2, 6, 12, 24)
STEPS, INTERVAL = 2000, 1e-3
REPEATS = 5


def ring(count: int, passes: int) -> RunResult:
    """Each unit feeds the next, the last one the first."""
    packed = packs.FOLDER / "RingUnit.fmu"
    names = [f"unit{number}" for number in range(count)]
    tree: dict[str, Any] = {
        "stop_time": STEPS * INTERVAL,
        "units": {name: {"fmu": str(packed)} for name in names},
        "connections": [{"from": f"{a}.out.value", "to": f"{b}.in.value"} for a, b in zip(names, [*names[1:], names[0]], strict=True)],
        "master": {"passes": passes, "max_interval": INTERVAL},
        "record": {"interval": STEPS * INTERVAL, "variables": ["unit0.out.value[1]"]},
    }
    simulation = Simulation(draw_up(expand(check_table(tree, "ring"), "ring", ())))
    try:
        return simulation.run()
    finally:
        simulation.close()


def run(out: Path) -> list[Row]:
    packs.packed({"ring_unit": (packs.HERE / "toys" / "ring_unit.py").read_text("utf-8")}, ["ring_unit"], packs.FOLDER)
    rows = []
    for passes in (1, 2):
        ring(2, passes)
        for count in NUMBERS:
            results = [ring(count, passes) for _ in range(REPEATS)]
            steps = results[0].accepted
            whole = median(r.wall_time for r in results) / steps * 1e6
            outside = median(r.wall_time - r.wall_time_units for r in results) / steps * 1e6
            rows.append({
                "units": count, "passes": passes, "macro steps": steps, "µs per macro step": whole, "of it the master": outside,
                "of it the units with FMI": whole - outside, "master, µs per unit": outside / count,
                "master in the best run": min(r.wall_time - r.wall_time_units for r in results) / steps * 1e6,
            })
    write_json(out, "overhead", rows)
    note = f"Medians (and the best) of {REPEATS} runs of {STEPS} steps; twelve inputs and twelve outputs a unit."
    write_table(out, "overhead", rows, note)
    drawn = [{**row, "by": f"{row['passes']} pass{'es' * (row['passes'] > 1)}"} for row in rows]
    plots.lines(drawn, out / "bench_overhead.png", "units", ["of it the master"], ("units in a ring", "master alone, µs per macro step"),
                log="", by="by")
    return rows
