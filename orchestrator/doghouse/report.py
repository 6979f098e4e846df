"""The Doghouse on a terminal: the sentence first, then a row a boundary point."""

from __future__ import annotations

import math
from pathlib import Path

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from orchestrator.doghouse.landing import BOUNDARIES, UNITS
from orchestrator.doghouse.outcome import Outcome, why, words


def terminal_report(outcome: Outcome, folder: Path) -> RenderableType:
    parts: list[RenderableType] = [_sentence(outcome), *(_table(outcome, name) for name in BOUNDARIES)]
    for name, bracket in outcome.inside():
        text = f"{name.replace('_', ' ')} inside the envelope: {words(bracket.beyond)}: {why(name, bracket.beyond_margins)}"
        parts.append(Text(text, style="red"))
    parts += [Text(line, style="yellow") for line in _notes(outcome)]
    parts.append(Text(f"files: {folder / 'doghouse.png'}, {folder / 'doghouse.json'}"))
    return Group(*parts)


def _sentence(outcome: Outcome) -> Text:
    inside, failed = outcome.inside(), outcome.failed_audit()
    title = Text(outcome.doghouse.title + "  ", style="bold")
    if not inside and failed:
        return title.append(f"{len(failed)} landings inside the certified envelope fail, though no boundary was found there", style="red")
    if not inside:
        return title.append("all boundaries lie outside the certified envelope", style="green")
    names = ", ".join(dict.fromkeys(name.replace("_", " ") for name, _ in inside))
    return title.append(f"{names}: NOT outside the certified envelope", style="red")


def _table(outcome: Outcome, name: str) -> Table:
    table = Table(title=name.replace("_", " "), title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for heading in ("horizontal", "vertical", "certified", "left", "units", "first landing that fails"):
        table.add_column(heading, justify="left" if heading in ("units", "first landing that fails") else "right")
    for ray in outcome.rays:
        if name not in ray.brackets:
            continue
        bracket = ray.brackets[name]
        held = bracket.inside
        times = math.hypot(held.horizontal_m_s, held.vertical_m_s) / ray.certified
        margin = bracket.inside_margins.left[name]
        left = "–" if margin is None else f"{margin:.1f} deg" if UNITS[name] == "deg" else f"{margin * 1e3:.1f} mm"
        sides = {True: "agree", False: "differ", None: "–"}[outcome.agrees(ray, name)]
        speeds = (f"{held.horizontal_m_s:.2f}", f"{held.vertical_m_s:.2f}", f"x {times:.2f}")
        fails = f"{words(bracket.beyond)}; {bracket.beyond_margins.where.get(name, '')}"
        table.add_row(*speeds, left, sides, fails, style="" if outcome.outside(ray, name) else "red")
    return table


def _notes(outcome: Outcome) -> list[str]:
    summary = outcome.as_dict()
    notes = []
    for row in summary["not_reached"]:
        what = row["boundary"].replace("_", " ")
        notes.append(f"{what} is not reached at {row['horizontal_m_s']:.2f} m/s horizontal, {row['vertical_m_s']:.2f} m/s vertical")
    if summary["not_flown"]:
        first = summary["not_flown"][0]["error"]
        notes.append(f"{len(summary['not_flown'])} landings could not be flown to their end and are held to fail ({first})")
    if summary["not_trusted"]:
        notes.append(f"{summary['not_trusted']} landings did not hold their tolerance to the end; they count as they ended")
    audit = summary["audit"]
    if audit["landings"]:
        notes.append(f"{audit['landings']} landings at random inside the envelope: {len(audit['failed'])} fail")
    cost = summary["cost"]
    took = f"{cost['cpu_s']:.0f} s of computing, {cost['wall_s']:.0f} s on {cost['workers']:.0f} workers"
    notes.append(f"{cost['landings']:.0f} landings, of which {cost['flown_now']:.0f} flown by this call: {took}")
    return notes
