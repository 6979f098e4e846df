"""What a person reads after `orchestrator diagnose` and `orchestrator distinguish`."""

from __future__ import annotations

from pathlib import Path

from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from orchestrator.diagnosis.outcome import EXIT, Outcome
from orchestrator.diagnosis.report import words
from orchestrator.diagnosis.report.distinction import Distinction
from orchestrator.diagnosis.report.numbers import NONE, chance, number, percent, probability_of_residual, signed, spelt, with_sigma
from orchestrator.diagnosis.report.page_distinction import distinction_sentence
from orchestrator.diagnosis.report.plot_rivals import ranked
from orchestrator.diagnosis.report.template import is_known

ROWS = 5


def terminal_summary(outcome: Outcome, folder: Path | None = None, report: bool = True) -> RenderableType:
    """The verdict on one screen, for `rich.print`: sentence, rivals, gap, where, files. report: whether the folder holds one."""
    colour = "red" if outcome.verdict in EXIT else "yellow" if outcome.verdict in ("cannot_tell", "none_of_my_effects") else "green"
    parts: list[RenderableType] = [
        Text(words.verdict_sentence(outcome), style=f"bold {colour}"),
        Text(words.caution(outcome), style="dim"),
        Text(),
    ]
    if outcome.candidates:
        parts += [_rivals(outcome), Text()]
    if outcome.where:
        parts += [_where(outcome), Text()]
    if outcome.faults:
        parts += [_faults(outcome), Text()]
    if outcome.cannot_tell.measure:
        parts += [_measure(outcome), Text()]
    found = "report.html, diagnosis.json, figures, courses" if report else "diagnosis.json"
    parts.append(_facts(outcome, f"{folder / found}" if folder is not None else ""))
    parts += [Text(line, style="yellow") for line in outcome.warnings]
    parts += [
        Text(f"{words.next_step(outcome)}"),
        Padding(Text(words.command(outcome), style="bold", no_wrap=True, overflow="ignore"), (0, 0, 0, 2)),
    ]
    return Group(*parts)


def _table(*headings: str) -> Table:
    """Headings that start with > stand to the right."""
    table = Table(box=None, header_style="bold", pad_edge=False, padding=(0, 2, 0, 0))
    for heading in headings:
        table.add_column(Text(heading.removeprefix(">")), justify="right" if heading.startswith(">") else "left")
    return table


def _rivals(outcome: Outcome) -> Table:
    table = _table("candidate", ">ln evidence", ">probability", ">adequacy", ">hold-out", "parameters")
    named = {effect.name for effect in outcome.effects}
    for candidate in ranked(outcome.candidates)[:ROWS]:
        found = [f"{name} {with_sigma(e.value, e.sigma)} {spelt(e.unit)}".rstrip() for name, e in candidate.parameters.items()]
        cells = [candidate.title or candidate.name, signed(candidate.log_evidence), chance(candidate.probability)]
        cells += [probability_of_residual(candidate.adequacy), signed(candidate.holdout_gain), ", ".join(found)]
        table.add_row(*(Text(cell) for cell in cells), style="bold" if candidate.name in named else "")
    return table


def _where(outcome: Outcome) -> Table:
    table = _table("where", ">from, s", ">to, s", ">strength, σ", "best explained at")
    for window in sorted(outcome.where, key=lambda w: -w.sigmas if is_known(w.sigmas) else 0.0)[:ROWS]:
        name = f"{window.channel} ({window.landing})" if window.landing else window.channel
        cells = (name, number(window.from_s), number(window.to_s), number(window.sigmas), window.port or window.unit or NONE)
        table.add_row(*(Text(cell) for cell in cells))
    return table


def _faults(outcome: Outcome) -> Table:
    table = _table("channel", "fault", ">from, s", ">to, s")
    for fault in outcome.faults[:ROWS]:
        times = (number(fault[key]) if is_known(fault.get(key)) else NONE for key in ("from_s", "to_s"))
        table.add_row(*(Text(cell) for cell in (str(fault.get("channel", "")), str(fault.get("what", "")), *times)))
    return table


def _measure(outcome: Outcome) -> Table:
    table = _table("what would decide", ">to within", "why")
    for one in outcome.cannot_tell.measure[:ROWS]:
        table.add_row(*(Text(cell) for cell in (one.channel, words.in_unit_of(one.channel, one.sigma) or NONE, one.reason)))
    return table


def _facts(outcome: Outcome, files: str) -> Table:
    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    gap = outcome.gap
    for title, before, after in (("fitted", gap.fit_before, gap.fit_after), ("held out", gap.holdout_before, gap.holdout_after)):
        if is_known(before):
            table.add_row(f"gap, {title}", f"{number(before)} → {number(after)} σ" if is_known(after) else f"{number(before)} σ")
    if is_known(gap.closure):
        table.add_row("gap closed", f"{percent(gap.closure)}{words.by_whom(outcome)}")
    if outcome.not_excited:
        table.add_row("not to be seen", Text(", ".join(words.title_of(outcome, name) for name in outcome.not_excited)))
    table.add_row("cost", f"{outcome.simulations} landings, {number(outcome.seconds)} s")
    if outcome.revised_scenario:
        table.add_row("revised scenario", Text(outcome.revised_scenario))
    if files:
        table.add_row("files", Text(files))
    return table


def terminal_distinguish(table: Distinction, folder: Path | None = None) -> RenderableType:
    """Which effects would show, which look alike, which sensor would help."""
    parts: list[RenderableType] = [Text(distinction_sentence(table), style="bold"), Text()]
    effects = _table("effect", ">λ at prior sigma", ">shows from", "", "like")
    for e in [*table.seen, *table.unseen]:
        alike = [name for group in table.groups if e.name in group for name in group if name != e.name]
        cells = (e.title or e.name, number(e.lambda_), number(e.detectable, 2), spelt(e.unit), ", ".join(alike))
        effects.add_row(*(Text(cell) for cell in cells), style="" if e in table.seen else "dim")
    parts.append(effects)
    if table.sensors:
        sensors = _table("one more sensor", ">to within", "would part", "would make visible")
        for s in table.sensors:
            parted = "; ".join(" / ".join(group) for group in s.splits) or NONE
            sensors.add_row(*(Text(c) for c in (s.channel, f"{number(s.sigma, 2)} {spelt(s.unit)}", parted, ", ".join(s.reveals) or NONE)))
        parts += [Text(), sensors]
    parts.append(
        Text(
            f"{table.simulations} landings, {number(table.seconds)} s" + (f"; {folder / 'distinguish.html'}" if folder else ""), style="dim"
        )
    )
    return Group(*parts)
