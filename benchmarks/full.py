"""The full vehicle: error against the monolithic twin, and cost, over intervals and tolerances; and what other masters make of it."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any

import hosts
import numpy as np
import plots
from numpy.typing import NDArray
from packs import ROOT
from tables import Row, finite, write_json, write_table
from task import task_of

from orchestrator.master.result import RunResult
from orchestrator.simulation import draw_up, read_scenario, run_scenario

SCENARIO = ROOT / "scenarios" / "apollo11_adams.toml"
TWIN = ROOT / "scenarios" / "apollo11_adams_twin.toml"
STOP = 1.5  # s
FMUS = ROOT / "build" / "benchmarks" / "vehicle"  # as they were when the benchmark began, whatever is built meanwhile
LEGS = ("+Z", "+Y", "-Z", "-Y")
STRUTS = ("primary", "right", "left")
BODY = [f"body.body.position[{i}]" for i in (1, 2, 3)]
STROKES = [f"leg{leg}.{strut}.stroke" for leg in LEGS for strut in STRUTS]
SETTINGS = ((1e-3, 1e-5), (2e-3, 1e-5), (5e-3, 1e-5), (1e-2, 1e-5), (2e-3, 1e-6), (5e-4, 1e-5))
PEER_CASES = [("libcosim", step) for step in (1e-3, 5e-4, 2e-4, 1e-4)] + [(peer, 5e-4) for peer in ("ecos", "fmpy", "cofmupy")]
PEER_TIMEOUT = 150.0  # s
Reference = tuple[NDArray[np.float64], dict[str, NDArray[np.float64]]]


def snapshot() -> None:
    shutil.copytree(ROOT / "build" / "fmus", FMUS, dirs_exist_ok=True)


def built() -> str:
    """Which units these are: name and SHA-256, shortened, of each FMU."""
    return "FMUs: " + ", ".join(f"{fmu.stem} {sha256(fmu.read_bytes()).hexdigest()[:8]}" for fmu in sorted(FMUS.glob("*.fmu"))) + "."


def twin() -> Reference:
    """The monolithic run, its columns under the co-simulation's names."""
    record = {"interval": 0.0, "variables": ["lander.body.position", "lander.leg*.*.stroke"]}
    changes = {"stop_time": STOP, "fmus": str(FMUS), "master": {"max_interval": 2.5e-4}, "record": record}
    result = run_scenario(TWIN, ("lander.tolerance=1e-7",), changes)
    named = {name: result.columns[f"lander.{name.removeprefix('body.')}"] for name in BODY}
    for number, leg in enumerate(LEGS, 1):
        named |= {f"leg{leg}.{strut}.stroke": result.columns[f"lander.leg{number}.{strut}.stroke"] for strut in STRUTS}
    return result.times, named


def errors(times: Sequence[float], values: dict[str, Any], reference: Reference) -> tuple[float, float]:
    """Largest distance of the body and largest difference of a stroke, m."""
    t = np.minimum(np.asarray(times), reference[0][-1])
    gaps = {name: np.asarray(values[name]) - np.interp(t, reference[0], reference[1][name]) for name in [*BODY, *STROKES]}
    body = np.sqrt(sum(gaps[name] ** 2 for name in BODY))
    return float(body.max()), max(float(np.abs(gaps[name]).max()) for name in STROKES)


def ours(stop: float, longest: float, tolerance: float) -> RunResult:
    changes = {
        "stop_time": stop, "fmus": str(FMUS), "master": {"max_interval": longest, "tolerance": tolerance},
        "record": {"interval": 0.0, "variables": ["body.body.position", "leg*.*.stroke"]},
    }
    return run_scenario(SCENARIO, (), changes)


def our_row(stop: float, longest: float, tolerance: float, reference: Reference) -> Row:
    result = ours(stop, longest, tolerance)
    body, stroke = errors(result.times, result.columns, reference)
    return {
        "master": "ours", "setting": f"at most {longest * 1e3:g} ms, {tolerance:g} m", "simulated_s": stop,
        "accepted": result.accepted, "rejected": result.rejected, "unit_steps": sum(r.steps for r in result.unit_records),
        "body_mm": body * 1e3, "stroke_cm": stroke * 1e2, "wall_s": result.wall_time, "times real time": stop / result.wall_time,
        "message": result.message,
    }


def peer_task() -> dict[str, Any]:
    """The vehicle for a peer: solved start values, and every connected input set to what it is at the start."""
    blueprint = draw_up(read_scenario(SCENARIO, (), {"stop_time": STOP, "fmus": str(FMUS)}), SCENARIO)
    return task_of(blueprint, [*BODY, *STROKES])


def peer_row(peer: str, step: float, base: dict[str, Any], reference: Reference) -> Row:
    job = {**base, "step": step, "method": "jacobi" if peer == "cofmupy" else "fixed"}
    outcome = hosts.run_peer(peer, job, PEER_TIMEOUT)
    body, stroke = errors(outcome.times, outcome.values, reference) if outcome.times else (float("nan"), float("nan"))
    return {
        "master": hosts.SHOWN[peer], "setting": f"fixed {step * 1e3:g} ms", "simulated_s": STOP,
        "accepted": len(outcome.times) or None, "rejected": None, "unit_steps": len(outcome.times) * len(base["units"]) or None,
        "body_mm": finite(body * 1e3), "stroke_cm": finite(stroke * 1e2), "wall_s": finite(outcome.step_s),
        "times real time": finite(STOP / outcome.step_s), "message": outcome.message,
    }


def run(out: Path) -> list[Row]:
    snapshot()
    reference = twin()
    ours(0.01, 1e-3, 1e-5)                                   # compiled code is read before the clock runs
    rows = [our_row(STOP, longest, tolerance, reference) for longest, tolerance in SETTINGS]
    base = peer_task()
    for peer, step in PEER_CASES:
        rows.append(peer_row(peer, step, base, reference))
        print({key: rows[-1][key] for key in ("master", "setting", "body_mm", "stroke_cm", "wall_s", "message")}, flush=True)
    write_json(out, "full-vehicle", rows)
    write_table(out, "full-vehicle", rows, f"{len(base['units'])} units, {len(base['links'])} connections of scalars. {built()}")
    plots.scatter(rows, out / "bench_full_vehicle.png", "wall_s", "body_mm", ("wall time of stepping, s", "largest error of the body, mm"))
    return rows
