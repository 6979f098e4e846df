"""What a person reads after a run."""

from collections.abc import Mapping
from typing import Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from orchestrator.results.margins import margins

Summary = Mapping[str, Any]
NONE = "–"


def terminal_table(summary: Summary) -> RenderableType:
    """The summary of `write` on one screen, for `rich.print`. The run's own warnings are for the command line to tell."""
    parts: list[RenderableType] = [_headline(summary)]
    if summary["kind"] == "touchdown":
        parts.append(_legs(summary))
    if summary["report"]:
        parts.append(_report(summary["report"]))
    parts.append(_facts(summary))
    if summary.get("failure"):
        parts.append(margins(summary["failure"]))
    if struts := [leg for leg, bottomed in summary.get("bottomed", {}).items() if bottomed]:
        parts.append(Text("a strut reached its stroke limit: " + ", ".join(struts), style="red"))
    parts += [Text(line, style="yellow") for line in summary["notes"]]
    if summary["missing"]:
        parts.append(Text("not recorded: " + ", ".join(summary["missing"]), style="yellow"))
    return Group(*parts)


def _headline(summary: Summary) -> Text:
    words = [("complete", "green")] if summary["complete"] else [("NOT COMPLETE", "red")]
    words.append(("trusted", "green") if summary["trusted"] else ("NOT TRUSTED", "red"))
    if "stable" in summary and summary["complete"]:
        verdicts = {True: ("stands", "green"), False: ("DOES NOT STAND", "red"), None: ("stability unknown", "yellow")}
        words.append(verdicts[summary["stable"]])
    line = Text(summary["title"], style="bold")
    for word, colour in words:
        line.append("  ").append(word, style=colour)
    if summary["message"]:
        line.append("\n" + summary["message"], style="red")
    return line


def _legs(summary: Summary) -> Table:
    """One row a leg in the order of contact; the chosen published stroke in brackets."""
    table = Table(box=None, header_style="bold", pad_edge=False, padding=(0, 2, 0, 0))
    for heading in ("leg", "contact, s", "depth, cm", "skid, cm", "primary, cm", "right, cm", "left, cm"):
        table.add_column(heading, justify="left" if heading == "leg" else "right")
    times = summary["contact_times_s"]
    for leg in sorted(times, key=lambda name: (times[name] is None, times[name])):
        strokes = [_beside(summary, f"{leg}.{strut}") for strut in ("primary", "right", "left")]
        cells = [_number(times[leg], 1.0, 3), _number(summary["penetration_m"][leg], 100.0), _number(summary["skid_m"][leg], 100.0)]
        table.add_row(leg, *cells, *strokes)
    if chosen := (summary["comparison"] or {}).get("chosen"):
        table.caption = f"in brackets: {chosen}"
        table.caption_justify = "left"
    return table


def _beside(summary: Summary, strut: str) -> str:
    ours = _number(summary["strokes_m"][strut], 100.0)
    comparison = summary["comparison"]
    if not comparison or comparison["chosen"] not in comparison["rms_m"]:
        return ours
    return f"{ours} ({_number(comparison['strokes_m'][strut][comparison['chosen']], 100.0)})"


def _report(report: Mapping[str, Mapping[str, Any]]) -> Table:
    table = Table(box=None, header_style="bold", pad_edge=False, padding=(0, 2, 0, 0))
    for heading in ("", "value", "expected", "difference", "source"):
        table.add_column(heading, justify="right" if heading in ("value", "expected", "difference") else "left")
    for name, row in report.items():
        relative = NONE if row["relative_difference"] is None else f"{row['relative_difference']:+.3%}"
        values = [NONE if row[key] is None else f"{row[key]:.6g} {row['unit']}".rstrip() for key in ("value", "expected")]
        table.add_row(name, *values, relative, row["source"])
    return table


def _facts(summary: Summary) -> Table:
    """Name and value, a line each."""
    table = Table(box=None, show_header=False, pad_edge=False, padding=(0, 2, 0, 0))
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for name, value in [*_landing_facts(summary), *_run_facts(summary)]:
        table.add_row(name, value)
    return table


def _landing_facts(summary: Summary) -> list[tuple[str, str]]:
    if summary["kind"] != "touchdown":
        return []
    rates = (f"{axis} {_number(low)} to {_number(high)}" for axis, (low, high) in summary["peak_rates_deg_s"].items())
    angles = (f"{axis} {_number(value)}" for axis, value in summary["final_attitude_deg"].items())
    facts = [("peak rates, deg/s", ", ".join(rates)), ("final attitude, deg", ", ".join(angles))]
    comparison = summary["comparison"]
    if not comparison:
        return facts
    found = comparison["observables"]
    for name, key in (("penetration, cm", "penetration_range_m"), ("largest skid, cm", "max_skid_m")):
        ours, published, measured = (_spread(found[who].get(key)) for who in ("ours", "published", "measured"))
        facts.append((name, f"{ours} (published {published}, measured {measured})"))
    distances = (f"{column} {_number(value, 100.0)}" for column, value in comparison["rms_m"].items())
    return [*facts, ("strokes, RMS cm to", ", ".join(distances))]


def _run_facts(summary: Summary) -> list[tuple[str, str]]:
    master, energy, ledger = summary["master"], summary["energy"], summary["ledger"]
    facts = []
    if energy:
        fraction = NONE if energy["residual_fraction"] is None else f"{energy['residual_fraction']:+.3%}"
        facts.append(("energy unexplained", f"{_number(energy['residual_J'])} J of {_number(energy['initial_J'], 1.0, 0)} J ({fraction})"))
    if leaking := [f"{row['first']} | {row['second']} {_number(row['leak_J'])} J" for row in ledger if row["passed"] is False]:
        facts.append(("connections that leak", ", ".join(leaking)))
    steps = f"{master['steps']} taken, {master['rejected']} refused, {master['unit_steps']} unit steps"
    outside = master["share_outside_units"]
    share = "" if outside is None else f", {outside:.0%} of it outside the units"
    facts.append(("intervals", steps))
    facts.append(("time", f"{master['simulated_s']:.3f} s simulated in {master['wall_s']:.1f} s{share}"))
    return [*facts, ("files", summary.get("directory", NONE))]


def _number(value: float | None, scale: float = 1.0, digits: int = 2) -> str:
    return NONE if value is None else f"{value * scale:.{digits}f}"


def _spread(value: float | list[float] | None) -> str:
    """A length in m, or a pair of them, in cm."""
    if isinstance(value, list):
        return f"{_number(value[0], 100.0)} to {_number(value[1], 100.0)}"
    return _number(value, 100.0)
