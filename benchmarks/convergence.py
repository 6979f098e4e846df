"""Observed order of the master on a smooth case: two masses on springs, cut between them, against the exact solution."""

from __future__ import annotations

from math import log
from pathlib import Path
from typing import Any

import numpy as np
import packs
import plots
from scipy.linalg import expm
from tables import Row, write_json, write_table

from orchestrator.scenario.expand import expand
from orchestrator.scenario.read import check_table
from orchestrator.simulation import Simulation, draw_up

INTERVALS = (3.2e-2, 1.6e-2, 8e-3, 4e-3, 2e-3, 1e-3)
STOP = 1.6  # s
FMUS = ("SpringMass", "SpringFollower")
FILES = ("spring_mass", "spring_follower")
M1, K1, K, C, M2, K2 = 1.0, 40.0, 20.0, 0.4, 1.0, 60.0
START = (0.1, 0.0, 0.0, 0.0)


def exact(times: np.ndarray) -> np.ndarray:
    """The first mass's position."""
    system = np.array([
        [0.0, 1.0, 0.0, 0.0], [-(K1 + K) / M1, -C / M1, K / M1, C / M1],
        [0.0, 0.0, 0.0, 1.0], [K / M2, C / M2, -(K2 + K) / M2, -C / M2],
    ])
    return np.array([(expm(system * t) @ START)[0] for t in times])


def error(scheme: dict[str, Any], interval: float) -> float:
    """Largest position error over the largest position, with this interval throughout."""
    tree: dict[str, Any] = {
        "stop_time": STOP,
        "units": {name: {"fmu": str(packs.FOLDER / f"{fmu}.fmu")} for name, fmu in zip(("mass", "follower"), FMUS, strict=True)},
        "connections": [{"ports": ["mass.end", "follower.end"]}],
        "master": {"max_interval": interval, "min_interval": interval, "unresolved_limit": 1.0, **scheme},
        "record": {"variables": ["mass.end.position"]},
    }
    simulation = Simulation(draw_up(expand(check_table(tree, "oscillator"), "oscillator", ())))
    try:
        result = simulation.run()
    finally:
        simulation.close()
    truth = exact(result.times)
    return float(np.abs(result.columns["mass.end.position"] - truth).max() / np.abs(truth).max())


def run(out: Path) -> list[Row]:
    folder = packs.HERE / "toys"
    packs.packed({file: (folder / f"{file}.py").read_text("utf-8") for file in FILES}, FILES, packs.FOLDER)
    rows: list[Row] = []
    for name, scheme in (("default", {}), ("tighter iteration", {"tolerance": 1e-9})):
        before: Row | None = None
        for interval in INTERVALS:
            wrong = error(scheme, interval)
            order = log(before["error"] / wrong) / log(before["interval_s"] / interval) if before else None
            before = {"setting": name, "interval_s": interval, "error": wrong, "observed order": order}
            rows.append(before)
    write_json(out, "convergence", rows)
    write_table(out, "convergence", rows)
    plots.lines(rows, out / "bench_convergence.png", "interval_s", ["error"], ("interval, s", "largest error / amplitude"), by="setting")
    return rows
