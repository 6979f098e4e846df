"""Scores of several sets as one: a set too dear for one day or one machine is made, diagnosed and scored in parts."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from sealed.scoring import Score

ROWS = TypeAdapter(list[Score])


def pooled(paths: Sequence[Path]) -> list[Score]:
    """Rows of several score.json, each case named by its file's folder, too.

    Raises ValueError where two methods judged them, a case is in twice, or a file holds no scores.
    """
    found = [replace(score, case=f"{path.parent.name}/{score.case}") for path in paths for score in _read(path)]
    if not found:
        raise ValueError(f"{', '.join(map(str, paths))}: no scores")
    one_method(found)
    unsure = sorted({score.by for score in found if not score.by or score.by.endswith("+")})
    if unsure and len(paths) > 1:
        raise ValueError(f"diagnosed by {unsure[0] or 'an unknown commit'}, no commit as it stands: whether by one method nobody knows")
    seen: dict[tuple[int, ...], str] = {}
    for score in found:
        if score.seed and score.seed in seen:
            raise ValueError(f"{score.case} is {seen[score.seed]}: one case, made with seed {score.seed[0]}; give each case once")
        seen[score.seed] = score.case
    return found


def one_method(scores: Sequence[Score]) -> None:
    """ValueError where two commits or two commands judged them."""
    methods = sorted({f"{score.method or 'an unknown command'} of {score.by or 'an unknown commit'}" for score in scores})
    if len(methods) > 1:
        raise ValueError(f"diagnosed by {' and by '.join(methods)}: scores of one method only make a table")


def _read(path: Path) -> list[Score]:
    try:
        rows = json.loads(path.read_text("utf-8"))
        return ROWS.validate_python([{"closure": math.nan} | {k: v for k, v in row.items() if v is not None} for row in rows])
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"]))
        raise ValueError(f"{path}: {place}: {first['msg']}; give the score.json that `score` wrote") from None
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise ValueError(f"{path}: cannot be read as scores: {error}") from None
