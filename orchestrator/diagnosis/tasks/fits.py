"""Fits from a point whose prediction and slopes are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate, nulls
from orchestrator.diagnosis.fit import Fit, fitted, refined, seen_from
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


def point_of(fit: Fit, horizon: float = np.inf) -> Point:
    """Where a fit ended, for others to start from."""
    return Point(fit.z, fit.predicted, fit.slopes, horizon)


@dataclass(frozen=True)
class Climb:
    """A fit to a horizon from a point of it; slopes made anew, once, where the point's prove poor."""

    landings: Landings
    coordinates: tuple[Coordinate, ...]
    point: Point

    def __call__(self, lander: Lander) -> Fit | None:
        model = Model(self.landings, self.coordinates, lander, self.point.horizon)
        return fitted(model, self.point.z, self.point.slopes, self.point.predicted, steps=8, renew=range(len(self.point.z)))


@dataclass(frozen=True)
class FitAt:
    """A hypothesis fitted at one horizon from a point of the base's climb: the nuisances' slopes are the climb's, its own are fresh."""

    landings: Landings
    coordinates: tuple[Coordinate, ...]
    """Nuisances, then the hypothesis' own."""
    point: Point
    z: Array
    """Of all coordinates, where to start."""
    steps: int = 3
    fresh: tuple[int, ...] = ()
    """Nuisance columns to make anew, once, where a step gains too little."""

    def __call__(self, lander: Lander) -> Fit | None:
        count = self.point.slopes.shape[1]
        mine = tuple(range(count, len(self.coordinates)))
        model = Model(self.landings, self.coordinates, lander, self.point.horizon)
        same = np.array_equal(self.z, np.append(self.point.z, nulls(self.coordinates[count:])))
        predicted = self.point.predicted if same else model.own(self.z)
        if predicted is None:
            return None
        slopes = np.column_stack([self.point.slopes, model.slopes(self.z, predicted, mine)])
        return fitted(model, self.z, slopes, predicted, steps=self.steps, renew=(*self.fresh, *mine))


@dataclass(frozen=True)
class Refine:
    """A fit by landings of its own, taken on with slopes of its very point."""

    landings: Landings
    fit: Fit

    def __call__(self, lander: Lander) -> Fit:
        model = Model(self.landings, self.fit.coordinates, lander)
        predicted = model.own(self.fit.z)
        if predicted is None:
            return self.fit
        return refined(model, seen_from(model, self.fit.z, predicted, self.fit.slopes))
