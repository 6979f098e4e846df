"""A run's summary as one row: numbers, truth values and words under flat names."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from orchestrator.errors import ScenarioError, nearest
from orchestrator.results.touchdown import DEGREES, TIPPED

Output = float | bool | str | None
_ABOUT_THE_RUN = ("title", "kind", "complete", "trusted", "interrupted", "message", "warnings", "notes", "ledger", "missing", "directory")
_OF_THE_MASTER = ("steps", "rejected", "unresolved", "unit_steps", "simulated_s")
"""The rest of summary.json's `master` is wall time, or the same in every landing."""
_OF_THE_COMPARISON = ("rms_m",)
NOT_FLOWN = "not flown"


def flat(summary: Mapping[str, Any]) -> dict[str, Output]:
    """`strokes_m.+Z.left`, `peak_rates_deg_s.roll.min`: the keys of summary.json joined by dots.

    A pair of numbers is least and greatest, words stand in one cell with blanks between.
    """
    kept = {key: value for key, value in summary.items() if key not in _ABOUT_THE_RUN}
    for key, chosen in (("master", _OF_THE_MASTER), ("comparison", _OF_THE_COMPARISON)):
        if kept.get(key) is not None:
            kept[key] = {name: kept[key][name] for name in chosen}
    return dict(_flattened(kept, ""))


def _flattened(tree: Mapping[str, Any], before: str) -> Iterator[tuple[str, Output]]:
    for key, value in tree.items():
        name = f"{before}{key}"
        if isinstance(value, Mapping):
            yield from _flattened(value, f"{name}.")
        elif isinstance(value, list):
            if len(value) == 2 and all(item is None or isinstance(item, float) for item in value):
                yield from zip((f"{name}.min", f"{name}.max"), value, strict=True)
            elif all(isinstance(item, str) for item in value):
                yield name, " ".join(value)
        elif value is None or isinstance(value, (bool, float, str)):
            yield name, value
        elif isinstance(value, int):
            yield name, float(value)


def outcome(summary: Mapping[str, Any]) -> str:
    """One word: stands, tipped, unsettled (neither at rest nor going over), unknown (not recorded); of what is no landing: finished."""
    if summary["kind"] != "touchdown":
        return "finished"
    if summary["stable"] is None:
        return "unknown"
    if summary["stable"]:
        return "stands"
    beyond = ((summary["failure"] or {}).get("tip_over") or {}).get("tipped", False)
    return "tipped" if beyond or (summary["final_tilt_deg"] or 0.0) >= TIPPED * DEGREES else "unsettled"


def chosen(names: Sequence[str], patterns: Sequence[str], where: str) -> list[str]:
    """The names that any of the globs matches, in the summary's order."""
    for pattern in patterns:
        if not fnmatch.filter(names, pattern):
            raise ScenarioError(f'{where}: outputs: "{pattern}" matches none of the summary; {nearest(pattern, names)}')
    return [name for name in names if any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)]
