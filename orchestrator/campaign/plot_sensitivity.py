"""Sobol indices as bars with their bands, an output a panel."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from orchestrator.campaign.sensitivity import LEVEL, Indices
from orchestrator.results.plot_style import INK, dress, new_figure

FIRST, TOTAL = "#0072B2", "#E69F00"
BAR = 0.38


def draw(title: str, found: Sequence[Indices]) -> Figure:
    """Inputs in the order of the first output's totals, the same in all panels."""
    order = found[0].ranked
    columns = min(3, len(found))
    rows = -(-len(found) // columns)
    figure = new_figure(title, 1.5 + 3.6 * columns, 1.2 + rows * (0.8 + 0.3 * len(order)))
    for place, indices in enumerate(found):
        axes = figure.add_subplot(rows, columns, place + 1)
        heights = [len(order) - 1 - i for i in range(len(order))]
        for shift, colour, label, values, bands in (
            (BAR / 2, TOTAL, "total", indices.total, indices.total_band),
            (-BAR / 2, FIRST, "first order", indices.first, indices.first_band),
        ):
            axes.barh(
                [height + shift for height in heights],
                [values[i] for i in order],
                height=BAR,
                xerr=[bands[i] for i in order],
                color=colour,
                label=label,
                error_kw={"elinewidth": 0.9, "ecolor": INK, "capsize": 2},
            )
        dress(axes, "", "share of the variance")
        axes.set_yticks(heights, [indices.inputs[i].replace("_", " ") for i in order])
        axes.set_title(_named(indices), fontsize=9, color=INK, loc="left")
        axes.axvline(0.0, color=INK, linewidth=0.7)
        axes.set_xlim(left=min(-0.05, axes.get_xlim()[0]))
    figure.axes[0].legend(fontsize=8, frameon=False, loc="lower right", title=f"± {LEVEL:.0%}", title_fontsize=8)
    return figure


def _named(indices: Indices) -> str:
    return f"{indices.output.removeprefix('failure.')}\n{indices.mean:.4g} ± {indices.deviation:.2g}, {indices.samples} base samples"
