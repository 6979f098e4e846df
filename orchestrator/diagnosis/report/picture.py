"""A figure of the report, twice: a PNG beside it, and an SVG inside it whose colours follow the page (light, dark, print)."""

from __future__ import annotations

import re
from dataclasses import dataclass
from html import escape
from io import StringIO
from pathlib import Path

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from orchestrator.results.plot_style import DOTS_PER_INCH, FAINT, INK

BEFORE, FITTED, AFTER, GRID = "#D55E00", "#E69F00", "#0072B2", "#E6E6E6"
"""Okabe and Ito, as everywhere: without the effect, prior means alone, with the effect."""
VARIABLES = {
    INK: "ink",
    FAINT: "faint",
    GRID: "grid",
    BEFORE: "before",
    FITTED: "fitted",
    AFTER: "after",
    "#009E73": "leg2",
    "#CC79A7": "leg4",
}
WIDTH = 7.2
"""Inches of every figure of the page, so that letters have one size throughout."""
_HEAD = re.compile(r"^.*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"\s*<metadata>.*?</metadata>", re.DOTALL)
_OPENING = re.compile(r'<svg[^>]*?viewBox="([^"]*)"[^>]*>')
_NAMED = re.compile(r' id="(?:figure|axes|patch|line2d|text|xtick|ytick|matplotlib|legend|[A-Za-z]+Collection|image)[\w.]*"')
_FONT = re.compile(r"(font(?:-family)?: [^;\"]*?)'DejaVu Sans'[^;\"]*")


@dataclass
class Picture:
    """A figure with its file's stem and its words."""

    name: str
    title: str
    """Over the PNG; in the page a heading stands there."""
    figure: Figure
    caption: str
    alt: str
    """What somebody learns who cannot see it."""

    def save(self, folder: Path) -> Path:
        """NAME.png, on white, with its title."""
        path = folder / f"{self.name}.png"
        title = self.figure.suptitle(shortened(self.title, 80), fontsize=12, fontweight="bold", color=INK, x=0.01, ha="left")
        self.figure.savefig(path, dpi=DOTS_PER_INCH)
        title.set_visible(False)
        title.set_in_layout(False)
        return path

    @property
    def svg(self) -> str:
        """An <svg> element for HTML: no fixed size, no address of anything, letters as letters, colours as variables."""
        buffer = StringIO()
        with rc_context({"svg.fonttype": "none", "svg.hashsalt": self.name}):
            self.figure.savefig(buffer, format="svg", transparent=True)
        text = _METADATA.sub("", _HEAD.sub("", buffer.getvalue(), count=1))
        label = escape(self.alt, quote=True)
        text = _OPENING.sub(lambda m: f'<svg viewBox="{m[1]}" role="img" aria-label="{label}">', text, count=1)
        text = _FONT.sub(r"\1inherit", _NAMED.sub("", text)).replace("xlink:href", "href")
        for colour, variable in VARIABLES.items():
            text = re.sub(colour, f"var(--{variable})", text, flags=re.IGNORECASE)
        return text


def sheet(height: float) -> Figure:
    """An empty figure of the page's width; height in inches. Its title stands in the page."""
    figure = Figure(figsize=(WIDTH, height), facecolor="white")
    figure.set_layout_engine("constrained")
    return figure


def plain(axes: Axes, labels: list[str]) -> None:
    """Rows with names at the left, the first at the top, faint lines along them."""
    axes.set_yticks(range(len(labels)), labels=labels, fontsize=8, color=INK)
    axes.set_ylim(len(labels) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0)
    axes.tick_params(axis="x", labelsize=8, colors=INK, length=3)
    axes.grid(True, axis="y", color=GRID, linewidth=0.7)
    axes.set_axisbelow(True)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    axes.spines["bottom"].set_color(FAINT)


def shortened(text: str, most: int = 34) -> str:
    """At most so many letters; dollar signs as they stand."""
    kept = text if len(text) <= most else text[: most - 1].rstrip() + "…"
    return kept.replace("$", r"\$")
