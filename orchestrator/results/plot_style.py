"""How all figures look. Nothing here touches matplotlib's global state: figures are made without pyplot."""

from collections.abc import Mapping
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

Contacts = Mapping[str, float | None]  # first contact of each leg, s
INK, FAINT = "#222222", "#B8B8B8"
LEG_COLOURS = {"+Z": "#0072B2", "-Z": "#D55E00", "+Y": "#009E73", "-Y": "#CC79A7"}  # Okabe and Ito: safe for colour-blind readers
OTHER_COLOURS = ("#E69F00", "#56B4E9", "#882255", "#555555")
DOTS_PER_INCH = 140
DASHES = (0.0, (4.0, 3.0))


def leg_colours(legs: list[str]) -> dict[str, str]:
    """One colour a leg, the same in every figure and every run."""
    spare = iter(OTHER_COLOURS * (1 + len(legs) // len(OTHER_COLOURS)))
    return {leg: LEG_COLOURS.get(leg) or next(spare) for leg in legs}


def new_figure(title: str, width: float, height: float) -> Figure:
    """An empty figure with a title, size in inches."""
    figure = Figure(figsize=(width, height), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    figure.suptitle(title, fontsize=12, fontweight="bold", color=INK, x=0.01, ha="left")
    return figure


def dress(axes: Axes, ylabel: str, xlabel: str = "") -> None:
    """Labels, a faint grid, no box."""
    axes.set_ylabel(ylabel, fontsize=9, color=INK)
    if xlabel:
        axes.set_xlabel(xlabel, fontsize=9, color=INK)
    axes.grid(True, color="#E6E6E6", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8, colors=INK, length=3)
    axes.margins(x=0.01)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(FAINT)


def mark_contacts(axes: Axes, contacts: Contacts, colours: Mapping[str, str]) -> None:
    """A thin dashed line at each leg's first contact, times in s."""
    for leg, time in contacts.items():
        if time is not None:
            axes.axvline(time, color=colours[leg], linewidth=0.9, linestyle=DASHES, alpha=0.8, zorder=1)


def contact_legend(figure: Figure, contacts: Contacts, colours: Mapping[str, str], solid: bool) -> None:
    """One legend for the whole figure below the panels, in the order of contact; `solid`: the colours also stand for curves."""
    order = sorted(contacts, key=lambda leg: (contacts[leg] is None, contacts[leg]))
    handles = [Line2D([], [], color=colours[leg], linewidth=1.6 if solid else 0.9, linestyle="-" if solid else DASHES) for leg in order]
    labels = []
    for leg in order:
        time, name = contacts[leg], leg.replace("-", "−")
        labels.append(f"{name}: no contact" if time is None else f"{name} touches at {time:.3f} s")
    if handles:
        figure.legend(handles, labels, loc="outside lower center", ncols=len(handles), fontsize=8, frameon=False)


def widen(axes: Axes, span: float) -> None:
    """Let the ordinate cover at least `span`, so that a zero with rounding in it is not blown up to fill the panel."""
    low, high = axes.get_ylim()
    if high - low < span:
        middle = 0.5 * (low + high)
        axes.set_ylim(middle - 0.5 * span, middle + 0.5 * span)


def save(figure: Figure, path: Path) -> Path:
    """Write a PNG, the ordinates' labels of each column in one line."""
    figure.align_ylabels()
    figure.savefig(path, dpi=DOTS_PER_INCH)
    return path
