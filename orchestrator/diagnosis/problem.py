"""The least-squares problem of a diagnosis: landings, what may vary, and the residual at a point.

A point z holds one number per coordinate, each with a standard normal prior, so that the objective of every hypothesis is
χ²(z) + z'z and the curvature of the log posterior is J'J + 1, J the Jacobian of the white prediction. Kept are the derivatives of the
prediction itself (slopes), so that a better knowledge of the noise costs no landing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import SHARED, Coordinate, applied
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.observation import Observation, of_units

Array = NDArray[np.float64]
FELT = 3.0  # standard deviations over all rows: six times what the integrator leaves to chance
WIDEST = 0.5  # of z


@dataclass
class Landings:
    """Measured landings of one vehicle, the scenario's values for each, and the lander that flies them."""

    observations: list[Observation]
    bases: list[dict[str, float]]
    stop: list[float]
    """s since first contact to fly each of them."""

    @property
    def size(self) -> int:
        return sum(o.size for o in self.observations)

    @property
    def parts(self) -> list[slice]:
        """Rows of each landing in a residual."""
        ends = np.cumsum([0, *(o.size for o in self.observations)]).tolist()
        return [slice(a, b) for a, b in pairwise(ends)]


class Model:
    """Predictions at points over a set of coordinates, of landings flown to a horizon (s since first contact) or to their end."""

    def __init__(self, landings: Landings, coordinates: Sequence[Coordinate], lander: Lander, horizon: float = np.inf) -> None:
        self.landings, self.coordinates, self.lander, self.horizon = landings, tuple(coordinates), lander, horizon
        self.weights = np.concatenate([o.weights(horizon) for o in landings.observations])

    def predict(self, z: Array, before: tuple[Array, Array] | None = None) -> Array | None:
        """What all landings would have left; None where one of them cannot be flown.

        before: a point and its prediction; landings that no changed coordinate touches are taken from there.
        """
        rows = []
        for k, part in enumerate(self.landings.parts):
            if before is not None and not self._touched(k, z, before[0]):
                rows.append(before[1][part])
                continue
            row = self._landed(k, z)
            if row is None:
                return None
            rows.append(row)
        return np.concatenate(rows)

    def residual(self, predicted: Array) -> Array:
        pairs = zip(self.landings.observations, self.landings.parts, strict=True)
        return np.asarray(np.concatenate([o.residual(predicted[part]) for o, part in pairs]) * self.weights)

    def whitened(self, slopes: Array, predicted: Array) -> Array:
        """J: derivatives of the white prediction, from those of the prediction."""
        pairs = zip(self.landings.observations, self.landings.parts, strict=True)
        return np.asarray(np.concatenate([o.whitened(slopes[part], predicted[part]) for o, part in pairs]) * self.weights[:, None])

    def slope(self, i: int, z: Array, predicted: Array, first: float) -> Array:
        """Derivative of the prediction by z_i, by a difference that is felt: by FELT standard deviations in all, or z = WIDEST.

        first: the difference to try first.
        """
        low, high = self.coordinates[i].bounds
        step = first
        slope = np.zeros(len(predicted))
        while True:
            sign = -1.0 if z[i] + step > high and z[i] - step >= low else 1.0
            found = self._difference(i, z, predicted, sign * step)
            found = self._difference(i, z, predicted, -sign * step) if found is None and z[i] - step >= low else found
            if found is None:
                return slope
            slope = found
            felt = float(np.linalg.norm(self.whitened(slope[:, None], predicted))) * step
            if felt >= FELT or step >= WIDEST:
                return slope
            step = min(WIDEST, step * min(8.0, max(2.0, 1.5 * FELT / max(felt, 1e-9))))

    def _difference(self, i: int, z: Array, predicted: Array, step: float) -> Array | None:
        moved = z.copy()
        moved[i] += step
        there = self.predict(moved, (z, predicted))
        return None if there is None else (there - predicted) / step

    def slopes(self, z: Array, predicted: Array, which: Sequence[int] | None = None, like: Array | None = None) -> Array:
        """(n, m): derivatives of the prediction by `which` coordinates, all without.

        like: (n, coordinates) slopes from somewhere near, which tell how large a difference will be felt.
        """
        chosen = range(len(self.coordinates)) if which is None else which
        first = [c.step for c in self.coordinates]
        if like is not None:
            felt = np.linalg.norm(self.whitened(like, predicted), axis=0)
            first = [max(s, min(WIDEST, 1.2 * FELT / max(f, 1e-9))) for s, f in zip(first, felt.tolist(), strict=True)]
        columns = [self.slope(i, z, predicted, first[i]) for i in chosen]
        return np.stack(columns, axis=1) if columns else np.zeros((len(predicted), 0))

    def values(self, z: Array, landing: int) -> dict[str, float]:
        return applied(self.landings.bases[landing], self.coordinates, z, landing)

    def _touched(self, landing: int, z: Array, before: Array) -> bool:
        moved = np.flatnonzero(z != before)
        return any(self.coordinates[i].landing in (SHARED, landing) for i in moved)

    def _landed(self, k: int, z: Array) -> Array | None:
        observation = self.landings.observations[k]
        values = self.values(z, k)
        grid = observation.grid(self.landings.stop[k], values, self.horizon)
        course = self.lander.land({**self.landings.bases[k], **of_units(values)}, grid, observation.columns, observation.final)
        if course is None or not all(np.isfinite(c).all() for c in course.columns.values()):
            return None
        return observation.predicted(course, values)


class Nobody:
    """A lander for arithmetic that flies nothing."""

    def land(self, *_: object) -> None:
        return None

    def close(self) -> None:
        return None


__all__ = ["Landings", "Model", "Nobody"]
