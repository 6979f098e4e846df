"""Which effects look alike, and how clearly each would show."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.patches import Rectangle

from orchestrator.diagnosis.report.distinction import ENOUGH, Distinction
from orchestrator.diagnosis.report.picture import AFTER, BEFORE, Picture, plain, sheet, shortened
from orchestrator.results.plot_style import FAINT, INK

LETTERS = 0.62  # |cos| from which the number is written into its cell
CROWDED = 26  # effects: more leave no room for numbers


def likeness_picture(table: Distinction, name: str = "likeness") -> Picture | None:
    """|cos| of the signatures as a map, clustered, with λ of each effect beside it."""
    if not table.effects:
        return None
    order = table.order()
    matrix = table.likeness()[np.ix_(order, order)]
    names = [table.effects[i].name for i in order]
    n = len(names)
    figure = sheet(1.5 + 5.1 * max(n, 6) / max(n, 22))
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=[3.6, 1.0])
    size = 8 if n <= CROWDED else 6.5
    _map(left, matrix, names, size)
    _boxes(left, table, names)
    _bars(right, [table.effects[i].lambda_ for i in order])
    alike = [f"{table.title(names[i])} and {table.title(names[j])} {matrix[i, j]:.2f}" for i, j in _closest(matrix)]
    caption = (
        "Left: likeness of what two effects leave in these data once everything uncertain has been refitted, |cos|; 1: the same trace."
    )
    caption += " Outlined: effects that cannot be told apart."
    caption += " Right: λ, the energy of an effect's trace at one prior sigma; from the line on it shows."
    return Picture(
        name, "Which effects look alike", figure, caption, f"Map of likeness of {n} effects. Closest: {'; '.join(alike) or 'none'}."
    )


def _closest(matrix: np.ndarray) -> list[tuple[int, int]]:
    above = [(i, j) for i in range(len(matrix)) for j in range(i + 1, len(matrix))]
    return sorted(above, key=lambda pair: -matrix[pair])[:5]


def _map(axes: Axes, matrix: np.ndarray, names: list[str], size: float) -> None:
    """One hue by opacity: it reads the same on a light and on a dark page."""
    n = len(names)
    image = np.empty((n, n, 4))
    image[..., :3] = to_rgb(AFTER)
    image[..., 3] = matrix**1.5
    axes.imshow(image, interpolation="nearest", aspect="auto")
    axes.set_xticks(range(n), labels=[shortened(name, 22) for name in names], rotation=90, fontsize=size, color=INK)
    plain(axes, [shortened(name, 24) for name in names])
    axes.tick_params(labelsize=size, length=0, labelbottom=False, labeltop=True, bottom=False)
    axes.grid(False)
    axes.set_ylim(n - 0.5, -0.5)
    axes.spines["bottom"].set_visible(False)
    if n <= CROWDED:
        for i, j in zip(*np.nonzero(matrix >= LETTERS), strict=True):
            if i != j:
                axes.text(j, i, f"{min(matrix[i, j], 0.99):.2f}"[1:], fontsize=6.5, color=INK, ha="center", va="center")


def _boxes(axes: Axes, table: Distinction, names: list[str]) -> None:
    """Groups that stand together are framed; others, torn apart by the clustering, cell by cell."""
    for group in table.groups:
        places = sorted(names.index(name) for name in group if name in names)
        if len(places) > 1 and places[-1] - places[0] == len(places) - 1:
            axes.add_patch(
                Rectangle((places[0] - 0.5, places[0] - 0.5), len(places), len(places), fill=False, edgecolor=BEFORE, linewidth=1.6)
            )
        else:
            for i in places:
                for j in places:
                    if i != j:
                        axes.add_patch(Rectangle((i - 0.5, j - 0.5), 1, 1, fill=False, edgecolor=BEFORE, linewidth=1.0))


def _bars(axes: Axes, energies: list[float]) -> None:
    shown = [max(e, 0.1) if np.isfinite(e) else 0.1 for e in energies]
    colours = [AFTER if e >= ENOUGH else FAINT for e in shown]
    axes.barh(range(len(shown)), shown, left=0.1, height=0.62, color=colours, linewidth=0)
    axes.set_xscale("log")
    axes.set_xlim(0.1, 3.0 * max([*shown, 4.0 * ENOUGH]))
    axes.axvline(ENOUGH, color=INK, linewidth=0.9, linestyle=(0.0, (4.0, 3.0)))
    axes.tick_params(axis="y", length=0, labelleft=False)
    axes.tick_params(axis="x", labelsize=8, colors=INK, length=3)
    axes.minorticks_off()
    axes.set_xlabel("λ", fontsize=9, color=INK)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.spines["bottom"].set_color(FAINT)
