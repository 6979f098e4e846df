"""Scores of several sets as one: a set too dear for one day or one machine is made, diagnosed and scored in parts."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from sealed.scoring import Score


def pooled(paths: Sequence[Path]) -> list[Score]:
    """Rows of several score.json, each case named by its file's folder, too.

    Raises ValueError where two methods judged them, a case is in twice, or a file holds no scores.
    """
    found = [_read(path, row) for path in paths for row in _rows(path)]
    if not found:
        raise ValueError(f"{', '.join(map(str, paths))}: no scores")
    methods = sorted({score.by for score in found})
    if len(methods) > 1:
        by = " and ".join(it or "an unknown commit" for it in methods)
        raise ValueError(f"diagnosed by {by}: scores of one method only can be pooled")
    seen: dict[tuple[int, ...], str] = {}
    for score in found:
        if score.seed and score.seed in seen:
            raise ValueError(f"{score.case} is {seen[score.seed]}: one case, made with seed {score.seed[0]}; give each case once")
        seen[score.seed] = score.case
    return found


def _rows(path: Path) -> list[dict[str, Any]]:
    try:
        rows = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise ValueError(f"{path}: cannot be read as scores: {error}") from None
    needed = {field.name for field in fields(Score) if field.default is MISSING and field.default_factory is MISSING}
    if not isinstance(rows, list) or not all(isinstance(row, dict) and needed <= row.keys() for row in rows):
        raise ValueError(f"{path}: not a list of scores; give the score.json that `score` wrote")
    return rows


def _read(path: Path, row: dict[str, Any]) -> Score:
    known = {name: row[name] for name in (field.name for field in fields(Score)) if name in row}
    for name in ("closure", "seconds", "simulations"):
        known[name] = math.nan if known.get(name) is None else float(known[name])
    for name in ("truth", "named", "seed", "skipped"):
        known[name] = tuple(known.get(name, ()))
    return Score(**known | {"case": f"{path.parent.name}/{row['case']}"})
