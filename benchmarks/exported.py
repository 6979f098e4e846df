"""The exported landing in other hosts: how far from our own run of the same file, step by step."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import full
import hosts
from tables import Row, finite, write_json, write_table
from task import task_of

from orchestrator.simulation import draw_up, read_scenario, run_scenario

SCENARIOS = {"Adams-like": full.SCENARIO, "Zupp-like": full.SCENARIO.with_name("apollo11_zupp.toml")}
STEPS = (1e-3, 5e-4, 2e-4, 1e-4)  # s
FINER = (5e-5, 2e-5)  # s: libcosim alone, for which step it would need
CASES = [("Adams-like", "libcosim", step) for step in (*STEPS, *FINER)]
CASES += [("Adams-like", peer, step) for peer in ("ecos", "fmpy") for step in STEPS]
CASES += [("Zupp-like", "libcosim", step) for step in (1e-4, *FINER)] + [("Zupp-like", "ecos", 1e-4)]
WATCH = [*full.BODY, *full.STROKES]
STOP = full.STOP
TIMEOUT = 900.0  # s


def run(out: Path) -> list[Row]:
    """What `out` has of an earlier run is kept; delete ssp.json there after a change of the units."""
    kept = json.loads((out / "ssp.json").read_text("utf-8")) if (out / "ssp.json").exists() else []
    rows: list[Row] = []
    tasks: dict[str, dict[str, Any]] = {}
    ours: dict[str, full.Reference] = {}
    for landing, peer, step in CASES:
        same = [row for row in kept if (row["landing"], row["host"], row["step, ms"]) == (landing, shown(peer), step * 1e3)]
        if same:
            rows.append(same[0])
            continue
        if landing not in tasks:
            scenario = SCENARIOS[landing]
            tasks[landing] = task_of(draw_up(read_scenario(scenario, (), {"stop_time": STOP}), scenario), WATCH)
            record = {"interval": 0.0, "variables": ["body.body.position", "leg*.*.stroke"]}
            result = run_scenario(Path(tasks[landing]["ssp"]), (), {"record": record})
            ours[landing] = result.times, result.columns
        outcome = hosts.run_peer(peer, {**tasks[landing], "step": step}, TIMEOUT)
        rows.append(row_of(landing, peer, step, outcome, ours[landing]))
        print(rows[-1], flush=True)
        write_json(out, "ssp", [*rows, *(row for row in kept if row not in rows)])
    write_table(out, "ssp", rows)
    return rows


def row_of(landing: str, peer: str, step: float, outcome: hosts.Outcome, ours: full.Reference) -> Row:
    body, stroke = full.errors(outcome.times, outcome.values, ours) if outcome.times else (float("nan"), float("nan"))
    return {
        "landing": landing, "host": shown(peer), "step, ms": step * 1e3, "body, mm": finite(body * 1e3), "stroke, cm": finite(stroke * 1e2),
        "wall time, s": finite(outcome.step_s), "message": outcome.message,
    }  # fmt: skip


def shown(peer: str) -> str:
    return hosts.SHOWN[peer].removesuffix(" SSP")
