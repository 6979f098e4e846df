"""The run in pictures: where the energy went, which intervals were taken, and the numbers a scenario asks for."""

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter

from orchestrator.results.channels import Array, Channels
from orchestrator.results.energy import EnergyAccount
from orchestrator.results.plot_style import INK, Contacts, contact_legend, dress, leg_colours, mark_contacts, new_figure, widen
from orchestrator.results.schema import ResultsTable

TIME = "time, s"
ROUND_MS = [step * 10.0**decade for decade in range(-6, 5) for step in (1.0, 2.0, 5.0)]


def energy(title: str, times: Array, account: EnergyAccount, contacts: Contacts) -> Figure:
    """The ledger over time, kJ, stacked to what there was; below it the residual, J."""
    figure = new_figure(f"{title}: energy ledger", 9.5, 6.5)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    curves = [
        (account.mechanical, "#0072B2", "kinetic and potential, above the end state"),
        (account.absorbed, "#E69F00", "taken up by the soil"),
        (account.dissipated, "#D55E00", "dissipated in the units"),
        (account.supplied, "#56B4E9", "supplied by engine and effects"),
    ]
    for values, colour, label in curves:
        upper.plot(times, values * 1e-3, color=colour, linewidth=1.4, label=label)
    dress(upper, "energy, kJ")
    upper.legend(fontsize=8, frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.0)
    lower.plot(times, account.residual, color=INK, linewidth=1.2)
    lower.axhline(0.0, color=INK, linewidth=0.6, alpha=0.4)
    widen(lower, 1.0)
    dress(lower, "unexplained, J", TIME)
    colours = leg_colours(list(contacts))
    for axes in (upper, lower):
        mark_contacts(axes, contacts, colours)
    contact_legend(figure, contacts, colours, solid=False)
    return figure


def intervals(title: str, ends: Array, sizes: Array, accepted: Array, contacts: Contacts) -> Figure:
    """Interval size in ms against the time of its end in s; refused intervals as crosses."""
    figure = new_figure(f"{title}: intervals of the master", 9.5, 4.0)
    axes = figure.subplots()
    taken = accepted.astype(bool)
    axes.plot(ends[taken], sizes[taken] * 1e3, ".", color="#0072B2", markersize=2.5, label=f"{taken.sum()} taken")
    if not taken.all():
        label = f"{(~taken).sum()} refused, repeated shorter"
        axes.plot(ends[~taken], sizes[~taken] * 1e3, "x", color="#D55E00", markersize=3.5, markeredgewidth=0.8, label=label)
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(FixedLocator(ROUND_MS))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    least, greatest = 0.99e3 * sizes.min(), 1.01e3 * sizes.max()
    below, above = (ms for ms in ROUND_MS if ms < least), (ms for ms in ROUND_MS if ms > greatest)
    axes.set_ylim(max(below, default=least), min(above, default=greatest))
    dress(axes, "interval, ms", TIME)
    colours = leg_colours(list(contacts))
    mark_contacts(axes, contacts, colours)
    axes.legend(fontsize=8, frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.0, markerscale=2.0)
    contact_legend(figure, contacts, colours, solid=False)
    return figure


def reported(title: str, channels: Channels, table: ResultsTable) -> Figure | None:
    """The columns named in `[results.report]` over time, the expected value dashed; None where there is nothing to draw."""
    curves = [(name, entry, column) for name, entry in table.report.items() if (column := channels.series(entry.variable)) is not None]
    if not curves:
        return None
    rows, width = -(-len(curves) // 2), min(2, len(curves))
    figure = new_figure(title, 9.5, 1.0 + 2.4 * rows)
    panels = list(figure.subplots(rows, width, sharex=True, squeeze=False).flat)
    for spare in panels[len(curves) :]:
        spare.set_visible(False)
    for axes, (name, entry, column) in zip(panels, curves, strict=False):
        axes.plot(channels.times, column, color="#0072B2", linewidth=1.4, label=entry.variable)
        if entry.expected is not None:
            label = f"expected {entry.expected:g}" + (f" ({entry.source})" if entry.source else "")
            axes.axhline(entry.expected, color="#D55E00", linewidth=1.0, linestyle="--", label=label)
        dress(axes, f"{name}, {entry.unit}" if entry.unit else name, TIME)
        axes.legend(fontsize=8, frameon=False)
    return figure
