"""A made-up landing in memory, smooth enough to look at and with known numbers at its end."""

import numpy as np

from orchestrator.master.result import Attempt, LedgerRow, RunResult, UnitRecord
from orchestrator.results.channels import Array

LEGS = {"+Y": 0.0, "+Z": 0.08, "-Z": 0.62, "-Y": 0.70}  # contact time, s
DEPTHS = {"+Y": 0.062, "+Z": 0.041, "-Z": 0.022, "-Y": 0.031}  # m
TABLE = {
    "kind": "touchdown",
    "compare": "glass_zupp_like",
    "measured": "measured_apollo11",
    "references": "paper.toml",
    "legs": {leg: {"leg": f"leg{leg}", "soil": f"soil{leg}"} for leg in ("+Z", "-Z", "+Y", "-Y")},
}


def settle(times: Array, start: float, end: float, constant: float = 0.05) -> Array:
    """A rise from 0 to `end` that begins at `start`, in s."""
    return np.where(times < start, 0.0, end * (1.0 - np.exp(-np.maximum(times - start, 0.0) / constant)))


def body_columns(times: Array) -> dict[str, Array]:
    """Rates and attitude in rad and rad/s that die out; energies in J."""
    decay = np.exp(-3.0 * times)
    columns = {}
    for axis, (peak, final) in {"yaw": (-2.0, 13.0), "pitch": (8.0, 4.0), "roll": (-8.5, -1.0)}.items():
        columns[f"body.rates.{axis}"] = np.radians(peak * np.sin(6.0 * times) * decay)
        columns[f"body.attitude.{axis}"] = np.radians(final + peak / 3.0 * decay)
    columns |= {f"body.body.velocity[{i}]": -0.5 * decay for i in (1, 2, 3)}
    columns["body.energy.kinetic"] = 2500.0 * decay**2
    columns["body.energy.potential"] = 900.0 * decay + 40000.0
    columns["body.engine.work"] = settle(times, 0.0, -400.0, 0.3)
    return columns


def leg_columns(times: Array, leg: str) -> dict[str, Array]:
    """Pad and struts of one leg, SI."""
    start, depth = LEGS[leg], DEPTHS[leg]
    sunk = settle(times, start, depth)
    columns = {
        f"soil{leg}.penetration": sunk,
        f"soil{leg}.gap": np.maximum(start - times, 0.0) * 0.6 - sunk,
        f"soil{leg}.skid": settle(times, start, 0.2, 0.2),
        f"soil{leg}.contact": (times >= start).astype(float),
        f"soil{leg}.contact_time": np.where(times >= start, start, -1.0),
        f"soil{leg}.normal_force": settle(times, start, 2900.0) * (1.0 + 2.0 * np.exp(-9.0 * np.abs(times - start))),
        f"leg{leg}.pad.work": settle(times, start, -400.0),
        f"leg{leg}.energy.dissipated": settle(times, start, 325.0),
    }
    for i, strut in enumerate(("primary", "right", "left")):
        stroke = settle(times, start, 0.02 * i, 0.1)
        columns |= {f"leg{leg}.{strut}.stroke": stroke, f"leg{leg}.{strut}.peak_stroke": stroke}
        columns[f"leg{leg}.{strut}.load"] = settle(times, start, 2000.0 * (i + 1))
    return columns


def landing(rows: int = 1500, **changes: object) -> RunResult:
    """3 s of a landing of four legs; `changes` replace fields of the result."""
    times = np.linspace(0.0, 3.0, rows) if rows else np.zeros(0)
    columns = body_columns(times)
    for leg in LEGS:
        columns |= leg_columns(times, leg)
    log = [
        Attempt(t, 0.002 * (0.1 if any(abs(t - c) < 0.03 for c in LEGS.values()) else 1.0), 2, 1e-4, True, "soil+Z.pad") for t in times[1:]
    ]
    log += [Attempt(c, 0.002, 2, 4e-3, False, "soil+Y.pad") for c in LEGS.values() if rows]
    record = UnitRecord(
        "body", "VehicleBody.fmu", "0" * 64, "VehicleBody", "{guid}", "2.0", "pythonfmu", {}, True, "2 passes", 3000, 1.5, {"mass": 1.0}
    )
    fields: dict[str, object] = {
        "name": "made_up",
        "title": "A made-up landing",
        "scenario": {"title": "A made-up landing", "stop_time": 3.0, "results": TABLE, "units": {"body": {"fmu": "VehicleBody"}}},
        "scenario_path": None,
        "scenario_sha256": None,
        "start_time": 0.0,
        "stop_time": 3.0,
        "times": times,
        "columns": columns,
        "units": {name: "J" for name in columns if ".energy." in name},
        "descriptions": {},
        "log": log,
        "ledger": [LedgerRow("leg+Z.pad", "soil+Z.pad", -400.0, 400.5, 410.0), LedgerRow("body.leg1", "leg+Z.mount", 100.0, -80.0, 110.0)],
        "unit_records": [record],
        "accepted": max(rows - 1, 0),
        "rejected": 4 if rows else 0,
        "unresolved": 0,
        "wall_time": 2.0,
        "wall_time_units": 1.5,
        "complete": True,
        "trusted": True,
        "results": TABLE,
    }
    return RunResult(**(fields | changes))  # type: ignore[arg-type]
