"""Where simulation and data disagree: a strip a channel, windows shaded by their strength, contacts as lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from orchestrator.diagnosis.outcome import Where
from orchestrator.diagnosis.report.courses import ChannelCourse, LandingCourses
from orchestrator.diagnosis.report.numbers import number
from orchestrator.diagnosis.report.picture import BEFORE, Picture, plain, sheet, shortened
from orchestrator.diagnosis.report.plot_courses import TIME, name_contacts
from orchestrator.results.plot_style import DASHES, INK, leg_colours

DEEPEST = 0.85  # opacity of the strongest window
HEIGHT = 0.72  # of a strip, of 1
STRONGEST = (
    "Where the scenario, its uncertain values fitted, disagrees with the data: the fuller the colour, the stronger. "
    "Numbers are standard deviations."
)
NOWHERE = (
    "With its uncertain values fitted the scenario disagrees with the data in no stretch of any channel by more than noise does somewhere: "
    "what is missing, if anything, shows in all readings together."
)


def where_picture(
    windows: Sequence[Where], landing: LandingCourses | None, events: Mapping[str, float], name: str = "where"
) -> Picture | None:
    """Windows of one landing over its channels; None where there is neither a window nor a channel."""
    strips = {c.channel: c for c in landing.channels} if landing else {}
    timed = [w for w in windows if np.isfinite(w.from_s) and np.isfinite(w.to_s)]
    rows = list(dict.fromkeys([*strips, *(w.channel for w in timed)]))
    if not rows:
        return None
    figure = sheet(0.75 + 0.42 * len(rows))
    axes = figure.subplots()
    plain(axes, [shortened(row) for row in rows])
    axes.set_xlabel(TIME, fontsize=9, color=INK)
    _residuals(axes, rows, strips)
    strongest = max((w.sigmas for w in timed if np.isfinite(w.sigmas)), default=1.0)
    shift = landing.shift if landing else 0.0
    for window in timed:
        _shade(axes, rows.index(window.channel), window, strongest, shift)
    axes.margins(x=0.02)
    axes.autoscale(axis="x")
    contacts = [(c.pad, c.time) for c in landing.contacts] if landing and landing.contacts else [(p, t + shift) for p, t in events.items()]
    _lines(axes, sorted(((pad, t) for pad, t in contacts if np.isfinite(t)), key=lambda pair: pair[1]))
    told = [f"{w.channel} from {w.from_s:.2f} to {w.to_s:.2f} s ({number(w.sigmas, 2)} sigma)" for w in timed]
    caption = STRONGEST if timed else NOWHERE
    caption += " The thin line is the residual, each strip to 4 σ or its own largest; dashed: the pads' first contacts in the simulation."
    return Picture(
        name,
        "Where simulation and data disagree",
        figure,
        caption,
        "Disagreement along time. " + ("; ".join(told) or "No window stands out") + ".",
    )


def _shade(axes: Axes, row: int, window: Where, strongest: float, shift: float) -> None:
    share = max(window.sigmas, 0.0) / strongest if np.isfinite(window.sigmas) and strongest > 0.0 else 0.3
    width = max(window.to_s - window.from_s, 1e-3)
    start, end = window.from_s + shift, window.to_s + shift
    box = (start, row - HEIGHT / 2)
    alpha = 0.15 + (DEEPEST - 0.15) * min(share, 1.0)
    axes.add_patch(Rectangle(box, width, HEIGHT, color=BEFORE, alpha=alpha, linewidth=0, zorder=2))
    axes.update_datalim([(start, row), (end, row)])
    text = f"{number(window.sigmas, 2)} σ"
    axes.text(end, row - 0.24, f" {text}", fontsize=8, fontweight="bold", color=INK, ha="left", va="center", zorder=5)


def _residuals(axes: Axes, rows: Sequence[str], strips: Mapping[str, ChannelCourse]) -> None:
    """A thin line a strip, every strip to its own largest residual, at least to 4 σ."""
    for row, name in enumerate(rows):
        residual = strips[name].residual_before if name in strips else None
        if residual is None or not np.isfinite(residual).any():
            continue
        limit = max(float(np.nanmax(np.abs(residual))), 4.0)
        axes.plot(strips[name].data_times, row - 0.5 * HEIGHT * residual / limit, color=INK, linewidth=0.7, alpha=0.75, zorder=3)


def _lines(axes: Axes, contacts: list[tuple[str, float]]) -> None:
    colours = leg_colours([pad for pad, _ in contacts])
    for pad, time in contacts:
        axes.axvline(time, color=colours[pad], linewidth=0.9, linestyle=DASHES, alpha=0.8, zorder=1)
    name_contacts(axes, contacts, colours)
