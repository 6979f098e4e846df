"""The nuisances fitted to longer and longer stretches of the landing, several fits abreast (docs/decisions/0010-growing-horizons.md).

The first tenths of a second depend almost linearly on the nuisances; once they are known to that, the next contact comes in the right
order. Every horizon has minima of its own where the order is wrong: of twelve fits from the best draws three ended in them, at φ = 79 to
154 beside 21. So several fits climb the first horizon, until two that explain it agree, and the best few of different minima go on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Task
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.tasks.begin import Start
from orchestrator.diagnosis.tasks.draw import Draw
from orchestrator.diagnosis.tasks.fits import Climb, Point

Array = NDArray[np.float64]
Run = Callable[[str, Sequence[Task[Any]]], list[Any]]
FIRST = 8  # fits to the first horizon, at most
AT_A_TIME, AGREE = 2, 2  # of them that are begun together; so many in one minimum that explains the data are enough
ABREAST = 2  # of different minima that go on from each horizon
DRAWS = (20, 1)  # of the posterior of each that does not go on as noise lets, and how many of them are fitted
NOTICED = 1.0  # standard deviations by which what a horizon adds may exceed noise before other ways on are looked for
BEHIND = 25.0  # of φ: who is further behind the best of a horizon does not go on
SAME = 2.0  # posterior standard deviations: fits nearer to each other have one minimum


class Rung(NamedTuple):
    """One horizon of a climb: where the fit began, with the slopes there, and how it ended."""

    point: Point
    fit: Fit


Path = tuple[Rung, ...]


def climbed(
    landings: Landings,
    nuisances: Sequence[Coordinate],
    horizons: Sequence[float],
    starts: Sequence[Array],
    run: Run,
) -> list[Path]:
    """Climbs of all horizons, the best first, ABREAST at most; empty where none of the starts can be flown.

    From where the best leaves more than noise it goes on alone: no minimum of these coordinates will do. A climb goes on from its fit;
    where a horizon then adds more than noise, from the best of draws beside, and so from there on until one adds no more.
    """
    chosen = tuple(nuisances)
    paths = _begun([Start(landings, chosen, z, horizons[0]) for z in starts[:FIRST]], counted(landings, horizons[0]), run)
    lets = True
    for horizon in horizons[1:]:
        paths = paths if not paths or explains(paths[0][-1].fit.chi2, counted(landings, paths[0][-1].point.horizon)) else paths[:1]
        higher: list[Path] = []
        if lets:
            higher = _onward(landings, chosen, paths, [Draw(landings, path[-1].fit, horizon, 0, 1) for path in paths], run)
            lets = any(_as_noise_lets(landings, *path[-2:]) for path in higher)
        if not lets:
            known = {id(path[-2]): path[-1].point.slopes for path in higher}
            draws = [Draw(landings, path[-1].fit, horizon, *DRAWS, known.get(id(path[-1]))) for path in paths]
            drawn = _onward(landings, chosen, paths, draws, run)
            lets = any(_as_noise_lets(landings, *path[-2:]) for path in drawn)
            higher += drawn
        paths = distinct(higher)[:ABREAST]
    return paths


def _onward(landings: Landings, nuisances: tuple[Coordinate, ...], paths: Sequence[Path], draws: Sequence[Draw], run: Run) -> list[Path]:
    """The paths, each taken to its draw's horizon from the points that the draw finds there."""
    pairs = [(path, point) for path, points in zip(paths, run("base fit", draws), strict=True) for point in points]
    ends = run("base fit", [Climb(landings, nuisances, point) for _, point in pairs])
    return [(*path, Rung(point, fit)) for (path, point), fit in zip(pairs, ends, strict=True) if fit is not None]


def _as_noise_lets(landings: Landings, below: Rung, above: Rung) -> bool:
    """Whether a rung leaves no more of what its horizon adds than the one below lets expect: 2 φ at the optimum is chi-square with as many
    degrees of freedom as there are readings, less where their noise is smaller than stated."""
    count = counted(landings, below.point.horizon)
    added = counted(landings, above.point.horizon) - count
    level = min(1.0, 2.0 * below.fit.objective / count)
    return 2.0 * (above.fit.objective - below.fit.objective) <= level * (added + NOTICED * float(np.sqrt(2.0 * added)))


def _begun(starts: Sequence[Start], count: float, run: Run) -> list[Path]:
    """Fits to the first horizon, the best first: as many as it takes for several to agree. count: readings there."""
    made: list[Path] = []
    for i in range(0, len(starts), AT_A_TIME):
        made += [(Rung(*one),) for one in run("base fit", starts[i : i + AT_A_TIME]) if one is not None]
        best = min(made, key=lambda path: path[0].fit.objective, default=())
        if best and explains(best[0].fit.chi2, count) and sum(_same(path[0].fit, best[0].fit) for path in made) >= AGREE:
            break
    return distinct(made)[:ABREAST]


def counted(landings: Landings, horizon: float) -> float:
    """Readings that count when the landings are flown to this horizon."""
    return sum(float(o.weights(horizon).sum()) for o in landings.observations)


def explains(chi2: float, count: float) -> bool:
    """Whether a chi-square over so many rows is within three standard deviations of noise."""
    return chi2 <= count + 3.0 * float(np.sqrt(2.0 * count))


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
    """Whether `other`, the better, would take `one` for itself."""
    move = one.z - other.z
    across = other.jacobian @ move
    return float(across @ across + move @ move) < SAME**2
