"""Landings at given points: predictions, slopes, courses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate, nulls
from orchestrator.diagnosis.landing import Course, Lander
from orchestrator.diagnosis.observation import of_units
from orchestrator.diagnosis.problem import Landings, Model

Array = NDArray[np.float64]


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
    standing: int | None = None
    """Of the coordinates: those behind are at their null, and differ from the others' landing by nothing but what they are set to."""

    def __call__(self, lander: Lander) -> Array:
        model = Model(self.landings, self.coordinates, lander, standing=self.standing)
        return model.slopes(self.z, self.predicted, self.which)


def slopes_beside(landings: Landings, coordinates: Sequence[Coordinate], z: Array, predicted: Array, own: Sequence[Coordinate]) -> Slopes:
    """Those of an effect's own coordinates at its null, beside others at a point whose prediction is known."""
    count, every = len(z), np.append(z, nulls(own))
    return Slopes(landings, (*coordinates, *own), every, predicted, tuple(range(count, len(every))), count)


@dataclass(frozen=True)
class Land:
    """The course of one landing at a point, over instants of its own, with the columns asked for."""

    landings: Landings
    coordinates: tuple[Coordinate, ...]
    z: Array
    landing: int
    grid: Array
    columns: tuple[str, ...]
    final: tuple[str, ...]

    def __call__(self, lander: Lander) -> Course | None:
        values = Model(self.landings, self.coordinates, lander).values(self.z, self.landing)
        return lander.land(of_units({**self.landings.bases[self.landing], **values}), self.grid, self.columns, self.final)
