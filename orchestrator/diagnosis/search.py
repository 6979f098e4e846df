"""The search: nuisances fitted to the base scenario, then every hypothesis fitted in its own right, the best of them refined.

Order and reasons stand in docs/diagnosis.md. The landings are flown by a crew; this file decides which.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Crew, Task
from orchestrator.diagnosis.fit import Fit, seen_from
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis, joined
from orchestrator.diagnosis.problem import Landings, Model
from orchestrator.diagnosis.tasks import Climb, FitAt, Point, Predict, Probe, Refine, Slopes

Array = NDArray[np.float64]
Told = Callable[[str, str, float], None]
"""Called with the stage, the best hypothesis so far, and the share of the stage done."""
HORIZONS = (0.3, 0.55, 0.8, 1.2)  # s since first contact, before the whole
DRAWS = 100  # of the nuisances from their priors, flown to the first horizon
CLIMBS = 2  # from the best of them
FEW = 12  # samples that a horizon must add to be worth a fit
MARGIN = 15.0  # in ln evidence: who is further behind the best is not refined
FINALISTS = 5
SECONDS = 6  # second effects fitted beside a first
PRUNE = 25.0  # of φ at a horizon: who is further behind the best is not flown on
LEAST = 6  # hypotheses that are flown on all the same
ALIKE = 8.0  # of φ: two starts of one hypothesis are both flown on within this


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
        """Columns made anew along the way; those of the tolerances are made at the whole landing, once."""
        self.horizons = (*(h for h in HORIZONS if self._adds(h)), np.inf)
        self.told = told or (lambda stage, best, share: None)
        self.leader = ""
        """The best hypothesis so far, for whoever waits."""
        self.path: tuple[Point, ...] = ()
        self.ends: tuple[Fit, ...] = ()

    def _adds(self, horizon: float) -> bool:
        counts = sorted(sum(float(o.weights(h).sum()) for o in self.landings.observations) for h in (0.0, *HORIZONS))
        here = sum(float(o.weights(horizon).sum()) for o in self.landings.observations)
        below = [c for c in counts if c < here]
        return here < self.landings.size and bool(below) and here - max(below) >= FEW

    # Base

    def base(self) -> Fit:
        """The nuisances fitted to the base scenario, climbing from the best of many draws of their priors."""
        climbs = [Climb(self.landings, self.nuisances, z, self.horizons, self.fresh) for z in self._best_draws()]
        paths = [path for path in self._run("base fit", climbs) if path]
        if not paths:
            raise UnflyableError
        best = min(paths, key=lambda path: path[-1][1].objective)
        self.path, self.ends = tuple(point for point, _ in best), tuple(fit for _, fit in best)
        return self.refine_all([self.ends[-1]], "base fit", everything=True)[0]

    def _best_draws(self) -> list[Array]:
        random = np.random.default_rng(self.seed)
        soft = np.isin(np.arange(len(self.nuisances)), self.fresh)
        draws = [np.zeros(len(soft)), *(np.where(soft, random.standard_normal(len(soft)), 0.0) for _ in range(DRAWS))]
        first = self.horizons[0]
        tasks = [Predict(self.landings, self.nuisances, tuple(draws[i : i + 10]), first) for i in range(0, len(draws), 10)]
        rows = [row for some in self._run("draws", tasks) for row in some]
        model = Model(self.landings, self.nuisances, Nobody(), first)
        worth = np.array(
            [
                np.inf if row is None else float(np.square(model.residual(row)).sum()) / 9.0 + float(z @ z)
                for z, row in zip(draws, rows, strict=True)
            ]
        )
        if not np.isfinite(worth).any():
            raise UnflyableError
        return [draws[i] for i in np.argsort(worth)[:CLIMBS] if np.isfinite(worth[i])]

    def launch(self) -> int:
        """Place in the path of the last horizon that the base scenario still explains (chi-square within three standard deviations)."""
        explained = 0
        for place, fit in enumerate(self.ends):
            if not explains(fit.chi2, float(Model(self.landings, self.nuisances, Nobody(), self.path[place].horizon).weights.sum())):
                break
            explained = place
        return explained

    # Hypotheses

    def fit_all(self, hypotheses: Sequence[Hypothesis], base: Fit) -> dict[str, Fit]:
        """Every hypothesis' own fit: from where the base scenario stops explaining the data, horizon by horizon, and from the base fit.

        At each horizon a hypothesis is left behind when its best objective is PRUNE worse than the best one's: φ at the optimum only
        grows with the horizon, so whoever explains the rest no better than noise can no longer be caught.
        """
        here = Point(base.z, base.predicted, base.slopes, np.inf)
        launch = self.launch()
        if launch == len(self.path) - 1 or explains(base.chi2, self.landings.size):
            return self._fit_close(hypotheses, here)
        early = self.path[launch].z
        runners = [
            (h, np.concatenate([early, own]))
            for h in hypotheses
            for own in [np.zeros(len(h.coordinates)), *map(np.array, h.scaled_starts())]
        ]
        for place in range(launch, len(self.path) - 1):
            runners = self._ran(runners, self.path[place], steps=8)
        last = [(h, z) for h, z in runners] + [(h, np.concatenate([base.z, z[len(base.z) :]])) for h, z in runners[:FINALISTS]]
        tasks = [FitAt(self.landings, (*self.nuisances, *h.coordinates), here, z, 6, self.fresh) for h, z in last]
        best = self._best_of([h.name for h, _ in last], self._run("hypotheses", tasks))
        left = [h for h in hypotheses if h.name not in best]
        best |= self._best_of(
            [h.name for h in left], self._run("hypotheses", [self._at(h, here, np.zeros(len(h.coordinates))) for h in left])
        )
        return best

    def _ran(self, runners: list[tuple[Hypothesis, Array]], point: Point, steps: int) -> list[tuple[Hypothesis, Array]]:
        """Who is still in the race after one horizon, best first, one or two starts of each."""
        tasks = [FitAt(self.landings, (*self.nuisances, *h.coordinates), point, z, steps, self.fresh) for h, z in runners]
        fits = self._run(f"hypotheses to {point.horizon:g} s", tasks)
        ended = sorted(((fit.objective, i) for i, fit in enumerate(fits) if fit is not None), key=lambda pair: pair[0])
        kept: list[tuple[Hypothesis, Array]] = []
        seen: dict[str, list[float]] = {}
        for objective, i in ended:
            others = seen.setdefault(runners[i][0].name, [])
            behind = objective > ended[0][0] + PRUNE and len(seen) > LEAST
            if behind or len(others) == 2 or (others and (objective > others[0] + ALIKE or objective < others[0] + 0.05)):
                continue
            others.append(objective)
            kept.append((runners[i][0], fits[i].z))
        return kept

    def _fit_close(self, hypotheses: Sequence[Hypothesis], here: Point) -> dict[str, Fit]:
        """From the base fit, which explains the data or nearly so, and from beyond what the nuisances may have absorbed."""
        tasks = [Probe(self.landings, (*self.nuisances, *h.coordinates), here, tuple(h.scaled_starts())) for h in hypotheses]
        return self._best_of([h.name for h in hypotheses], self._run("hypotheses", tasks))

    def _at(self, h: Hypothesis, here: Point, own: Array) -> FitAt:
        return FitAt(self.landings, (*self.nuisances, *h.coordinates), here, np.concatenate([here.z, own]), 5)

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

    def back_substituted(self, fits: dict[str, Fit], hypotheses: Sequence[Hypothesis], names: Sequence[str], winner: str) -> dict[str, Fit]:
        """Fits of `names` tried again from the winner's nuisances; kept where they are better."""
        count = len(self.nuisances)
        z = fits[winner].z[:count]
        (predicted,) = self.crew.run([Predict(self.landings, self.nuisances, (z,))])[0]
        if predicted is None:
            return fits
        point = Point(z, predicted, fits[winner].slopes[:, :count], np.inf)
        known = {h.name: h for h in (*hypotheses, NULL)}
        tasks = [self._at(known[n], point, fits[n].z[count:]) for n in names]
        better = {}
        for name, fit in zip(names, self._run("back-substitution", tasks), strict=True):
            if fit is not None and fit.objective < fits[name].objective - 0.5:
                better[name] = fit
        return fits | dict(zip(better, self.refine_all(list(better.values()), "back-substitution"), strict=True))

    def once_more(self, hypotheses: Sequence[Hypothesis], fits: dict[str, Fit], winner: str) -> dict[str, Fit]:
        """All hypotheses probed again from the best one's nuisances, where even that one leaves more than noise.

        A wrong effect that fits in part draws the nuisances out of the minimum in which they hid the right one.
        """
        count = len(self.nuisances)
        z = fits[winner].z[:count]
        (predicted,) = self.crew.run([Predict(self.landings, self.nuisances, (z,))])[0]
        if predicted is None:
            return fits
        point = Point(z, predicted, fits[winner].slopes[:, :count], np.inf)
        again = [h for h in hypotheses if h.name != winner]
        tasks = [Probe(self.landings, (*self.nuisances, *h.coordinates), point, tuple(h.scaled_starts())) for h in again]
        found = self._best_of([h.name for h in again], self._run("once more", tasks))
        better = {n: fit for n, fit in found.items() if n not in fits or fit.objective < fits[n].objective - 0.5}
        return self.refine_best(fits | better) if better else fits

    def fit_seconds(self, first: Hypothesis, fit: Fit, hypotheses: Sequence[Hypothesis]) -> dict[str, tuple[Hypothesis, Fit]]:
        """Pairs with a first effect: every second one judged by its slopes at the first one's fit, the best of them fitted."""
        others = [h for h in hypotheses if h.name != first.name and not slots_of(h) & slots_of(first)]
        model = [Model(self.landings, (*fit.coordinates, *h.coordinates), Nobody()) for h in others]
        count = len(fit.z)
        asks = [
            Slopes(
                self.landings,
                m.coordinates,
                np.concatenate([fit.z, np.zeros(len(h.coordinates))]),
                fit.predicted,
                tuple(range(count, count + len(h.coordinates))),
            )
            for m, h in zip(model, others, strict=True)
        ]
        linear = {}
        for h, m, own in zip(others, model, self._run("second effects", asks), strict=True):
            z = np.concatenate([fit.z, np.zeros(len(h.coordinates))])
            linear[h.name] = (promised(m, z, fit.predicted, np.column_stack([fit.slopes, own])), h)
        best = sorted(linear.values(), key=lambda pair: -pair[0])[:SECONDS]
        best = [pair for pair in best if pair[0] > fit.log_evidence + 1.0]
        here = Point(fit.z, fit.predicted, fit.slopes, np.inf)
        tasks = [
            FitAt(
                self.landings,
                (*fit.coordinates, *h.coordinates),
                here,
                np.concatenate([fit.z, np.zeros(len(h.coordinates))]),
                5,
                self.fresh,
            )
            for _, h in best
        ]
        found = {}
        for (_, h), pair in zip(best, self._run("second effects", tasks), strict=True):
            if pair is not None:
                both = joined(first, h)
                found[both.name] = (both, pair)
        top = sorted(found, key=lambda n: -found[n][1].log_evidence)[:2]
        for n, again in zip(top, self.refine_all([found[n][1] for n in top], "second effects"), strict=True):
            found[n] = (found[n][0], again)
        return found

    def refine_all(self, fits: Sequence[Fit], stage: str, everything: bool = False) -> list[Fit]:
        """Fresh slopes of the nuisances and of the hypothesis' own; of the tolerances too with `everything`."""
        tasks = []
        for fit in fits:
            own = range(len(self.nuisances), len(fit.z))
            tasks.append(Refine(self.landings, fit, tuple(range(len(fit.z))) if everything else (*self.fresh, *own)))
        return list(self._run(stage, tasks))

    def renoised(self, fit: Fit) -> Fit:
        """The fit as the landings' present noise sees it."""
        return seen_from(Model(self.landings, fit.coordinates, Nobody()), fit.z, fit.predicted, fit.slopes)

    def _run(self, stage: str, tasks: Sequence[Task]) -> list:  # type: ignore[type-arg]
        self.told(stage, self.leader, 0.0)
        return self.crew.run(tasks, lambda done, of: self.told(stage, self.leader, done / of))


def explains(chi2: float, count: float) -> bool:
    """Whether a chi-square over so many rows is within three standard deviations of noise."""
    return chi2 <= count + 3.0 * float(np.sqrt(2.0 * count))


def promised(model: Model, z: Array, predicted: Array, slopes: Array) -> float:
    """ln evidence at the optimum that the slopes promise."""
    residual, jacobian = model.residual(predicted), model.whitened(slopes, predicted)
    hessian = jacobian.T @ jacobian + np.eye(len(z))
    slope = jacobian.T @ residual - z
    step = np.linalg.solve(hessian, slope)
    return float(-0.5 * (residual @ residual + z @ z) + 0.5 * slope @ step - 0.5 * np.linalg.slogdet(hessian)[1])


def slots_of(h: Hypothesis) -> set[str]:
    """What a hypothesis moves."""
    return {name for c in h.coordinates for name, _ in c.slots}


class Nobody:
    """A lander for arithmetic that flies nothing."""

    def land(self, *_: object) -> None:
        return None

    def close(self) -> None:
        return None


__all__ = ["Search", "UnflyableError"]
