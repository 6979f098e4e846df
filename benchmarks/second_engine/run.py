"""Landings of another engine with something hidden in them, diagnosed by the command line:

    python benchmarks/second_engine/run.py --out results/second_engine [--only NAME]

Needs `pip install .[test]` (MuJoCo). Writes DIR/NAME/{fit,holdout} and DIR/NAME/out; a diagnosis that is there is not made again.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from second_engine.flight import land
from second_engine.landing import Landing
from second_engine.readings import drawn, write

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Hidden:
    """What the scenario does not have, and in which draw."""

    seed: int
    change: dict[str, Any] = field(default_factory=dict)
    lag: float = 0.0


CASES = {
    "nothing": Hidden(1),
    "inertial_drag": Hidden(2, {"inertial_drag": 6000.0}),
    "telemetry_lowpass": Hidden(3, lag=0.02),
    "bearing_strength_-Z": Hidden(4, {"strength_of_pad": (1.0, 1.0, 1.6, 1.0)}),
    "plowing": Hidden(5, {"plowing": 6000.0}),
    "roll_drag (outside the library)": Hidden(6, {"roll_drag": 60000.0}),
}


def make(case: Hidden, folder: Path) -> None:
    """Two landings of one vehicle on one soil."""
    expected, shared = Landing(), np.random.default_rng([case.seed, 2])
    strength = expected.bearing_strength * np.exp(0.12 * shared.standard_normal())
    soil = {"bearing_strength": strength, "friction": shared.normal(expected.friction, 0.03)}
    for k, name in enumerate(("fit", "holdout")):
        if not (folder / name / "landing.toml").is_file():
            random = np.random.default_rng([case.seed, k])
            course = land(replace(expected, **soil, **drawn(random, expected), **case.change))
            write(folder / name, course, expected, random, case.lag)


def diagnose(folder: Path) -> dict[str, Any]:
    command = [sys.executable, "-m", "orchestrator", "diagnose", "apollo11_zupp", "--measured", folder / "fit",
               "--holdout", folder / "holdout", "--out", folder / "out", "--workers", "1"]  # fmt: skip
    if not (folder / "out" / "diagnosis.json").is_file():
        subprocess.run([str(it) for it in command], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return dict(json.loads((folder / "out" / "diagnosis.json").read_text("utf-8")))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--only", choices=list(CASES))
    options = parser.parse_args()
    for name, case in CASES.items():
        if options.only in (None, name):
            folder = options.out / name.partition(" ")[0]
            make(case, folder)
            said = diagnose(folder)
            print("| " + " | ".join([name, *row(said)]) + " |", flush=True)


def row(said: dict[str, Any]) -> list[str]:
    """Verdict, who leads with ln evidence, his numbers, p-value of nothing missing, share of the gap closed, landings, s."""
    best = max(said["candidates"], key=lambda it: float(it["log_evidence"]))
    numbers = [f"{name} {it['value']:.4g} ± {it['sigma']:.2g} {it['unit']}" for name, it in best["parameters"].items()]
    closure = said["gap"]["closure"]
    return [said["verdict"], f"{best['name']} ({best['log_evidence']:+.1f})", ", ".join(numbers), f"{said['adequacy_null']:.1g}",
            "" if closure is None else f"{100 * closure:.0f} %", str(said["simulations"]), f"{said['seconds']:.0f}"]  # fmt: skip


if __name__ == "__main__":
    main()
