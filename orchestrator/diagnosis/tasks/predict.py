"""Landings at given points: predictions, slopes, courses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
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
    horizon: float = np.inf

    def __call__(self, lander: Lander) -> Array:
        return Model(self.landings, self.coordinates, lander, self.horizon).slopes(self.z, self.predicted, self.which)


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
        return lander.land({**self.landings.bases[self.landing], **of_units(values)}, self.grid, self.columns, self.final)
