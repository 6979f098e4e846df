"""From one horizon to the next: draws of a fit's posterior, judged by the further horizon."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import clipped, folded
from orchestrator.diagnosis.fit import Fit, fitted, objective
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.problem import Landings, Model
from orchestrator.diagnosis.tasks.fits import Point

Array = NDArray[np.float64]
LOOSE = 1.0  # squared posterior standard deviations: what chance and kinks leave of a draw's prediction
TAILS = 3.0  # degrees of freedom of draws: over a kink the posterior is wider than Laplace's approximation of it


@dataclass(frozen=True)
class Draw:
    """The best of draws of a fit's posterior, judged by a horizon further than its own; the fit itself is among them.

    Each contact between the two horizons may come in another order; the fit's own minimum leads to one of them, often a wrong one.
    """

    landings: Landings
    fit: Fit
    horizon: float
    count: int
    best: int
    slopes: Array | None = None
    """Of the first coordinates at that horizon, from somewhere near; made anew without. The draws correct them."""
    seed: int = 0

    def __call__(self, lander: Lander) -> list[Point]:
        """Points with the slopes that the draws tell of, best first."""
        coordinates, z = self.fit.coordinates, self.fit.z
        model = Model(self.landings, coordinates, lander, self.horizon)
        spread = np.asarray(np.linalg.cholesky(self.fit.covariance), dtype=np.float64)
        generator = np.random.default_rng(self.seed)
        tails = np.sqrt(TAILS / generator.chisquare(TAILS, (self.count, 1)))
        random = tails * generator.standard_normal((self.count, len(z)))
        around = model.place(z)
        found: list[tuple[float, Array, Array]] = []
        for draw in (np.zeros(len(z)), *random):
            there = clipped(coordinates, folded(coordinates, z + spread @ draw))
            predicted = model.predict(there, beside=around)
            if predicted is not None:
                found.append((objective(model.residual(predicted), there), there, predicted))
        if not found:
            return []
        found.sort(key=lambda one: one[0])
        slopes = np.zeros((len(found[0][2]), len(z)))
        if self.slopes is None:
            slopes[:] = model.slopes(found[0][1], found[0][2], like=self.fit.slopes)
        else:
            slopes[:, : self.slopes.shape[1]] = self.slopes
        best = found[: self.best]
        return [Point(there, predicted, _told(slopes, found, there, predicted, spread), self.horizon) for _, there, predicted in best]


def _told(slopes: Array, found: Sequence[tuple[float, Array, Array]], z: Array, predicted: Array, spread: Array) -> Array:
    """The slopes changed as little as the draws' predictions allow, in the posterior's own measure."""
    moves = np.stack([there - z for _, there, _ in found], axis=1)
    missed = np.stack([there for _, _, there in found], axis=1) - predicted[:, None] - slopes @ moves
    own = np.linalg.solve(spread, moves)
    gain = np.linalg.solve(own.T @ own + LOOSE * np.eye(len(found)), own.T)
    return np.asarray(slopes + missed @ gain @ np.linalg.inv(spread))


@dataclass(frozen=True)
class Leap:
    """A hypothesis taken from its fit to one horizon to fits to the next, from the best of draws."""

    draw: Draw
    own: int
    """Coordinates of the hypothesis, the last ones: their slopes are made anew."""
    steps: int

    def __call__(self, lander: Lander) -> list[Fit]:
        fit = self.draw.fit
        model = Model(self.draw.landings, fit.coordinates, lander, self.draw.horizon)
        mine = range(len(fit.z) - self.own, len(fit.z))
        fits = []
        for point in self.draw(lander):
            slopes = point.slopes.copy()
            slopes[:, list(mine)] = model.slopes(point.z, point.predicted, mine, slopes)
            fits.append(fitted(model, point.z, slopes, point.predicted, steps=self.steps, renew=tuple(mine)))
        return [fit for fit in fits if fit is not None]
