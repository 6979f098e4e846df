"""What a crew is asked to do: predictions, slopes, and fits. Each is a picklable object that is called with a lander."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.fit import Fit, fitted, refined
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.problem import Landings, Model

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Point:
    """Nuisances with a prediction and its slopes at one horizon: where hypotheses start from."""

    z: Array
    predicted: Array
    slopes: Array
    horizon: float


@dataclass(frozen=True)
class Predict:
    """Predictions at several points."""

    landings: Landings
    coordinates: tuple[Coordinate, ...]
    points: tuple[Array, ...]
    horizon: float = np.inf

    def __call__(self, lander: Lander) -> list[Array | None]:
        model = Model(self.landings, self.coordinates, lander, self.horizon)
        return [model.predict(z) for z in self.points]


@dataclass(frozen=True)
class Slopes:
    """Some columns of the slopes at one point."""

    landings: Landings
    coordinates: tuple[Coordinate, ...]
    z: Array
    predicted: Array
    which: tuple[int, ...]
    horizon: float = np.inf

    def __call__(self, lander: Lander) -> Array:
        return Model(self.landings, self.coordinates, lander, self.horizon).slopes(self.z, self.predicted, self.which)


@dataclass(frozen=True)
class Climb:
    """The nuisances alone, fitted to longer and longer stretches of the landing, slopes made anew at each.

    What happens in the first tenths of a second depends almost linearly on the nuisances; once they are known to that, the next contact
    comes in the right order. A fit to the whole landing at once ends in a false minimum more often than not (docs/diagnosis.md).
    """

    landings: Landings
    nuisances: tuple[Coordinate, ...]
    z: Array
    horizons: tuple[float, ...]
    fresh: tuple[int, ...]
    """Columns worth making anew at every horizon; the others (tolerances) stay put until the last."""

    def __call__(self, lander: Lander) -> list[tuple[Point, Fit]] | None:
        """At each horizon where the fit began (with the slopes there) and how it ended."""
        z, path = self.z, []
        for horizon in self.horizons:
            model = Model(self.landings, self.nuisances, lander, horizon)
            predicted = model.predict(z)
            if predicted is None:
                return None
            slopes = np.zeros((len(predicted), len(z)))
            which = self.fresh if horizon < np.inf else tuple(range(len(z)))
            slopes[:, list(which)] = model.slopes(z, predicted, which)
            first = horizon == self.horizons[0]
            fit = fitted(model, z, slopes, predicted, temper=3.0, steps=4, renew=self.fresh) if first else None
            fit = fitted(model, fit.z, fit.slopes, fit.predicted, renew=self.fresh) if fit else fitted(model, z, slopes, predicted, renew=self.fresh)
            if fit is None:
                return None
            path.append((Point(z, predicted, slopes, horizon), fit))
            z = fit.z
        return path


@dataclass(frozen=True)
class FitAlong:
    """A hypothesis fitted along the base's climb from one of its points: the nuisances' slopes are the climb's, its own are fresh."""

    landings: Landings
    coordinates: tuple[Coordinate, ...]
    """Nuisances, then the hypothesis' own."""
    path: tuple[Point, ...]
    z: Array
    """Of the nuisances, at the first point of the path."""
    own: tuple[float, ...]
    """z of the own coordinates to start at."""
    renewals: int = 1
    fresh: tuple[int, ...] = ()
    """Nuisance columns to make anew where a step gains too little."""

    def __call__(self, lander: Lander) -> Fit | None:
        count = len(self.z)
        mine = tuple(range(count, len(self.coordinates)))
        z = np.concatenate([self.z, np.array(self.own, dtype=np.float64)])
        fit = None
        for point in self.path:
            last = point is self.path[-1]
            model = Model(self.landings, self.coordinates, lander, point.horizon)
            same = not any(self.own) and np.array_equal(z[:count], point.z)
            predicted = point.predicted if same else model.predict(z)
            if predicted is None:
                return None
            slopes = np.column_stack([point.slopes, model.slopes(z, predicted, mine)])
            fit = fitted(model, z, slopes, predicted, steps=6 if last else 3, renew=(*self.fresh, *mine) if last else mine, renewals=self.renewals)
            if fit is None:
                return None
            z = fit.z
        return fit


@dataclass(frozen=True)
class Refine:
    """A fit taken on with the columns `which` made anew."""

    landings: Landings
    fit: Fit
    which: tuple[int, ...]

    def __call__(self, lander: Lander) -> Fit:
        return refined(Model(self.landings, self.fit.coordinates, lander), self.fit, self.which)
