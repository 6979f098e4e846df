"""Published numbers to stand beside a run, read from a data file the scenario names (see scenarios/paper.toml)."""

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

METRES_PER = {"m": 1.0, "cm": 0.01, "mm": 0.001}


@dataclass(frozen=True)
class References:
    """Columns of strokes in m by strut name, and sections of other observables, as `glass_zupp_like`."""

    titles: dict[str, str] = field(default_factory=dict)
    strokes: dict[str, dict[str, float | None]] = field(default_factory=dict)
    sections: dict[str, dict[str, Any]] = field(default_factory=dict)
    source: str = ""
    fault: str = ""

    def unknown(self, names: list[str | None]) -> list[str]:
        """Which of the names are neither a column nor a section."""
        return [name for name in names if name and name not in self.strokes and name not in self.sections]

    def section(self, name: str | None) -> dict[str, Any]:
        """The observables published under `name`; empty where there are none."""
        return self.sections.get(name, {}) if name else {}


def load(path: Path) -> References:
    """Read a reference file; one that cannot be read gives empty references that say why in `fault`."""
    try:
        return parse(tomllib.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        return References(fault=f"{path.name}: not usable as references ({type(error).__name__}: {error})")


def parse(data: Mapping[str, Any]) -> References:
    """References from the parsed file: sections `[group.case]` become `group_case`, NaN None (no measurement), lengths m."""
    table = data.get("table6", {})
    columns: list[str] = table.get("columns", [])
    scale = METRES_PER[table.get("unit", "cm")]
    strokes = {
        column: {strut: None if math.isnan(row[i]) else row[i] * scale for strut, row in table["struts"].items()}
        for i, column in enumerate(columns)
    }
    sections = {
        f"{group}_{case}": values
        for group, cases in data.items()
        if group != "table6" and isinstance(cases, Mapping)
        for case, values in cases.items()
        if isinstance(values, dict)
    }
    titles = dict(zip(columns, table.get("titles", columns), strict=True))
    return References(titles=titles, strokes=strokes, sections=sections, source=table.get("source", ""))


def find(name: str | None, folders: list[Path]) -> Path | None:
    """The reference file in the first of the folders that has it; an absolute name needs no folder."""
    if name is None:
        return None
    return next((path for folder in folders if (path := folder / name).is_file()), None)


def folders_of(scenario: Path | None) -> list[Path]:
    """Where the reference file of a scenario may be: beside or above it, in `scenarios`, here."""
    return [*(scenario.resolve().parents if scenario else ()), Path("scenarios"), Path()]
