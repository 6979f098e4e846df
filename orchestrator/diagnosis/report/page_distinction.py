"""distinguish.html: what some data could show, before they are asked."""

from __future__ import annotations

from pathlib import Path

from orchestrator.diagnosis.report.distinction import ENOUGH, Distinction
from orchestrator.diagnosis.report.plot_distinction import likeness_picture
from orchestrator.diagnosis.report.template import render


def write_distinction(folder: Path, table: Distinction) -> Path:
    """distinguish.html, distinguish.json and figures/likeness.png in `folder`; the path of the page."""
    folder.mkdir(parents=True, exist_ok=True)
    table.write(folder)
    picture = likeness_picture(table)
    if picture:
        (folder / "figures").mkdir(exist_ok=True)
        picture.save(folder / "figures")
    path = folder / "distinguish.html"
    page = render(
        "distinguish.html.jinja", t=table, picture=picture, sentence=distinction_sentence(table), enough=ENOUGH, effect_title=table.title
    )
    path.write_text(page, "utf-8")
    return path


def distinction_sentence(table: Distinction) -> str:
    """These data could show 31 of 46 effects; 9 of them cannot be told from another."""
    seen = {e.name for e in table.seen}
    twins = seen & {name for group in table.groups for name in group if len(group) > 1}
    first = f"These data could show {len(seen)} of {len(table.effects)} effects"
    return (
        f"{first}; {len(twins)} of them cannot be told from another."
        if twins
        else f"{first}, each with a trace of its own."
        if seen
        else f"{first}."
    )
