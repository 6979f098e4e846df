"""A run that is no landing: every column's final, least and greatest value, and the numbers a scenario asks for."""

from typing import Any

from orchestrator.results.channels import Channels
from orchestrator.results.schema import ReportEntry, ResultsTable


def generic(channels: Channels, units: dict[str, str]) -> dict[str, Any]:
    """`columns`: {name: {final, min, max, unit}}, each in the unit it was recorded in."""
    columns = {}
    for name in channels.columns:
        least, greatest = channels.span(name)
        columns[name] = {"final": channels.final(name), "min": least, "max": greatest, "unit": units.get(name, "")}
    return {"columns": columns}


def report(channels: Channels, table: ResultsTable) -> dict[str, dict[str, Any]]:
    """`[results.report]` answered: value, what was expected, their difference and the relative one (value/expected − 1)."""
    return {name: _answer(channels, entry) for name, entry in table.report.items()}


def _answer(channels: Channels, entry: ReportEntry) -> dict[str, Any]:
    least, greatest = channels.span(entry.variable)
    value = {"final": channels.final(entry.variable), "min": least, "max": greatest}[entry.at]
    difference = None if value is None or entry.expected is None else value - entry.expected
    relative = difference / entry.expected if difference is not None and entry.expected else None
    return {
        "value": value,
        "expected": entry.expected,
        "difference": difference,
        "relative_difference": relative,
        "unit": entry.unit,
        "variable": entry.variable,
        "at": entry.at,
        "source": entry.source,
    }
