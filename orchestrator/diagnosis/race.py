"""Hypotheses fitted to one horizon, and which of them are worth taking to the next.

φ at the optimum only grows with the horizon: whoever explains the rest no better than noise can no longer be caught by one who is further
behind than that. So a fit must have converged before it is left behind: all run a few steps, the hopeful go on until they stand.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from orchestrator.diagnosis.climb import Run
from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.tasks import Climb, Draw, FitAt, Leap, Point, point_of

QUICK = 3  # steps before the hopeful are told from the hopeless
HOPEFUL = 40.0  # of φ behind the best after them
FEW = 16  # hypotheses: so many or fewer are drawn from more thoroughly
DRAWS = {False: 16, True: 24}  # of each fit's posterior, where more or so few are in the race
PRUNE = 25.0  # of φ behind the best once they stand
LEAST = (12, 5)  # hypotheses that go on all the same: after the quick steps, to the next horizon


def launched(
    landings: Landings, nuisances: Sequence[Coordinate], hypotheses: Sequence[Hypothesis], point: Point, run: Run
) -> list[tuple[Hypothesis, Fit]]:
    """All hypotheses at the last horizon that the base scenario explains, from its fit there."""
    tasks = [
        FitAt(landings, (*nuisances, *h.coordinates), point, np.concatenate([point.z, np.zeros(len(h.coordinates))]), QUICK)
        for h in hypotheses
    ]
    fits = run("hypotheses", tasks)
    return [(h, fit) for h, fit in zip(hypotheses, fits, strict=True) if fit is not None]


def raced(landings: Landings, before: Sequence[tuple[Hypothesis, Fit]], point: Point, run: Run) -> list[tuple[Hypothesis, Fit]]:
    """Who is still in the race after the point's horizon, best first, with its fit; before: fits to a shorter one."""
    stage = "hypotheses" if np.isinf(point.horizon) else f"hypotheses to {point.horizon:g} s"
    count = DRAWS[len(before) <= FEW]
    leaps = [Leap(Draw(landings, fit, point.horizon, count, point.slopes), len(h.coordinates), QUICK) for h, fit in before]
    quick = _kept([h for h, _ in before], run(stage, leaps), HOPEFUL, LEAST[0])
    more = [Climb(landings, fit.coordinates, point_of(fit, point.horizon)) for _, fit in quick]
    return _kept([h for h, _ in quick], run(stage, more), PRUNE, LEAST[1])


def _kept(hypotheses: Sequence[Hypothesis], fits: Sequence[Fit | None], behind: float, least: int) -> list[tuple[Hypothesis, Fit]]:
    """Best first, `least` at least, without those far behind."""
    found = [(h, fit) for h, fit in zip(hypotheses, fits, strict=True) if fit is not None]
    found.sort(key=lambda pair: pair[1].objective)
    return [pair for i, pair in enumerate(found) if i < least or pair[1].objective <= found[0][1].objective + behind]
