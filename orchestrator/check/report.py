"""The report: a table for a person, JSON for a machine."""

from __future__ import annotations

from typing import Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from orchestrator.check.check import Checked
from orchestrator.check.finding import Finding, Verdict

_FIRST = {Verdict.FAIL: 0, Verdict.WARN: 1}
"""What asks for something to be done stands on top."""
_COLOURS = {Verdict.PASS: "green", Verdict.NOTE: "dim", Verdict.WARN: "yellow", Verdict.FAIL: "bold red"}


def table(result: Checked) -> RenderableType:
    rows = Table("check", "", "found", "what to do", box=None, pad_edge=False, header_style="bold", padding=(0, 2, 0, 0))
    for finding in sorted(result.findings, key=lambda one: _FIRST.get(one.verdict, 2)):
        where = f"{finding.where}: " if finding.where and finding.where not in finding.found else ""
        verdict = Text(finding.verdict, style=_COLOURS[finding.verdict])
        rows.add_row(finding.check, verdict, Text(where + finding.found), Text(finding.do))
    return Group(Text(headline(result), style="bold"), rows, Text(tally(result)))


def headline(result: Checked) -> str:
    about = f"{result.path.name}  FMI {result.interface.fmi_version}, {result.interface.generation_tool or 'tool not stated'}"
    if not result.kind:
        return f"{about}  no kind of unit recognised from its ports: held against no contract; name one with --as"
    return f"{about}  held against the contract of {result.kind}" + (" (guessed; --as names another)" if result.guessed else "")


def tally(result: Checked) -> str:
    counts = {verdict: sum(f.verdict is verdict for f in result.findings) for verdict in Verdict}
    many = {verdict: "" if count == 1 else "s" for verdict, count in counts.items()}
    warned, noted = f"{counts[Verdict.WARN]} warning{many[Verdict.WARN]}", f"{counts[Verdict.NOTE]} note{many[Verdict.NOTE]}"
    return f"{counts[Verdict.PASS]} passed, {warned}, {counts[Verdict.FAIL]} failed, {noted}"


def as_json(result: Checked) -> dict[str, Any]:
    return {
        "fmu": str(result.path),
        "sha256": result.interface.sha256,
        "fmi_version": result.interface.fmi_version,
        "kind": result.kind or None,
        "kind_guessed": result.guessed,
        "passed": not result.failed,
        "findings": [finding.as_json() for finding in result.findings],
    }


def complaint(result: Checked) -> str:
    """One line for all that failed: the first in full."""
    first, more = result.failed[0], len(result.failed) - 1
    also = f" (and {more} more)" if more else ""
    return f"{result.path.name}: {_said(first)}{also}"


def _said(finding: Finding) -> str:
    return f"{finding.check}: {finding.line}"
