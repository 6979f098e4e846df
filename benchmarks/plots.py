"""The benchmarks' figures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from tables import Row

COLOURS = {"ours": "#c1272d", "libcosim fixed": "#0b5394", "libcosim ECCO": "#3d85c6", "ecos fixed": "#38761d", "FMPy SSP fixed": "#b45f06",
           "CoFmuPy": "#674ea7"}
MARKS = {"ours": "o", "libcosim fixed": "s", "libcosim ECCO": "D", "ecos fixed": "^", "FMPy SSP fixed": "v", "CoFmuPy": "x"}


def quarter(rows: Sequence[Row], path: Path) -> None:
    """Error against pad steps and against wall time."""
    figure, axes = plt.subplots(1, 2, figsize=(10.0, 4.2), sharey=True, layout="constrained")
    for master in dict.fromkeys(row["master"] for row in rows):
        mine = sorted((r for r in rows if r["master"] == master and r["error"] is not None), key=lambda r: r["pad_steps"])
        for axis, key in zip(axes, ("pad_steps", "wall_s"), strict=True):
            line = "-" if master in ("ours", "libcosim ECCO") else "none"
            axis.loglog([r[key] for r in mine], [r["error"] for r in mine], marker=MARKS.get(master, "."), linestyle=line,
                        color=COLOURS.get(master), label=master, markersize=7)
    axes[0].axhline(2e-4, color="0.6", linewidth=0.8, linestyle="--")
    axes[1].axhline(2e-4, color="0.6", linewidth=0.8, linestyle="--")
    axes[0].set(xlabel="pad doSteps, rejected and repeated ones included", ylabel="largest position error / peak penetration")
    axes[1].set(xlabel="wall time of stepping, s")
    axes[1].legend(frameon=False, fontsize=8)
    finish(figure, axes, path)


def lines(rows: Sequence[Row], path: Path, x: str, ys: Sequence[str], labels: tuple[str, str], log: str = "xy", by: str = "") -> None:
    """Columns of a table over another column, one line per column or per value of the column `by`."""
    figure, axis = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for group in dict.fromkeys(row.get(by) for row in rows):
        mine = [row for row in rows if row.get(by) == group]
        for y in ys:
            label = " ".join(str(part) for part in (group, y if len(ys) > 1 else "") if part) or y
            drawn = [row for row in mine if row.get(y) is not None]
            axis.plot([row[x] for row in drawn], [row[y] for row in drawn], marker="o", label=label)
    axis.set(xlabel=labels[0], ylabel=labels[1], xscale="log" if "x" in log else "linear", yscale="log" if "y" in log else "linear")
    axis.legend(frameon=False, fontsize=8)
    if "y" not in log:
        axis.set_ylim(bottom=0.0)
    finish(figure, [axis], path)


def scatter(rows: Sequence[Row], path: Path, x: str, y: str, labels: tuple[str, str]) -> None:
    """One column over another, logarithmic, a colour a master, each point named by its setting."""
    figure, axis = plt.subplots(figsize=(7.5, 4.5), layout="constrained")
    for master in dict.fromkeys(row["master"] for row in rows):
        drawn = [row for row in rows if row["master"] == master and row[y]]
        if drawn:
            style = master if master in MARKS else f"{master} fixed"
            axis.plot([row[x] for row in drawn], [row[y] for row in drawn], linestyle="none", label=master, markersize=7,
                      marker=MARKS.get(style, "."), color=COLOURS.get(style))
        for row in drawn:
            axis.annotate(row["setting"], (row[x], row[y]), textcoords="offset points", xytext=(6, 4), fontsize=7, color="0.35")
    axis.set(xlabel=labels[0], ylabel=labels[1], xscale="log", yscale="log")
    axis.margins(0.15)
    axis.legend(frameon=False, fontsize=8)
    finish(figure, [axis], path)


def bars(rows: Sequence[Row], path: Path, name: str, value: str, label: str) -> None:
    """A horizontal bar a row."""
    figure, axis = plt.subplots(figsize=(7.0, 0.32 * len(rows) + 1.0), layout="constrained")
    axis.barh([str(row[name]) for row in rows][::-1], [row[value] for row in rows][::-1], color="#0b5394")
    axis.set(xlabel=label)
    finish(figure, [axis], path)


def finish(figure: plt.Figure, axes: Sequence[plt.Axes], path: Path) -> None:
    for axis in axes:
        axis.grid(visible=True, which="major", color="0.9", linewidth=0.6)
        axis.set_axisbelow(True)
        axis.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=130)
    plt.close(figure)
