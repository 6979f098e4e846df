"""The units' icons, drawn as SVG and PNG: `python build_fmus.py --icons`. What is drawn is kept beside this file and packed from there.

A drawing is made on a square of 100 by 100, +y up, in three colours, without words, so that it still reads at 32 pixels.
"""

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle, FancyBboxPatch, Polygon

FOLDER = Path(__file__).parent
INK, FILL, MARK = "#1f3a5f", "#cfdbe8", "#d9772b"
Point = tuple[float, float]


def line(axes: Axes, *points: Point, width: float = 2.5, colour: str = INK) -> None:
    axes.plot(*zip(*points, strict=True), color=colour, linewidth=width, solid_capstyle="round", solid_joinstyle="round")


def shape(axes: Axes, *points: Point, fill: str = FILL, width: float = 2.0) -> None:
    axes.add_patch(Polygon(points, closed=True, facecolor=fill, edgecolor=INK, linewidth=width, joinstyle="round"))


def arrow(axes: Axes, start: Point, end: Point, colour: str = MARK) -> None:
    axes.annotate("", xy=end, xytext=start, arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2.5, "mutation_scale": 13})


def footpad(axes: Axes, x: float, y: float, scale: float = 1.0) -> None:
    """A dish, its ball joint at (x, y)."""
    s = scale
    shape(axes, (x - 17 * s, y - 2 * s), (x + 17 * s, y - 2 * s), (x + 10 * s, y - 11 * s), (x - 10 * s, y - 11 * s))
    axes.add_patch(Circle((x, y), 3 * s, color=INK))


def ground(axes: Axes, y: float) -> None:
    """Soil below a line, with grains."""
    shape(axes, (4, y), (96, y), (96, 6), (4, 6), fill="#e4ddd2")
    for x, depth in ((14, 8), (28, 18), (40, 10), (55, 19), (68, 9), (82, 17), (90, 7), (47, 27), (20, 28), (76, 27)):
        if y - depth > 9:
            axes.add_patch(Circle((x, y - depth), 1.5, color="#9a8c78"))


def bell(axes: Axes, x: float, y: float, size: float = 1.0) -> None:
    """An engine's nozzle, its throat at (x, y)."""
    s = size
    shape(axes, (x - 5 * s, y), (x + 5 * s, y), (x + 15 * s, y - 24 * s), (x - 15 * s, y - 24 * s))


def body(axes: Axes, y: float, scale: float = 1.0) -> None:
    """Ascent stage on descent stage, the lower edge at y."""
    s = scale
    shape(axes, *((50 + s * dx, y + s * dy) for dx, dy in ((-26, 0), (26, 0), (30, 8), (26, 18), (-26, 18), (-30, 8))))
    shape(axes, *((50 + s * dx, y + s * dy) for dx, dy in ((-15, 18), (15, 18), (19, 28), (12, 40), (-12, 40), (-19, 28))), fill="white")


def gear_leg(axes: Axes) -> None:
    line(axes, (22, 88), (70, 22), width=6)
    line(axes, (22, 46), (52, 47), width=3.5)
    line(axes, (22, 62), (52, 47), width=3.5)
    line(axes, (20, 94), (20, 40), width=4)
    line(axes, (33, 73), (44, 58), width=10, colour=FILL)
    for k in range(4):      # honeycomb
        x = 34.0 + 3.2 * k
        line(axes, (x - 2, 70 - 4.4 * k), (x + 3, 73 - 4.4 * k), width=1.5)
    footpad(axes, 70, 22)


def regolith_contact(axes: Axes) -> None:
    ground(axes, 44)
    footpad(axes, 50, 48, 1.5)
    arrow(axes, (50, 92), (50, 56))
    arrow(axes, (22, 20), (22, 58))
    arrow(axes, (78, 20), (78, 58))


def vehicle_body(axes: Axes) -> None:
    body(axes, 30, 1.15)
    axes.add_patch(Circle((50, 48), 5, facecolor="white", edgecolor=INK, linewidth=2))
    line(axes, (50, 43), (50, 53), width=1.5)
    line(axes, (45, 48), (55, 48), width=1.5)
    arrow(axes, (50, 24), (50, 5))


def guidance_control(axes: Axes) -> None:
    bell(axes, 34, 60, 1.1)
    shape(axes, (25, 30), (43, 30), (34, 6), fill=MARK, width=0.0)
    axes.add_patch(FancyBboxPatch((20, 64), 28, 24, boxstyle="round,pad=3", facecolor="white", edgecolor=INK, linewidth=2.5))
    line(axes, (24, 82), (31, 82), (44, 69), colour=MARK, width=3)
    line(axes, (52, 76), (82, 76), (82, 44))
    arrow(axes, (82, 46), (54, 46), colour=INK)


