"""Hypotheses fitted to one horizon, and which of them are worth taking to the next.

φ at the optimum only grows with the horizon: whoever explains the rest no better than noise can no longer be caught by one who is further
behind than that. So a fit must have converged before it is left behind: all run a few steps, the hopeful go on until they stand.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from orchestrator.diagnosis.climb import Run, Rung, counted, explains
from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.tasks.draw import Draw, Leap
from orchestrator.diagnosis.tasks.fits import Climb, FitAt, Point, point_of

QUICK = 3  # steps before the hopeful are told from the hopeless
HOPEFUL = 40.0  # of φ behind the best after them
FEW = 16  # fits: so many or fewer are drawn from more thoroughly
DRAWS = {False: (16, 1), True: (20, 2)}  # of each fit's posterior, and how many of them are fitted
PRUNE = 25.0  # of φ behind the best once they stand
LEAST = (12, 5)  # hypotheses that go on all the same: after the quick steps, to the next horizon
MOST = 10  # fits taken further at a horizon: where more are alike, what is wanted is not among them, or will be tried again
ALIKE = 8.0  # of φ: two fits of one hypothesis both go on within this
APART = 0.05  # of φ: below, they are one


def launched(
    landings: Landings, nuisances: Sequence[Coordinate], hypotheses: Sequence[Hypothesis], point: Point, run: Run
) -> list[tuple[Hypothesis, Fit]]:
    """All hypotheses at the horizon of a fit of the base scenario, from there."""
    tasks = [
        FitAt(landings, (*nuisances, *h.coordinates), point, np.concatenate([point.z, np.zeros(len(h.coordinates))]), QUICK)
        for h in hypotheses
    ]
    fits = run("hypotheses", tasks)
    return [(h, fit) for h, fit in zip(hypotheses, fits, strict=True) if fit is not None]


def raced(landings: Landings, before: Sequence[tuple[Hypothesis, Fit]], rung: Rung, run: Run) -> list[tuple[Hypothesis, Fit]]:
    """Who is still in the race after the rung's horizon, best first, with its fit, or two; before: fits to a shorter one."""
    point = rung.point
    stage = "hypotheses" if np.isinf(point.horizon) else f"hypotheses to {point.horizon:g} s"
    few = len(before) <= FEW
    count, best = DRAWS[few]
    leaps = [Leap(Draw(landings, fit, point.horizon, count, best, point.slopes), len(h.coordinates), QUICK) for h, fit in before]
    fits = [(h, fit) for (h, _), ends in zip(before, run(stage, leaps), strict=True) for fit in ends]
    quick = _kept(fits, HOPEFUL, LEAST[0])
    if not few and explains(rung.fit.chi2, counted(landings, point.horizon)):
        return quick  # nobody is to be left behind here
    quick = quick[:MOST]
    more = [Climb(landings, fit.coordinates, point_of(fit, point.horizon)) for _, fit in quick]
    stood = zip(quick, run(stage, more), strict=True)
    return _kept([(h, fit) for (h, _), fit in stood if fit is not None], PRUNE, LEAST[1])


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
