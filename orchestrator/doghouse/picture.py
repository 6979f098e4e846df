"""doghouse.png: the four boundaries over the certified envelope, vertical against horizontal speed, as the paper's Figure 12."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MultipleLocator

from orchestrator.doghouse.landing import BOUNDARIES
from orchestrator.doghouse.outcome import Outcome
from orchestrator.results.plot_style import FAINT, INK, dress, new_figure, save

FOOT = 0.3048  # m
STYLE = {
    "tip_over": ("tip-over", "#0072B2", "o"),
    "primary_stroke": ("primary stroke", "#D55E00", "s"),
    "secondary_compression": ("secondary compression", "#009E73", "^"),
    "secondary_tension": ("secondary tension", "#CC79A7", "D"),
}
HOUSE, WALL = "#ECEFF3", "#4A5568"


def draw(outcome: Outcome, path: Path) -> Path:
    """A filled marker: both landings of the bracket confirmed by the separate units; hollow: not; a cross: inside the envelope."""
    figure = new_figure(outcome.doghouse.title, 9.2, 7.0)
    axes = figure.add_subplot()
    _house(axes, outcome)
    for name in BOUNDARIES:
        _boundary(axes, outcome, name)
    _audit(axes, outcome)
    _frame(axes, outcome)
    _legend(axes, outcome)
    return save(figure, path)


def _house(axes: Axes, outcome: Outcome) -> None:
    certified = outcome.doghouse.certified
    wall, ridge, eaves = (
        certified.horizontal_limit_m_s,
        certified.vertical_at_zero_horizontal_m_s,
        certified.vertical_at_horizontal_limit_m_s,
    )
    outline = np.array([(0.0, 0.0), (0.0, ridge), (wall, eaves), (wall, 0.0)])
    axes.fill(outline[:, 0], outline[:, 1], color=HOUSE, zorder=0)
    axes.plot(outline[1:, 0], outline[1:, 1], color=WALL, linewidth=2.2, zorder=3, solid_joinstyle="miter")
    axes.text(0.5 * wall, 0.42 * eaves, "certified", ha="center", fontsize=12, color=WALL, style="italic")
    for place, text, offset, side in (
        ((0.0, ridge), f"{ridge / FOOT:.0f} ft/s", (6.0, -18.0), "left"),
        ((wall, eaves), f"{wall / FOOT:.0f}, {eaves / FOOT:.0f} ft/s", (-6.0, -14.0), "right"),
    ):
        axes.annotate(text, place, offset, textcoords="offset points", fontsize=8, color=WALL, ha=side)


def _boundary(axes: Axes, outcome: Outcome, name: str) -> None:
    label, colour, marker = STYLE[name]
    found = [(ray, ray.brackets[name]) for ray in outcome.rays if name in ray.brackets]
    places = [(b.inside.horizontal_m_s, b.inside.vertical_m_s) for _, b in found]
    axes.plot(*zip(*places, strict=True) if places else ([], []), color=colour, linewidth=1.8, zorder=4, label=label)
    for (ray, bracket), (x, y) in zip(found, places, strict=True):
        confirmed = outcome.agrees(ray, name) is True
        axes.plot([x, bracket.beyond.horizontal_m_s], [y, bracket.beyond.vertical_m_s], color=colour, linewidth=1.0, zorder=4)
        fill = colour if confirmed else "white"
        axes.plot(x, y, marker, color=colour, markersize=6.5, markerfacecolor=fill, markeredgewidth=1.4, zorder=5)
        if not outcome.outside(ray, name):
            axes.plot(x, y, "x", color="#B00020", markersize=13, markeredgewidth=2.2, zorder=6)


def _audit(axes: Axes, outcome: Outcome) -> None:
    good = [(one.horizontal_m_s, one.vertical_m_s) for one, margins in outcome.audited if not (margins.failed or margins.error)]
    bad = [(one.horizontal_m_s, one.vertical_m_s) for one, _ in outcome.failed_audit()]
    if good:
        axes.plot(*zip(*good, strict=True), ".", color=FAINT, markersize=2.6, zorder=1)
    if bad:
        axes.plot(*zip(*bad, strict=True), "x", color="#B00020", markersize=6, zorder=6)


def _frame(axes: Axes, outcome: Outcome) -> None:
    """Room for every point, and feet a second along the far sides."""
    points = [b.beyond for ray in outcome.rays for b in ray.brackets.values()]
    certified = outcome.doghouse.certified
    right = max([p.horizontal_m_s for p in points] + [certified.horizontal_limit_m_s]) * 1.08
    top = max([p.vertical_m_s for p in points] + [certified.vertical_at_zero_horizontal_m_s]) * 1.22
    axes.set_xlim(0.0, right)
    axes.set_ylim(0.0, top)
    dress(axes, "vertical speed, m/s", "horizontal speed, m/s")
    for side, lower, upper in (("right", 0.0, top), ("top", 0.0, right)):
        twin = axes.twinx() if side == "right" else axes.twiny()
        (twin.set_ylim if side == "right" else twin.set_xlim)(lower / FOOT, upper / FOOT)
        axis = twin.yaxis if side == "right" else twin.xaxis
        axis.set_major_locator(MultipleLocator(2.0))
        axis.set_label_text("ft/s", fontsize=8, color=INK)
        twin.tick_params(labelsize=7.5, colors=INK, length=2)
        for spine in twin.spines.values():
            spine.set_visible(False)
    for ray in outcome.rays:
        far = 2.0 * math.hypot(right, top)
        axes.plot([0.0, far * math.sin(ray.angle)], [0.0, far * math.cos(ray.angle)], color="#E6E6E6", linewidth=0.7, zorder=0.5)


def _legend(axes: Axes, outcome: Outcome) -> None:
    lines = [Line2D([], [], color=colour, marker=marker, linewidth=1.8, label=label) for label, colour, marker in STYLE.values()]
    extra: list[Line2D | Patch] = [Patch(facecolor=HOUSE, edgecolor=WALL, linewidth=1.6, label="certified envelope")]
    if any(outcome.agrees(ray, name) is not True for ray in outcome.rays for name in ray.brackets):
        extra.append(_sign("o", INK, "not confirmed by the separate units", "white"))
    if outcome.audited:
        bad = len(outcome.failed_audit())
        extra.append(_sign(".", FAINT, f"{len(outcome.audited)} landings at random, {f'{bad} fail' if bad else 'none fails'}"))
    if outcome.inside() or outcome.failed_audit():
        extra.append(_sign("x", "#B00020", "fails inside the envelope"))
    axes.legend(handles=[*lines, *extra], loc="upper right", fontsize=8.5, frameon=True, framealpha=0.95, edgecolor="none", ncols=2)


def _sign(marker: str, colour: str, label: str, fill: str | None = None) -> Line2D:
    return Line2D([], [], color=colour, marker=marker, markerfacecolor=fill or colour, linewidth=0, label=label)
