"""The nuisances fitted to longer and longer stretches of the landing, several fits abreast (docs/decisions/0010-growing-horizons.md).

The first tenths of a second depend almost linearly on the nuisances; once they are known to that, the next contact comes in the right
order. Every horizon has minima of its own where the order is wrong: of twelve fits from the best draws three ended in them, at φ = 79 to
154 beside 21. So many fits climb the first horizon, which is cheap, and the best few of different minima go on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.tasks import Climb, Point

Array = NDArray[np.float64]
Run = Callable[[str, Sequence[Climb]], list["tuple[Point, Fit] | None"]]
ABREAST = (10, 4, 2)  # fits at the first horizons; the last number holds for all that follow
BEHIND = 25.0  # of φ: who is further behind the best of a horizon does not go on
SAME = (0.3, 0.5)  # of φ, and of every z: one minimum


class Rung(NamedTuple):
    """One horizon of a climb: where the fit began, with the slopes there, and how it ended."""

    point: Point
    fit: Fit


Path = tuple[Rung, ...]


def climbed(
    landings: Landings, nuisances: Sequence[Coordinate], horizons: Sequence[float], starts: Sequence[Array], run: Run
) -> list[Path]:
    """Climbs of all horizons, the best first; empty where none of the starts can be flown."""
    paths: list[Path] = [() for _ in starts[: ABREAST[0]]]
    ends = list(starts[: ABREAST[0]])
    for place, horizon in enumerate(horizons):
        tasks = [Climb(landings, tuple(nuisances), z, horizon, gently=place == 0) for z in ends]
        rungs = [(path, Rung(*made)) for path, made in zip(paths, run("base fit", tasks), strict=True) if made is not None]
        paths = distinct([(*path, rung) for path, rung in rungs])[: ABREAST[min(place + 1, len(ABREAST) - 1)]]
        ends = [path[-1].fit.z for path in paths]
    return paths


def distinct(paths: Sequence[Path]) -> list[Path]:
    """Best first, one of each minimum, without those that are far behind."""
    kept: list[Path] = []
    for path in sorted(paths, key=lambda path: path[-1].fit.objective):
        fit = path[-1].fit
        if kept and fit.objective > kept[0][-1].fit.objective + BEHIND:
            break
        if not any(_same(fit, other[-1].fit) for other in kept):
            kept.append(path)
    return kept


def _same(one: Fit, other: Fit) -> bool:
    return abs(one.objective - other.objective) < SAME[0] and float(np.abs(one.z - other.z).max(initial=0.0)) < SAME[1]
