"""The search: nuisances fitted to the base scenario, then every hypothesis fitted in its own right, the best of them refined.

Order and reasons stand in docs/diagnosis.md. The landings are flown by a crew; this file decides which.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.climb import Path, climbed, counted, explains
from orchestrator.diagnosis.coordinates import Coordinate, folded
from orchestrator.diagnosis.crew import Crew, Task
from orchestrator.diagnosis.fit import Fit, seen_from
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis
from orchestrator.diagnosis.problem import Landings, Model, Nobody
from orchestrator.diagnosis.race import launched, raced
from orchestrator.diagnosis.tasks.begin import Timed
from orchestrator.diagnosis.tasks.fits import FitAt, Point, Refine, point_of
from orchestrator.diagnosis.tasks.predict import Predict
from orchestrator.diagnosis.tasks.probe import Probe

Array = NDArray[np.float64]
Told = Callable[[str, str, float], None]
"""Called with the stage, the best hypothesis so far, and the share of the stage done."""
HORIZONS = (0.3, 0.4, 0.5, 0.65, 0.85, 1.2)  # s since first contact, before the whole
DRAWS = 100  # of the nuisances from their priors, flown to the first horizon
ROUGH = 10.0  # times the twin's tolerance, for these: threefold noise is far above what its steps then leave to chance
STEPPED = "tolerance"  # of the twin's variables; a master has none of this name
LEAST = 0.5  # of φ: what the integrator leaves to chance
FEW = 12  # samples that a horizon must add to be worth a fit
MARGIN = 15.0  # in ln evidence: who is further behind the best is not refined
FINALISTS = 5
ALIKE, RIVALS = (12, 14.0), (3, 5.0)  # better than the base fit, refined at once, and raced: so many at most, so far in φ behind the best
BEFORE = 3.0  # of φ: how much better


class UnflyableError(Exception):
    """The scenario itself cannot be flown at the prior mean."""


class Search:
    """One diagnosis' hypotheses over one set of landings."""

    def __init__(
        self,
        landings: Landings,
        nuisances: Sequence[Coordinate],
        tolerances: Sequence[Coordinate],
        crew: Crew,
        seed: int = 0,
        told: Told | None = None,
    ) -> None:
        """nuisances: the priors of the data; tolerances: what any model is only known to within a few per cent."""
        self.landings, self.crew, self.seed = landings, crew, seed
        self.nuisances = (*nuisances, *tolerances)
        self.fresh = tuple(range(len(nuisances)))
        """The data's own nuisances: drawn from their priors, and made anew beside second effects; tolerances are neither."""
        self.horizons = (*(h for h in HORIZONS if self._adds(h)), np.inf)
        self.told = told or (lambda stage, best, share: None)
        self.leader = ""
        """The best hypothesis so far, for whoever waits."""
        self.path: Path = ()
        """The best climb of the base scenario."""

    def _adds(self, horizon: float) -> bool:
        below = [c for c in (self._counted(h) for h in (0.0, *HORIZONS)) if c < self._counted(horizon)]
        return self._counted(horizon) < self.landings.size and bool(below) and self._counted(horizon) - max(below) >= FEW

    def _counted(self, horizon: float) -> float:
        return counted(self.landings, horizon)

    def beside(self, effect: Hypothesis) -> Search:
        """The same search with an effect among what is fitted anyway."""
        found, count = copy(self), len(self.nuisances)
        found.nuisances = (*self.nuisances, *effect.coordinates)
        found.fresh = (*self.fresh, *range(count, len(found.nuisances)))
        return found

    # Base

    def base(self) -> Fit:
        """The nuisances fitted to the base scenario, climbing from the best of many draws of their priors."""
        paths = climbed(self.landings, self.nuisances, self.horizons, self._best_draws(), self.run)
        if not paths:
            raise UnflyableError
        self.path = paths[0]
        return self.refine_all([self.path[-1].fit], "base fit")[0]

    def _best_draws(self) -> list[Array]:
        """Draws of the nuisances' priors that the first horizon likes best; tolerances at their means."""
        random = np.random.default_rng(self.seed)
        soft = np.isin(np.arange(len(self.nuisances)), self.fresh)
        drawn = [folded(self.nuisances, np.where(soft, random.standard_normal(len(soft)), 0.0)) for _ in range(DRAWS)]
        draws = [np.zeros(len(soft)), *drawn]
        bases = [base | {name: ROUGH * x for name, x in base.items() if name == STEPPED} for base in self.landings.bases]
        roughly = replace(self.landings, bases=bases)
        tasks = [Timed(roughly, self.nuisances, tuple(draws[i : i + 10]), self.horizons[0]) for i in range(0, len(draws), 10)]
        timed = [one for some in self.run("draws", tasks) for one in some if one is not None]
        if not timed:
            raise UnflyableError
        return [z for _, z in sorted(timed, key=lambda one: one[0])]

    def explained(self) -> int:
        """How many horizons, from the first on, the base scenario explains."""
        for place, (point, fit) in enumerate(self.path):
            if not explains(fit.chi2, self._counted(point.horizon)):
                return place
        return len(self.path)

    # Hypotheses

    def fit_all(self, hypotheses: Sequence[Hypothesis], base: Fit) -> dict[str, Fit]:
        """Every hypothesis' own fit from the base fit, the best refined."""
        here = point_of(base)
        if self.explained() == len(self.path) or explains(base.chi2, self.landings.size):
            return self._refined(self.probed(hypotheses, here, "hypotheses"), base)
        tasks = [self._at(self.landings, h, here, np.zeros(len(h.coordinates))) for h in hypotheses]
        return self._refined(self._best_of([h.name for h in hypotheses], self.run("hypotheses", tasks)), base)

    def explained_by(self, fits: Mapping[str, Fit]) -> bool:
        """Whether any of the fits leaves no more than noise."""
        return any(explains(fit.chi2, self.landings.size) for fit in fits.values())

    def race(self, hypotheses: Sequence[Hypothesis], fits: dict[str, Fit], base: Fit) -> dict[str, Fit]:
        """The fits, those replaced that end better from the horizon on that the base explained last: where none explains the data."""
        explained = self.explained()
        raced = self._raced(hypotheses, explained - 1 if explained > 1 else explained)
        best = self._best_of([h.name for h, _ in raced], [fit for _, fit in raced])
        return self._refined(fits | _better(best, fits), base)

    def probed(self, hypotheses: Sequence[Hypothesis], here: Point, stage: str) -> dict[str, Fit]:
        """From nuisances that explain the data or nearly so, and from beyond what they may have absorbed."""
        tasks = [Probe(self.landings, (*self.nuisances, *h.coordinates), here, tuple(h.scaled_starts())) for h in hypotheses]
        return self._best_of([h.name for h in hypotheses], self.run(stage, tasks))

    def _at(self, landings: Landings, h: Hypothesis, here: Point, own: Array) -> FitAt:
        return FitAt(landings, (*self.nuisances, *h.coordinates), here, np.concatenate([here.z, own]), 5)

    def _best_of(self, names: Sequence[str], fits: Sequence[Fit | None]) -> dict[str, Fit]:
        best: dict[str, Fit] = {}
        for name, fit in zip(names, fits, strict=True):
            if fit is not None and (name not in best or fit.objective < best[name].objective):
                best[name] = fit
        return best

    def refine_best(self, fits: dict[str, Fit]) -> dict[str, Fit]:
        """The finalists with fresh slopes; whoever they overtake is left as it is."""
        ranked = sorted(fits, key=lambda name: -fits[name].log_evidence)
        self.leader = ranked[0]
        top = [n for n in ranked[:FINALISTS] if fits[n].log_evidence > fits[ranked[0]].log_evidence - MARGIN and n != NULL.name]
        return fits | dict(zip(top, self.refine_all([fits[n] for n in top], "finalists"), strict=True))

    def fit_once(self, hypothesis: Hypothesis, base: Fit, stage: str) -> Fit | None:
        """One hypothesis fitted from the base fit and refined; None where it cannot be flown."""
        at_base = self._at(self.landings, hypothesis, point_of(base), np.zeros(len(hypothesis.coordinates)))
        found = [fit for fit in self.run(stage, [at_base]) if fit is not None]
        return self.refine_all(found, stage)[0] if found else None

    def raced_anew(self, fits: dict[str, Fit], hypotheses: Sequence[Hypothesis], base: Fit) -> dict[str, Fit]:
        """The best once more, from the first horizon on, where little holds them fast; unless one leads."""
        near = self._near(fits, base, *RIVALS)
        if len(near) == 1 and fits[near[0]].objective < base.objective - MARGIN:
            return fits
        known = {h.name: h for h in hypotheses}
        found = self._raced([known[n] for n in near], 1) if near else []
        return fits | _better(self._best_of([h.name for h, _ in found], [fit for _, fit in found]), fits)

    def _refined(self, fits: dict[str, Fit], base: Fit) -> dict[str, Fit]:
        """The best of those better than the base fit with slopes of their very points: that is often all they lack."""
        near = self._near(fits, base, *ALIKE)
        return fits | dict(zip(near, self.refine_all([fits[n] for n in near], "finalists"), strict=True))

    def _near(self, fits: Mapping[str, Fit], base: Fit, most: int, behind: float) -> list[str]:
        """Who is worth another look, best first."""
        bound = min(min((fit.objective for fit in fits.values()), default=np.inf) + behind, base.objective - BEFORE)
        return sorted((n for n in fits if fits[n].objective <= bound), key=lambda n: fits[n].objective)[:most]

    def _raced(self, hypotheses: Sequence[Hypothesis], first: int) -> list[tuple[Hypothesis, Fit]]:
        """Over the rungs from `first` to the top, from the rung below."""
        last = self.path[max(first - 1, 0)]
        fits = launched(self.landings, self.nuisances, hypotheses, point_of(last.fit, last.point.horizon), self.run)
        for rung in self.path[first:]:
            fits = raced(self.landings, fits, rung, self.run)
        return fits

    def back_substituted(
        self, fits: dict[str, Fit], hypotheses: Sequence[Hypothesis], names: Sequence[str], winner: str, margin: float = MARGIN
    ) -> dict[str, Fit]:
        """Fits of `names`, those within the margin of the winner, tried again from its nuisances; kept where they are better."""
        point = self.without(fits[winner])
        if point is None:
            return fits
        known = {h.name: h for h in (*hypotheses, NULL)}
        names = [n for n in names if n == NULL.name or fits[n].log_evidence > fits[winner].log_evidence - margin]
        tasks = [self._at(self.landings, known[n], point, fits[n].z[len(point.z) :]) for n in names]
        ends = zip(names, self.run("back-substitution", tasks), strict=True)
        return self.if_better(fits, {n: fit for n, fit in ends if fit is not None}, "back-substitution")

    def if_better(self, fits: dict[str, Fit], found: Mapping[str, Fit], stage: str) -> dict[str, Fit]:
        """The fits with those found that are better once refined; who is hopelessly worse is not."""
        near = {n: fit for n, fit in found.items() if fit.objective < fits[n].objective + MARGIN}
        return fits | _better(dict(zip(near, self.refine_all(list(near.values()), stage), strict=True)), fits)

    def once_more(self, hypotheses: Sequence[Hypothesis], fits: dict[str, Fit], winner: str) -> dict[str, Fit]:
        """All hypotheses probed again from the best one's nuisances, where even that one leaves more than noise.

        A wrong effect that fits in part draws the nuisances out of the minimum in which they hid the right one.
        """
        point = self.without(fits[winner])
        if point is None:
            return fits
        better = _better(self.probed([h for h in hypotheses if h.name != winner], point, "once more"), fits)
        return self.refine_best(fits | better) if better else fits

    def without(self, fit: Fit) -> Point | None:
        """The fit's nuisances without its effect; None where the landings cannot be flown there."""
        count = len(self.nuisances)
        z = fit.z[:count]
        (predicted,) = self.crew.run([Predict(self.landings, self.nuisances, (z,))])[0]
        return None if predicted is None else Point(z, predicted, fit.slopes[:, :count], np.inf)

    def refine_all(self, fits: Sequence[Fit], stage: str) -> list[Fit]:
        """Each taken on until fresh slopes gain nothing more."""
        return list(self.run(stage, [Refine(self.landings, fit) for fit in fits]))

    def run(self, stage: str, tasks: Sequence[Task]) -> list:  # type: ignore[type-arg]
        self.told(stage, self.leader, 0.0)
        return self.crew.run(tasks, lambda done, of: self.told(stage, self.leader, done / of))


def renoised(landings: Landings, fit: Fit) -> Fit:
    """The fit as the landings' present noise sees it."""
    return seen_from(Model(landings, fit.coordinates, Nobody()), fit.z, fit.predicted, fit.slopes)


def _better(found: Mapping[str, Fit | None], fits: dict[str, Fit]) -> dict[str, Fit]:
    """Those that are better by more than what the integrator leaves to chance."""
    return {n: f for n, f in found.items() if f is not None and (n not in fits or f.objective < fits[n].objective - LEAST)}


__all__ = ["Search", "UnflyableError"]
