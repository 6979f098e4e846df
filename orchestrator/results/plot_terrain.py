"""The ground from above, with the ways of the pads and of the body over it."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from orchestrator.results.channels import Array, Channels
from orchestrator.results.plot_style import INK, Contacts, contact_legend, dress, leg_colours, new_figure
from orchestrator.results.schema import ResultsTable
from orchestrator.terrain.ground import Ground

PAD = 0.47  # m: the lunar module's
ROOM = 1.5  # m around what moved
LEVELS = 14


def terrain(title: str, channels: Channels, table: ResultsTable, contacts: Contacts, ground: Ground) -> Figure | None:
    """Heights, craters, boulders; pads at first (dotted) and at last, the ways of their centres and the body's. None: nothing recorded."""
    ways = {leg: way for leg, names in table.legs.items() if (way := _way(channels, f"{names.leg}.pad")) is not None}
    if not ways:
        return None
    figure = new_figure(f"{title}: ground", 8.0, 7.0)
    axes = figure.subplots()
    colours = leg_colours(list(contacts))
    body = _way(channels, f"{table.body}.body")
    places = np.concatenate([*ways.values(), *([] if body is None else [body])])
    low, high = places.min(axis=0) - ROOM, places.max(axis=0) + ROOM
    middle, half = 0.5 * (low + high), 0.5 * float((high - low).max())
    _heights(figure, axes, ground, middle, half)
    for leg, way in ways.items():
        axes.add_patch(Circle(way[-1], PAD, facecolor=colours[leg], edgecolor="none", alpha=0.45))
        axes.add_patch(Circle(way[-1], PAD, facecolor="none", edgecolor=colours[leg], linewidth=1.6))
        axes.add_patch(Circle(way[0], PAD, facecolor="none", edgecolor=colours[leg], linewidth=1.0, linestyle=":"))
        axes.plot(way[:, 0], way[:, 1], color=INK, linewidth=1.0)
        axes.plot(way[-1, 0], way[-1, 1], ".", color=INK, markersize=5)
    if body is not None:
        axes.plot(body[:, 0], body[:, 1], color=INK, linewidth=1.2, linestyle="--")
        axes.plot(body[-1, 0], body[-1, 1], "+", color=INK, markersize=12, markeredgewidth=1.8)
        axes.annotate("body", body[-1], xytext=(8, -10), textcoords="offset points", fontsize=8, color=INK)
    _shapes(axes, ground)
    axes.set_xlim(middle[0] - half, middle[0] + half)
    axes.set_ylim(middle[1] - half, middle[1] + half)
    axes.set_aspect("equal")
    dress(axes, "Z, m", "Y, m")
    axes.grid(False)
    contact_legend(figure, contacts, colours, solid=True)
    return figure


def _way(channels: Channels, port: str) -> Array | None:
    """Y and Z over the run."""
    y, z = channels.series(f"{port}.position[2]"), channels.series(f"{port}.position[3]")
    return None if y is None or z is None else np.column_stack((y, z))


def _heights(figure: Figure, axes: Axes, ground: Ground, middle: Array, half: float) -> None:
    """Shades and contours of the map around the landing, cm over the plane of the ground."""
    if not ground.heights.size:
        return
    shown = (np.abs(ground.y - middle[0]) < 1.02 * half) & (np.abs(ground.z - middle[1]) < 1.02 * half)
    heights = 100.0 * np.where(shown, ground.heights, np.nan)
    shades = axes.contourf(ground.y, ground.z, heights, levels=LEVELS, cmap="Greys_r", alpha=0.75)
    axes.contour(ground.y, ground.z, heights, levels=shades.levels, colors=INK, linewidths=0.3, alpha=0.6)
    bar = figure.colorbar(shades, ax=axes, shrink=0.8)
    bar.set_label("height of the map over the plane, cm", fontsize=9, color=INK)
    bar.ax.tick_params(labelsize=8, colors=INK)


def _shapes(axes: Axes, ground: Ground) -> None:
    """Crests of craters, outlines of boulders."""
    for y, z, diameter, depth, _ in ground.craters:
        axes.add_patch(Circle((y, z), 0.5 * diameter, facecolor="none", edgecolor=INK, linewidth=1.4))
        axes.annotate(f"crater, {100.0 * depth:.0f} cm deep", (y, z), ha="center", va="center", fontsize=8, color=INK)
    for y, z, radius, height in ground.boulders:
        foot = (max(radius**2 - (radius - height) ** 2, 0.0)) ** 0.5 if height < radius else radius
        axes.add_patch(Circle((y, z), foot, facecolor="#8B7355", edgecolor=INK, linewidth=1.0))
        label = f"boulder, {100.0 * height:.0f} cm high"
        axes.annotate(label, (y, z + foot), xytext=(0, 4), textcoords="offset points", ha="center", fontsize=8, color=INK)


