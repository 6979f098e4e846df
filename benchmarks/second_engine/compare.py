"""The twin beside MuJoCo: table and figure of docs/results.md.

    python benchmarks/second_engine/compare.py --out DIR
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pyarrow.parquet as pq

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from second_engine.flight import land
from second_engine.landing import ADAMS, LIGHT, ZUPP, Array, Course, Landing

mpl.use("Agg")
import matplotlib.pyplot as plt

ROOT = Path(__file__).resolve().parents[2]
AXES = ("yaw", "pitch", "roll")
CASES = {
    "Zupp-like": ("apollo11_zupp_twin", ZUPP),
    "Adams-like": ("apollo11_adams_twin", ADAMS),
    "Zupp-like, secondaries without mass": ("apollo11_zupp_twin", replace(ZUPP, secondary_mass=LIGHT)),
}
SCALARS = {"strokes_m": "stroke", "penetration_m": "penetration", "skid_m": "skid"}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args()
    print("| RMS and largest difference | rates, rad/s | attitude, rad | a stroke, mm | a depth, mm | a skid, mm |")
    print("| --- |" + " ---: |" * 5)
    for k, (title, (scenario, other)) in enumerate(CASES.items()):
        folder = options.out / str(k)
        flown(scenario, other, folder)
        theirs = land(other)
        rates, attitude = series(folder, theirs, "rates"), series(folder, theirs, "attitude")
        if k == 0:
            picture(theirs, rates, options.out / "second_engine.png")
        spread = [float(np.sqrt(np.mean(it**2, axis=0)).max()) for it in (rates - theirs.rates, attitude - theirs.attitude)]
        summary = json.loads((folder / "summary.json").read_text("utf-8"))
        largest = [max(abs(x - theirs.values[f"{name}.{at}"]) for at, x in summary[key].items()) for key, name in SCALARS.items()]
        print(f"| {title} | {spread[0]:.1e} | {spread[1]:.1e} | " + " | ".join(f"{1e3 * it:.2f}" for it in largest) + " |", flush=True)


def flown(scenario: str, other: Landing, folder: Path) -> None:
    """The twin, law 2 of the soil."""
    settings = [f"lander.soil.law[{i}]=2" for i in (1, 2, 3, 4)] + [f"lander.secondary_strut_mass={other.secondary_mass}"]
    words = [word for it in settings for word in ("--set", it)]
    command = [sys.executable, "-m", "orchestrator", "run", scenario, "--out", str(folder), "--no-figures", *words]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)


def series(folder: Path, theirs: Course, channel: str) -> Array:
    names = ["time", *(f"lander.{channel}.{it}" for it in AXES)]
    table = pq.read_table(folder / "history.parquet", columns=names)
    return np.column_stack([np.interp(theirs.times, table["time"], table[it]) for it in names[1:]])


def picture(theirs: Course, ours: Array, path: Path) -> None:
    """Rates of both, and how far they are apart."""
    figure, (above, below) = plt.subplots(2, 1, figsize=(8.0, 5.6), sharex=True, layout="constrained", height_ratios=(2, 1))
    for k, (axis, colour) in enumerate(zip(AXES, ("#674ea7", "#c1272d", "#0b5394"), strict=True)):
        above.plot(theirs.times, np.degrees(ours[:, k]), color=colour, linewidth=3.0, alpha=0.35)
        above.plot(theirs.times, np.degrees(theirs.rates[:, k]), color=colour, linewidth=0.9, label=axis)
        below.plot(theirs.times, np.degrees(ours[:, k] - theirs.rates[:, k]), color=colour, linewidth=0.8)
    above.set(ylabel="rate, deg/s", title="Zupp-like: the twin (broad) and MuJoCo (thin)")
    above.legend(frameon=False)
    below.set(ylabel="difference, deg/s", xlabel="time since first contact, s", xlim=(0.0, 4.0))
    for axes in (above, below):
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(alpha=0.3)
    figure.savefig(path, dpi=130)


if __name__ == "__main__":
    main()
