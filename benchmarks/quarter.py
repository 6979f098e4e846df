"""Quarter vehicle: one stiff cut, the same two FMUs under every master, error against a monolithic run."""

from __future__ import annotations

import sys
from itertools import pairwise
from math import exp, log
from pathlib import Path
from statistics import median
from typing import Any

import hosts
import packs
import plots
import reference
from hosts import Outcome
from tables import Row, finite, write_json, write_table
from task import task_of

from orchestrator.simulation import draw_up, read_scenario

SCENARIO = packs.HERE / "quarter_vehicle" / "quarter_vehicle.toml"
PAD = "vehicle.pad.position"
LONG = 2.0  # s: a run that takes longer is not repeated
OUR_REPEATS = 9  # short runs, noisy times
ECCO = "libcosim ECCO"
Case = tuple[str, str, str, dict[str, Any]]


def cases() -> list[Case]:
    """Master, setting, script and what the job says besides."""
    ours: list[Case] = [("ours", "default", "ours", {})]
    ours += [("ours", f"tolerance {tolerance:g} m", "ours", {"master": {"tolerance": tolerance}}) for tolerance in (1e-4, 1e-6, 1e-7)]
    found = ours + [fixed("libcosim", "libcosim", step) for step in (5e-4, 1e-4, 2e-5)]
    found += [
        (ECCO, f"tolerance {tolerance:g}", "libcosim", {"method": "ecco", "step": 1e-4, "tolerance": tolerance})
        for tolerance in (1e-3, 1e-4, 1e-5, 1e-6)
    ]
    found += [fixed(hosts.SHOWN[peer], peer, step) for peer in ("ecos", "fmpy") for step in (5e-4, 1e-4)]
    found.append(fixed("ecos", "ecos", 1e-5))
    for method, step in (("jacobi", 5e-4), ("jacobi", 1e-4), ("gauss_seidel iterative", 5e-4), ("gauss_seidel iterative", 1e-4)):
        found.append(("CoFmuPy", f"{method}, {step * 1e3:g} ms", "cofmupy", {"method": method, "step": step}))
    return found


def fixed(master: str, script: str, step: float) -> Case:
    return (f"{master} fixed", f"{step * 1e3:g} ms", script, {"method": "jacobi" if script == "cofmupy" else "fixed", "step": step})


def task() -> dict[str, Any]:
    """The quarter vehicle for any master, with ECCO's power bond between force and velocity."""
    blueprint = draw_up(read_scenario(SCENARIO), SCENARIO)
    references = {unit: {v.name: v.reference for v in face.variables.values()} for unit, face in blueprint.interfaces.items()}
    vehicle, soil = references["vehicle"], references["soil"]
    bond = ["vehicle", vehicle["pad.velocity"], vehicle["pad.force"], "soil", soil["pad.force"], soil["pad.velocity"]]
    return {**task_of(blueprint, [PAD]), "bonds": [bond]}


def run_case(case: Case, base: dict[str, Any]) -> Outcome:
    """One run of one case."""
    _, _, script, options = case
    if script == "ours":
        job = {"scenario": str(SCENARIO), "changes": options, "watch": [PAD]}
        return hosts.run_script(Path(sys.executable), packs.HERE / "peers" / "run_ours.py", job)
    return hosts.run_peer(script, {**base, **options})


def row_of(case: Case, outcomes: list[Outcome]) -> Row:
    """Error and steps of the first run (all are alike), medians of the wall times."""
    first = outcomes[0]
    steps = first.counts.get("QuarterVehicle")
    wrong = reference.error(first.times, first.values[PAD]) if first.times else float("nan")
    return {
        "master": case[0], "setting": case[1], "pad_steps": steps, "error": finite(wrong),
        "wall_s": finite(median(o.step_s for o in outcomes)), "whole_s": finite(median(o.whole_s for o in outcomes)),
        "message": first.message,
    }


def run(out: Path, repeats: int = 3) -> list[Row]:
    """All cases; files in `out`."""
    packs.quarter_vehicle_fmus()
    base = task()
    for case in {case[2]: case for case in cases()}.values():      # compiled code and environments are made before the clock runs
        run_case(case, {**base, "stop": 1e-3})
    rows = []
    for case in cases():
        outcomes = [run_case(case, base)]
        if not outcomes[0].message and outcomes[0].step_s < LONG:
            more = OUR_REPEATS if case[2] == "ours" else repeats
            outcomes += [run_case(case, base) for _ in range(more - 1)]
        rows.append(row_of(case, outcomes))
        print(f"{case[0]}, {case[1]}: {rows[-1]['pad_steps']} pad steps, error {rows[-1]['error']}, {rows[-1]['wall_s']} s", flush=True)
    write_json(out, "quarter-vehicle", rows)
    report(rows, out)
    return rows


def report(rows: list[Row], out: Path) -> None:
    """Tables and figure of the rows."""
    write_table(out, "quarter-vehicle", rows)
    equal = at_equal_error(rows)
    if equal:
        write_table(out, "quarter-vehicle-equal-error", equal)
    plots.quarter(rows, out / "bench_quarter_vehicle.png")


def at_equal_error(rows: list[Row]) -> list[Row]:
    """What ECCO needs for the error of each of our rows, by interpolation of logarithms between its tolerances.

    Where its tightest tolerance is less accurate than our row, what it needed there: a bound from below.
    """
    peers = sorted((r for r in rows if r["master"] == ECCO and r["error"]), key=lambda r: r["error"])
    found = []
    for mine in (r for r in rows if r["master"] == "ours" and r["error"]):
        around = next((pair for pair in pairwise(peers) if pair[0]["error"] <= mine["error"] <= pair[1]["error"]), None)
        if around is None and not (peers and mine["error"] < peers[0]["error"]):
            continue
        low, high = around or (peers[0], peers[0])
        steps, wall = (between(mine["error"], low, high, key) for key in ("pad_steps", "wall_s"))
        found.append({
            "setting": mine["setting"], "error": mine["error"], "pad_steps": mine["pad_steps"], "wall_s": mine["wall_s"],
            "ECCO pad_steps": ("" if around else "more than ") + f"{steps:,.0f}", "ECCO wall_s": wall,
            "times fewer pad steps": steps / mine["pad_steps"], "times less wall time": wall / mine["wall_s"],
        })
    return found


def between(error: float, low: Row, high: Row, key: str) -> float:
    """The value of a column at this error, on the line through two rows in logarithms."""
    if low is high:
        return float(low[key])
    share = log(error / low["error"]) / log(high["error"] / low["error"])
    return exp(log(low[key]) + share * log(high[key] / low[key]))
