"""Where a search begins: draws of the prior, each at the clock's zero that suits it best, and their first fits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import SHARED, Coordinate, applied
from orchestrator.diagnosis.fit import Fit, fitted
from orchestrator.diagnosis.landing import Course, Lander
from orchestrator.diagnosis.observation import ORIGIN
from orchestrator.diagnosis.problem import Landings, Model
from orchestrator.diagnosis.tasks.fits import Point

Array = NDArray[np.float64]
TIMES = tuple(np.linspace(-3.0, 3.0, 61).tolist())  # of z: zeros of the clock that a course is compared at
LATER = 0.2  # s past the horizon that it is flown for that


@dataclass(frozen=True)
class Timed:
    """What points are worth with threefold noise, each with the time of first contact that suits it best: one course tells of all times.

    Where the data's clock is known to 50 ms only, a zero drawn at random spoils all else that was drawn with it.
    """

    landings: Landings
    coordinates: tuple[Coordinate, ...]
    points: tuple[Array, ...]
    horizon: float

    def __call__(self, lander: Lander) -> list[tuple[float, Array] | None]:
        model = Model(self.landings, self.coordinates, lander, self.horizon)
        return [self._timed(model, z.copy()) for z in self.points]

    def _timed(self, model: Model, z: Array) -> tuple[float, Array] | None:
        """z is changed in place."""
        total = 0.0
        for k in range(len(self.landings.observations)):
            course = model.course(k, z, LATER)
            if course is None:
                return None
            place, values, base = self._clock(k), model.values(z, k), self.landings.bases[k]
            if place is None:
                total += self._missed(model, k, course, [values])[0] / 9.0
                continue
            clock = (self.coordinates[place],)
            dated = [values | applied(base, clock, np.array([time]), k) for time in TIMES]
            missed = self._missed(model, k, course, dated)
            best = int(np.argmin([one / 9.0 + time * time for one, time in zip(missed, TIMES, strict=True)]))
            z[place] = TIMES[best]
            total += missed[best] / 9.0
        return total + float(z @ z), z

    def _missed(self, model: Model, k: int, course: Course, dated: Sequence[Mapping[str, float]]) -> list[float]:
        """χ² of landing k's course under each dating."""
        observation = self.landings.observations[k]
        weights = model.weights[self.landings.parts[k]]
        found = [observation.residual(predicted) * weights for predicted in observation.predicted_dated(course, dated)]
        return [float(missed @ missed) for missed in found]

    def _clock(self, k: int) -> int | None:
        """The coordinate that is this landing's zero of the clock alone."""
        alone = (SHARED, k) if len(self.landings.observations) == 1 else (k,)
        return next((i for i, c in enumerate(self.coordinates) if c.slots[0][0] == ORIGIN and c.landing in alone), None)


@dataclass(frozen=True)
class Start:
    """The nuisances alone fitted to the first horizon from a draw of their prior: with threefold noise, then with their own."""

    landings: Landings
    nuisances: tuple[Coordinate, ...]
    z: Array
    horizon: float

    def __call__(self, lander: Lander) -> tuple[Point, Fit] | None:
        """Where the fit began, with the slopes there, and how it ended."""
        model = Model(self.landings, self.nuisances, lander, self.horizon)
        predicted = model.own(self.z)
        if predicted is None:
            return None
        slopes = model.slopes(self.z, predicted)
        every = tuple(range(len(self.z)))
        began = Point(self.z, predicted, slopes, self.horizon)
        fit = fitted(model, self.z, slopes, predicted, temper=3.0, steps=4, renew=every)
        fit = fit and fitted(model, fit.z, fit.slopes, fit.predicted, steps=8, renew=every, renewals=2)
        return None if fit is None else (began, fit)
