"""A CSV file of numbers -> columns, with the line of whatever is no number."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from orchestrator.errors import MeasuredError

Array = NDArray[np.float64]
_NOTHING = ("", "nan", "na", "null", "none", "-nan")


def read_sheet(path: Path, where: str) -> dict[str, Array]:
    """Header -> column. An empty cell or nan is a gap; blank lines and lines that open with # are passed over."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise MeasuredError(f"{where}: {path.name}: no such file in {path.parent}; correct `file` or add it") from None
    except (OSError, UnicodeDecodeError) as error:
        raise MeasuredError(f"{where}: {path.name}: cannot be read ({error}); give a CSV file in UTF-8") from None
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip() and not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise MeasuredError(f"{where}: {path.name}: holds {len(lines)} lines, expects a header and samples")
    rows = csv.reader(line for _, line in lines)
    header = [name.strip() for name in next(rows)]
    twice = [name for name in header if header.count(name) > 1]
    if twice:
        raise MeasuredError(f'{where}: {path.name}: column "{twice[0]}" stands there {header.count(twice[0])} times; rename or remove one')
    table = np.empty((len(lines) - 1, len(header)))
    for place, (row, (number, _)) in enumerate(zip(rows, lines[1:], strict=False)):
        if len(row) != len(header):
            raise MeasuredError(f"{where}: {path.name} line {number}: holds {len(row)} cells, the header {len(header)}; correct it there")
        for column, cell in enumerate(row):
            table[place, column] = _number(cell, f"{where}: {path.name} line {number}: {header[column]}")
    return {name: table[:, column] for column, name in enumerate(header)}


def _number(cell: str, where: str) -> float:
    text = cell.strip()
    if text.lower() in _NOTHING:
        return math.nan
    try:
        value = float(text)
    except ValueError:
        raise MeasuredError(f'{where} = "{text}": is no number; correct it, or leave the cell empty for a gap') from None
    if math.isinf(value):
        raise MeasuredError(f'{where} = "{text}": is not finite; correct it, or leave the cell empty for a gap')
    return value
