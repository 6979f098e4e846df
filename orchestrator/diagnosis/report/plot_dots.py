"""Dots on rows: values at rest against what was measured, and nuisances against their priors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from orchestrator.diagnosis.report.courses import RestValue
from orchestrator.diagnosis.report.numbers import shown_unit, signed, spelt
from orchestrator.diagnosis.report.picture import AFTER, BEFORE, FITTED, Picture, plain, sheet, shortened
from orchestrator.results.plot_style import FAINT, INK

ROW = 0.21  # inches
WIDEST = 6.0  # of standard deviations a pull is drawn at


def rest_picture(values: Sequence[RestValue], name: str = "rest") -> Picture | None:
    """A panel a kind of value, a row a value: measured with its deviation or interval, before, after."""
    groups: dict[tuple[str, str], list[RestValue]] = {}
    for value in values:
        groups.setdefault((value.name.partition(".")[0], value.unit), []).append(value)
    if not groups:
        return None
    figure = sheet(0.4 + sum(0.45 + ROW * len(group) for group in groups.values()))
    panels = figure.subplots(len(groups), 1, squeeze=False, height_ratios=[len(group) + 1.0 for group in groups.values()])[:, 0]
    for axes, ((kind, unit), group) in zip(panels, groups.items(), strict=True):
        _rest_panel(axes, kind, unit, group)
    styles = [(INK, "o", INK, "measured ± σ, or between bounds"), (FITTED, "|", FITTED, "scenario as it stands")]
    styles.append((BEFORE, "o", "none", "before"))
    if any(value.after is not None for value in values):
        styles.append((AFTER, "o", AFTER, "after"))
    handles = [Line2D([], [], color=c, marker=m, markerfacecolor=f, linestyle="", markersize=5) for c, m, f, _ in styles]
    figure.legend(handles, [s[-1] for s in styles], loc="outside lower center", ncols=4, fontsize=8, frameon=False, labelcolor=INK)
    told = f"{len(values)} values at rest; {_inside(values)}"
    return Picture(name, "Values at rest", figure, f"Values at rest, measured and simulated: {_inside(values)}.", f"Dot plot of {told}.")


def _inside(values: Sequence[RestValue]) -> str:
    pairs = [(missed(v, v.before_fitted if v.before_fitted is not None else v.before), missed(v, v.after)) for v in values]
    parts = []
    for word, column in (("before", 0), ("after", 1)):
        known = [pair[column] for pair in pairs if pair[column] is not None]
        if known:
            parts.append(f"{sum(abs(m) <= 2.0 for m in known if m is not None)} of {len(known)} within 2 σ or their bounds {word}")
    return ", ".join(parts) or "nothing measured to compare with"


def missed(value: RestValue, simulated: float | None) -> float | None:
    """(measured - simulated)/σ; inside an interval 0, outside it in what counts as σ there; None where that is not known."""
    if simulated is None or not np.isfinite(simulated):
        return None
    if value.value is not None and value.sigma and np.isfinite(value.value):
        return (value.value - simulated) / value.sigma
    if value.low is not None and value.high is not None and (edge := value.edge or 0.25 * (value.high - value.low)) > 0.0:
        return (max(value.low - simulated, 0.0) - max(simulated - value.high, 0.0)) / edge
    return None


def _rest_panel(axes: Axes, kind: str, unit: str, group: list[RestValue]) -> None:
    label, scale = shown_unit(unit)
    plain(axes, [shortened(v.name, 28) for v in group])
    axes.set_xlabel(f"{shortened(kind)}, {spelt(label)}".removesuffix(", "), fontsize=9, color=INK)
    for row, value in enumerate(group):
        if value.low is not None and value.high is not None:
            axes.plot([scale * value.low, scale * value.high], [row, row], color=INK, linewidth=5.0, alpha=0.28, solid_capstyle="butt")
        if value.value is not None:
            axes.errorbar(
                scale * value.value, row, xerr=scale * (value.sigma or 0.0), fmt="o", color=INK, markersize=4, elinewidth=1.2, zorder=3
            )
        _dot(axes, scale, value.before, row, FITTED, "|", FITTED)
        _dot(axes, scale, value.before_fitted, row, BEFORE, "o", "none")
        _dot(axes, scale, value.after, row, AFTER, "o", AFTER)


def _dot(axes: Axes, scale: float, value: float | None, row: int, colour: str, marker: str, face: str) -> None:
    if value is not None and np.isfinite(value):
        size = 8 if marker == "|" else 5
        axes.plot(scale * value, row, marker, color=colour, markerfacecolor=face, markersize=size, markeredgewidth=1.3, zorder=4)


def pull_picture(nuisances: Mapping[str, Mapping[str, float]], name: str = "nuisances") -> Picture | None:
    """How far the fit moved what was uncertain, in standard deviations of its prior; bands at 1, 2, 3."""
    pulls = {key: entry.get("pull") for key, entry in nuisances.items()}
    known = {key: float(pull) for key, pull in pulls.items() if pull is not None and np.isfinite(pull)}
    if not known:
        return None
    figure = sheet(0.6 + ROW * len(known))
    axes = figure.subplots()
    plain(axes, [shortened(key, 40) for key in known])
    axes.set_xlabel("pull, standard deviations of the prior", fontsize=9, color=INK)
    for band in (3.0, 2.0, 1.0):
        axes.axvspan(-band, band, color=FAINT, alpha=0.16, linewidth=0)
    axes.axvline(0.0, color=FAINT, linewidth=0.8)
    for row, (key, pull) in enumerate(known.items()):
        colour = BEFORE if abs(pull) > 3.0 else INK
        width = _relative_sigma(nuisances[key])
        shown = float(np.clip(pull, -WIDEST, WIDEST))
        axes.errorbar(shown, row, xerr=width, fmt="o", color=colour, markersize=4, elinewidth=1.0)
        if shown != pull:
            axes.annotate(signed(pull), (shown, row), (0, 4), textcoords="offset points", fontsize=7, color=colour, ha="center")
    edge = max(3.4, *(min(abs(p), WIDEST) + (_relative_sigma(nuisances[key]) or 0.0) + 0.3 for key, p in known.items()))
    axes.set_xlim(-edge, edge)
    worst = max(known, key=lambda key: abs(known[key]))
    told = f"the largest is {worst} with {signed(known[worst])}"
    return Picture(
        name,
        "Uncertain values after the fit",
        figure,
        f"Uncertain values after the fit, against their priors; {told}.",
        f"Pulls of {len(known)} uncertain values; {told}.",
    )


def _relative_sigma(entry: Mapping[str, float]) -> float | None:
    """Posterior deviation in units of the prior's, if the entry tells it as prior_sigma; no bar without."""
    sigma, prior = entry.get("sigma"), entry.get("prior_sigma")
    if sigma is None or prior is None or not np.isfinite(sigma) or not prior:
        return None
    return float(sigma / prior)
