"""A benchmark's results as files: the same rows as Markdown, CSV and JSON."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from math import isfinite
from pathlib import Path
from typing import Any

Row = dict[str, Any]


def write_json(out: Path, name: str, content: Any) -> None:
    (out / f"{name}.json").write_text(json.dumps(content, indent=1, default=float) + "\n", "utf-8")


def write_table(out: Path, name: str, rows: Sequence[Row], note: str = "") -> None:
    """NAME.md and NAME.csv; the columns are the first row's keys."""
    heads = list(rows[0])
    with (out / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, heads, extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)
    (out / f"{name}.md").write_text(markdown(rows) + (f"\n{note}\n" if note else ""), "utf-8")


def markdown(rows: Sequence[Row]) -> str:
    heads = list(rows[0])
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    lines += ["| " + " | ".join(shown(row[head]) for head in heads) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def shown(value: Any) -> str:
    """Three significant digits; nothing where there is nothing."""
    if value is None or (isinstance(value, float) and not isfinite(value)):
        return "" if value is None or value != value else "∞"
    if isinstance(value, bool) or not isinstance(value, float):
        return str(value) if not isinstance(value, int) or isinstance(value, bool) else f"{value:,}"
    if value != 0.0 and not 1e-2 <= abs(value) < 1e4:
        return f"{value:.2e}"
    return f"{value:.3g}" if abs(value) < 100.0 else f"{value:.0f}"


def finite(value: float) -> float | None:
    """As JSON knows it."""
    return value if isfinite(value) else None
