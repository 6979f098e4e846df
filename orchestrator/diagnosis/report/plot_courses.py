"""Before and after: each channel of a series with its data, the residual in standard deviations beneath."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from orchestrator.diagnosis.report.courses import Array, ChannelCourse, LandingCourses, rms
from orchestrator.diagnosis.report.numbers import number, shown_unit, spelt
from orchestrator.diagnosis.report.picture import AFTER, BEFORE, FITTED, Picture, sheet, shortened
from orchestrator.results.plot_style import DASHES, FAINT, INK, dress, leg_colours, widen

TIME = "time, s"
SPREAD = 3.0  # σ: inside it a residual is nothing to look at


def course_picture(name: str, landing: LandingCourses, series: str) -> Picture:
    """All channels of one series of one landing, one under the other."""
    channels = landing.series[series]
    figure = sheet(0.55 + 2.25 * len(channels))
    grid = figure.subplots(2 * len(channels), 1, sharex=True, squeeze=False, height_ratios=[1.9, 1.1] * len(channels))[:, 0]
    for place, channel in enumerate(channels):
        above, below = grid[2 * place], grid[2 * place + 1]
        last = place == len(channels) - 1
        _draw(above, channel)
        _residuals(below, channel, TIME if last else "")
        for axes in (above, below):
            _mark(axes, landing, named=axes is grid[0])
    _legend(figure, channels)
    figure.align_ylabels()
    words = [f"{c.channel}: {_distance(c)}" for c in channels]
    caption = f"{series}. Distance from the data, RMS of the white residual: {'; '.join(words)}."
    caption += " Beneath, residuals in σ: linear in the grey band of ±3, logarithmic outside."
    return Picture(
        name,
        f"{landing.heading}: {series}",
        figure,
        caption,
        f"Measured and simulated {series} against time, residuals beneath. {'; '.join(words)}.",
    )


def _distance(channel: ChannelCourse) -> str:
    before, after = number(rms(channel.residual_before), 3), number(rms(channel.residual_after), 3)
    return f"{before} σ" if channel.residual_after is None else f"{before} σ before, {after} σ after"


def _draw(axes: Axes, channel: ChannelCourse) -> None:
    unit, scale = shown_unit(channel.unit)
    dress(axes, f"{shortened(channel.channel, 22)}\n{spelt(unit)}".rstrip())
    axes.tick_params(axis="x", length=0)
    if channel.after is not None and channel.band is not None:
        low, high = (scale * (channel.after + side * channel.band) for side in (-1.0, 1.0))
        axes.fill_between(channel.times, low, high, color=AFTER, alpha=0.22, linewidth=0, zorder=2)
    _line(axes, channel.times, channel.before, scale, FITTED, 1.0, (0.0, (2.0, 1.5)))
    _line(axes, channel.times, channel.before_fitted, scale, BEFORE, 1.3, "-")
    _line(axes, channel.times, channel.after, scale, AFTER, 1.5, "-")
    size = 2.6 if len(channel.data_times) < 150 else 1.7
    axes.errorbar(
        channel.data_times, scale * channel.data, scale * channel.sigma, fmt="o", color=INK, markersize=size, elinewidth=0.5, zorder=4
    )
    widen(axes, 6.0 * scale * channel.sigma if np.isfinite(channel.sigma) else 0.0)


def _line(axes: Axes, times: Array, column: Array | None, scale: float, colour: str, width: float, style: object) -> None:
    if column is not None:
        axes.plot(times, scale * column, color=colour, linewidth=width, linestyle=style, zorder=3)


def _residuals(axes: Axes, channel: ChannelCourse, xlabel: str) -> None:
    """Linear to ±3 σ, logarithmic beyond, so that a large gap and a small rest are both seen."""
    dress(axes, "σ", xlabel)
    axes.tick_params(axis="x", length=3 if xlabel else 0)
    axes.set_yscale("symlog", linthresh=SPREAD, linscale=0.8)
    axes.axhspan(-SPREAD, SPREAD, color=FAINT, alpha=0.22, linewidth=0)
    axes.axhline(0.0, color=FAINT, linewidth=0.8)
    for residual, colour, size in ((channel.residual_before, BEFORE, 2.8), (channel.residual_after, AFTER, 2.4)):
        if residual is not None:
            axes.plot(channel.data_times, residual, "o", color=colour, markersize=size, markeredgewidth=0)
    largest = max(_largest(channel.residual_before), _largest(channel.residual_after))
    limit = max(1.6 * largest, 1.6 * SPREAD)
    axes.set_ylim(-limit, limit)
    beyond = 10.0 ** np.floor(np.log10(limit)) if limit >= 10.0 else None
    ticks = [-beyond, -SPREAD, SPREAD, beyond] if beyond else [-SPREAD, SPREAD]
    axes.set_yticks(ticks, labels=[f"{t:+.0f}".replace("-", "−") for t in ticks], fontsize=7)
    axes.minorticks_off()


def _largest(residual: Array | None) -> float:
    kept = np.zeros(0) if residual is None else residual[np.isfinite(residual)]
    return float(np.abs(kept).max()) if len(kept) else 0.0


def _mark(axes: Axes, landing: LandingCourses, named: bool) -> None:
    """First contacts, named over the topmost panel."""
    contacts = sorted((c for c in landing.contacts if np.isfinite(c.time)), key=lambda c: c.time)
    colours = leg_colours([c.pad for c in contacts])
    for contact in contacts:
        axes.axvline(contact.time, color=colours[contact.pad], linewidth=0.9, linestyle=DASHES, alpha=0.8, zorder=1)
    if named:
        name_contacts(axes, [(c.pad, c.time) for c in contacts], colours)


def name_contacts(axes: Axes, contacts: list[tuple[str, float]], colours: dict[str, str]) -> None:
    """Names over the panel at their instants, moved aside where they would overlap."""
    low, high = axes.get_xlim()
    apart, last = 0.055 * (high - low), -np.inf
    for pad, time in contacts:
        last = max(time, last + apart)
        label = shortened(pad.replace("-", "−"), 8)
        axes.annotate(
            label, (time, 1.0), (last, 1.06), xycoords=("data", "axes fraction"), textcoords=("data", "axes fraction"),
            fontsize=8, color=colours[pad], ha="center", va="bottom", annotation_clip=False,
        )  # fmt: skip


def _legend(figure: Figure, channels: list[ChannelCourse]) -> None:
    handles: list[Artist] = [Line2D([], [], color=INK, marker="o", linestyle="", markersize=3)]
    handles.append(Line2D([], [], color=FITTED, linestyle=(0.0, (2.0, 1.5))))
    labels = ["measured ± σ", "scenario as it stands"]
    if any(c.before_fitted is not None for c in channels):
        handles.append(Line2D([], [], color=BEFORE, linewidth=1.4))
        labels.append("before: uncertain values fitted")
    if any(c.after is not None for c in channels):
        handles.append(Line2D([], [], color=AFTER, linewidth=1.6))
        labels.append("after: with the effect")
    if any(c.band is not None for c in channels):
        handles.append(Patch(color=AFTER, alpha=0.22, linewidth=0))
        labels.append("± σ")
    look = {"fontsize": 8, "frameon": False, "labelcolor": INK, "handlelength": 1.6, "columnspacing": 1.2}
    figure.legend(handles, labels, loc="outside lower center", ncols=len(handles), **look)