def rate_sensor(axes: Axes) -> None:
    axes.add_patch(Circle((50, 50), 38, facecolor=FILL, edgecolor=INK, linewidth=2.5))
    t = np.linspace(0.0, 2 * np.pi, 60)
    axes.plot(20 + 60 * t / (2 * np.pi), 50 + 17 * np.sin(t), color=INK, linewidth=1.5, linestyle=(0, (2, 1.5)))
    steps = np.linspace(0.0, 2 * np.pi, 11)
    axes.step(20 + 60 * steps / (2 * np.pi), 50 + 17 * np.sin(steps - 0.5), where="post", color=MARK, linewidth=2.5)


def lunar_lander(axes: Axes) -> None:
    for sign in (-1, 1):
        line(axes, (50 + sign * 26, 56), (50 + sign * 38, 18), width=3.5)
        line(axes, (50 + sign * 22, 42), (50 + sign * 34, 31), width=2)
        footpad(axes, 50 + sign * 38, 18, 0.55)
    body(axes, 42, 1.0)
    bell(axes, 50, 42, 0.6)
    line(axes, (6, 11), (94, 11), width=2, colour="#9a8c78")


def thrust_ground_effect(axes: Axes) -> None:
    bell(axes, 50, 84, 1.15)
    ground(axes, 24)
    for sign in (-1, 1):
        arrow(axes, (50 + sign * 7, 54), (50 + sign * 11, 27))
        arrow(axes, (50 + sign * 14, 30), (50 + sign * 40, 30))
    arrow(axes, (86, 54), (86, 90), colour=INK)


def propellant_slosh(axes: Axes) -> None:
    t = np.linspace(np.pi + 0.35, 2 * np.pi + 0.75, 50)
    shape(axes, *zip((50 + 36 * np.cos(t)).tolist(), (50 + 36 * np.sin(t)).tolist(), strict=True), fill=MARK, width=0.0)
    axes.add_patch(Circle((50, 50), 38, facecolor="none", edgecolor=INK, linewidth=3))
    line(axes, (50, 50), (64, 26), width=2)
    axes.add_patch(Circle((64, 26), 5, color=INK))
    axes.add_patch(Circle((50, 50), 2.5, color=INK))


def reaction_control(axes: Axes) -> None:
    shape(axes, (40, 40), (60, 40), (60, 60), (40, 60))
    for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        shape(axes, *((50 + d * x + w * y, 50 + d * y + w * x) for d, w in ((10, -4), (10, 4), (26, 9), (26, -9))), fill="white")
    for x, y in ((1, 0), (-1, 0)):
        shape(axes, *((50 + d * x + w * y, 50 + d * y + w * x) for d, w in ((28, -7), (28, 7), (45, 0))), fill=MARK, width=0.0)
    axes.add_patch(Arc((50, 50), 72, 72, theta1=30, theta2=62, edgecolor=INK, linewidth=2.5))


def body_term(axes: Axes) -> None:
    body(axes, 22, 1.0)
    arrow(axes, (8, 74), (30, 50))
    line(axes, (66, 82), (86, 82), colour=MARK, width=5)
    line(axes, (76, 72), (76, 92), colour=MARK, width=5)


def port(axes: Axes) -> None:
    """A terminal: where a connection ends."""
    shape(axes, (20, 20), (80, 20), (80, 80), (20, 80))
    axes.add_patch(Circle((50, 50), 14, color=MARK))


DRAWINGS: dict[str, Callable[[Axes], None]] = {
    "GearLeg": gear_leg, "RegolithContact": regolith_contact, "VehicleBody": vehicle_body, "GuidanceControl": guidance_control,
    "RateSensor": rate_sensor, "LunarLander": lunar_lander, "ThrustGroundEffect": thrust_ground_effect,
    "PropellantSlosh": propellant_slosh, "ReactionControl": reaction_control, "BodyTerm": body_term, "port": port,
}


def draw(name: str, size: float) -> None:
    """NAME.svg and NAME.png; `size` in pixels."""
    mpl.rcParams["svg.hashsalt"] = name      # the same drawing gives the same bytes
    figure = plt.figure(figsize=(size / 100, size / 100), dpi=100)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0, 100), ylim=(0, 100))
    axes.axis("off")
    axes.set_autoscale_on(False)
    DRAWINGS[name](axes)
    figure.savefig(FOLDER / f"{name}.svg", transparent=True, metadata={"Date": None})
    figure.savefig(FOLDER / f"{name}.png", transparent=True, metadata={"Software": None})
    plt.close(figure)


def draw_all() -> None:
    """Every icon, anew."""
    mpl.use("Agg")
    for name in DRAWINGS:
        draw(name, 24.0 if name == "port" else 128.0)
