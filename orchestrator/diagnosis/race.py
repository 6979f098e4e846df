"""Hypotheses fitted to one horizon, and which of them are worth taking to the next.

φ at the optimum only grows with the horizon: whoever explains the rest no better than noise can no longer be caught by one who is further
behind than that. So a fit must have converged before it is left behind: all run a few steps, the hopeful go on until they stand.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Task
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.tasks import INSENSITIVE, FitAt, GoOn, Point

Array = NDArray[np.float64]
Run = Callable[[str, Sequence[Task[Any]]], list[Any]]
QUICK = 3  # steps before the hopeful are told from the hopeless
HOPEFUL = 60.0  # of φ behind the best after them
PRUNE = 25.0  # of φ behind the best once they stand
LEAST = (20, 8)  # hypotheses that go on all the same: after the quick steps, to the next horizon
ALIKE = 8.0  # of φ: two fits of one hypothesis both go on within this
APART = 0.05  # of φ: below, they are one


class Runner(NamedTuple):
    """A hypothesis and where it starts: z of the nuisances, then its own."""

    hypothesis: Hypothesis
    z: Array


def raced(
    landings: Landings, nuisances: Sequence[Coordinate], fresh: Sequence[int], runners: Sequence[Runner], point: Point, run: Run
) -> list[tuple[Hypothesis, Fit]]:
    """Who is still in the race after the point's horizon, best first, with its fit, or two."""

    def flown(who: Sequence[Runner]) -> list[tuple[Hypothesis, Fit]]:
        tasks = [FitAt(landings, (*nuisances, *h.coordinates), point, z, QUICK) for h, z in who]
        return [(r.hypothesis, fit) for r, fit in zip(who, run(stage, tasks), strict=True) if fit is not None]

    stage = "hypotheses" if np.isinf(point.horizon) else f"hypotheses to {point.horizon:g} s"
    fits = flown(runners)
    fits += flown([r for h, fit in fits if _deaf(h, fit) for r in _elsewhere(h, fit.z[: len(nuisances)])])
    quick = _kept(fits, HOPEFUL, LEAST[0])
    more = [GoOn(landings, fit, point.horizon, (*fresh, *range(len(nuisances), len(fit.z)))) for _, fit in quick]
    stood = zip(quick, run(stage, more), strict=True)
    return _kept([(h, fit) for (h, _), fit in stood if fit is not None], PRUNE, LEAST[1])


def _deaf(h: Hypothesis, fit: Fit) -> bool:
    """Whether the hypothesis cannot be felt where it is: it must be started elsewhere."""
    return float(np.linalg.norm(fit.jacobian[:, len(fit.z) - len(h.coordinates) :], axis=0).max()) < INSENSITIVE


def _elsewhere(h: Hypothesis, nuisances: Array) -> list[Runner]:
    return [Runner(h, np.concatenate([nuisances, own])) for own in h.scaled_starts()]


def _kept(fits: Sequence[tuple[Hypothesis, Fit]], behind: float, least: int) -> list[tuple[Hypothesis, Fit]]:
    """Best first, one or two of each hypothesis, without those far behind."""
    kept: list[tuple[Hypothesis, Fit]] = []
    seen: dict[str, list[float]] = {}
    for h, fit in sorted(fits, key=lambda pair: pair[1].objective):
        others = seen.setdefault(h.name, [])
        if kept and fit.objective > kept[0][1].objective + behind and len(seen) > least:
            break
        if len(others) < 2 and not (others and (fit.objective > others[0] + ALIKE or fit.objective < others[0] + APART)):
            others.append(fit.objective)
            kept.append((h, fit))
    return kept
