"""The landing in pictures: rates and attitude as in the paper's Figures 13 and 14, pads, struts."""

import math

from matplotlib.figure import Figure

from orchestrator.results.channels import Channels
from orchestrator.results.plot_style import INK, Contacts, contact_legend, dress, leg_colours, mark_contacts, new_figure, widen
from orchestrator.results.schema import ResultsTable

DEGREES = math.degrees(1.0)
TIME = "time, s"


def motion(title: str, channels: Channels, table: ResultsTable, contacts: Contacts) -> Figure:
    """Yaw, pitch and roll: rates on the left, angles on the right, in deg/s and deg."""
    figure = new_figure(f"{title}: rates and attitude", 9.5, 7.0)
    grid = figure.subplots(3, 2, sharex=True)
    colours = leg_colours(list(contacts))
    for row, axis in zip(grid, ("yaw", "pitch", "roll"), strict=True):
        for axes, quantity, unit in zip(row, ("rates", "attitude"), ("deg/s", "deg"), strict=True):
            label = f"{axis} rate, {unit}" if quantity == "rates" else f"{axis}, {unit}"
            dress(axes, label, TIME if axis == "roll" else "")
            if quantity == "rates":
                axes.axhline(0.0, color=INK, linewidth=0.6, alpha=0.4)
            mark_contacts(axes, contacts, colours)
            column = channels.series(f"{table.body}.{quantity}.{axis}")
            if column is not None:
                axes.plot(channels.times, column * DEGREES, color=INK, linewidth=1.1)
            widen(axes, 1.0)
    contact_legend(figure, contacts, colours, solid=False)
    return figure


def pads(title: str, channels: Channels, table: ResultsTable, contacts: Contacts) -> Figure:
    """Gap of each pad's lowest point above the ground, depth of its centre, skid, normal force."""
    figure = new_figure(f"{title}: footpads", 9.5, 7.0)
    grid = figure.subplots(2, 2, sharex=True)
    colours = leg_colours(list(contacts))
    panels = [("gap", "gap to the ground, cm", 100.0), ("penetration", "depth of the pad's centre, cm", 100.0)]
    panels += [("skid", "skid, cm", 100.0), ("normal_force", "normal force, kN", 1e-3)]
    for axes, (variable, label, scale) in zip(grid.flat, panels, strict=True):
        dress(axes, label, TIME if axes in grid[1] else "")
        mark_contacts(axes, contacts, colours)
        for leg, names in table.legs.items():
            column = channels.series(f"{names.soil}.{variable}")
            if column is not None:
                axes.plot(channels.times, column * scale, color=colours[leg], linewidth=1.1)
    contact_legend(figure, contacts, colours, solid=True)
    return figure


def struts(title: str, channels: Channels, table: ResultsTable, contacts: Contacts) -> Figure:
    """Stroke and load of the three struts of each leg, cm and kN."""
    figure = new_figure(f"{title}: struts", 9.5, 7.5)
    grid = figure.subplots(3, 2, sharex=True)
    colours = leg_colours(list(contacts))
    for row, strut in zip(grid, ("primary", "right", "left"), strict=True):
        name, sense = ("primary", "compression") if strut == "primary" else (f"{strut} secondary", "extension")
        for axes, quantity, unit, scale in zip(row, ("stroke", "load"), ("cm", "kN"), (100.0, 1e-3), strict=True):
            dress(axes, f"{name} {quantity}, {unit}\n({sense} positive)", TIME if strut == "left" else "")
            mark_contacts(axes, contacts, colours)
            for leg, names in table.legs.items():
                column = channels.series(f"{names.leg}.{strut}.{quantity}")
                if column is not None:
                    axes.plot(channels.times, column * scale, color=colours[leg], linewidth=1.1)
            widen(axes, 1.0)
    contact_legend(figure, contacts, colours, solid=True)
    return figure
