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
from orchestrator.diagnosis.landing import Course, Lander
from orchestrator.diagnosis.observation import Observation, of_units

Array = NDArray[np.float64]
Place = tuple[dict[str, float], ...]
"""Values of each landing."""
ABOUT = (3.0, np.inf)
"""Standard deviations over all rows by which a difference is to be felt, at least and at most: the slope on the whole, for long steps from
far off. What an integrator leaves to chance that chooses its own steps is a twentieth of the least."""
HERE = (1.5, 5.0)
"""The slope at the very point, where a fit is to stand: over 10 σ of mass its column turns by 45 deg."""
BESIDE = (0.02, 2.0)
"""Either, where landings fly beside each other: what their steps leave to chance is a thousandth of the least."""
FELT = ABOUT[0]
TRIED = 0.02  # of z: the first difference tried beside
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

    def __init__(
        self, landings: Landings, coordinates: Sequence[Coordinate], lander: Lander, horizon: float = np.inf, standing: int | None = None
    ) -> None:
        """standing: so many first coordinates alone say beside which landing others are flown; those behind them must be at their null."""
        self.landings, self.coordinates, self.lander, self.horizon = landings, tuple(coordinates), lander, horizon
        self.standing = standing
        self.weights = np.concatenate([o.weights(horizon) for o in landings.observations])

    def place(self, z: Array) -> Place:
        """Where a point's landings are, for others to be flown beside."""
        bases, first = self.landings.bases, self.coordinates[: self.standing]
        return tuple(applied(base, first, z[: self.standing], k) for k, base in enumerate(bases))

    def own(self, z: Array) -> Array | None:
        """`predict` of a point beside which others will be flown."""
        return self.predict(z, beside=self.place(z))

    def predict(self, z: Array, before: tuple[Array, Array] | None = None, beside: Place | None = None) -> Array | None:
        """What all landings would have left; None where one of them cannot be flown.

        before: a point and its prediction; landings that no changed coordinate touches are taken from there.
        beside: landings by whose steps these are flown, where the lander can
        """
        rows = []
        for k, part in enumerate(self.landings.parts):
            if before is not None and not self._touched(k, z, before[0]):
                rows.append(before[1][part])
                continue
            row = self._landed(k, z, beside)
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

    def slope(self, i: int, z: Array, predicted: Array, first: float, felt: tuple[float, float] = ABOUT) -> Array:
        """Derivative of the prediction by z_i, by a difference felt as asked, or of z = WIDEST.

        predicted: at z, flown beside itself where the lander can;  first: the difference to try first
        """
        low, high = self.coordinates[i].bounds
        felt = BESIDE if self.lander.varies else felt
        step, large = first, np.inf
        slope = np.zeros(len(predicted))
        while True:
            sign = -1.0 if z[i] + step > high and z[i] - step >= low else 1.0
            found = self._difference(i, z, predicted, sign * step)
            found = self._difference(i, z, predicted, -sign * step) if found is None and z[i] - step >= low else found
            if found is None:
                return slope
            slope = found
            now = float(np.linalg.norm(self.whitened(slope[:, None], predicted))) * step
            if now > felt[1] and large == np.inf:
                large, step = step, step * 1.5 * felt[0] / now
            elif now >= felt[0] or step >= min(WIDEST, 0.5 * large):
                return slope
            else:
                step = min(WIDEST, 0.5 * large, step * min(8.0, max(2.0, 1.5 * felt[0] / max(now, 1e-9))))

    def _difference(self, i: int, z: Array, predicted: Array, step: float) -> Array | None:
        moved = z.copy()
        moved[i] += step
        there = self.predict(moved, (z, predicted), self.place(z))
        return None if there is None else (there - predicted) / step

    def slopes(
        self, z: Array, predicted: Array, which: Sequence[int] | None = None, like: Array | None = None, felt: tuple[float, float] = ABOUT
    ) -> Array:
        """(n, m): derivatives of the prediction by `which` coordinates, all without.

        like: (n, coordinates) slopes from somewhere near, which tell how large a difference will be felt.
        """
        varies = self.lander.varies
        own = self.own(z) if varies else None
        predicted = predicted if own is None else own
        chosen = range(len(self.coordinates)) if which is None else which
        first = [min(c.step, TRIED) if varies else c.step for c in self.coordinates]
        if like is not None:
            norms = np.linalg.norm(self.whitened(like, predicted), axis=0)
            needed = [min(WIDEST, (5.0 * BESIDE[0] if varies else 1.2 * felt[0]) / max(norm, 1e-9)) for norm in norms.tolist()]
            first = needed if varies or np.isfinite(felt[1]) else [max(s, n) for s, n in zip(first, needed, strict=True)]
        columns = [self.slope(i, z, predicted, first[i], felt) for i in chosen]
        return np.stack(columns, axis=1) if columns else np.zeros((len(predicted), 0))

    def values(self, z: Array, landing: int) -> dict[str, float]:
        return applied(self.landings.bases[landing], self.coordinates, z, landing)

    def _touched(self, landing: int, z: Array, before: Array) -> bool:
        moved = np.flatnonzero(z != before)
        return any(self.coordinates[i].landing in (SHARED, landing) for i in moved)

    def course(self, k: int, z: Array, further: float = 0.0, beside: Place | None = None) -> Course | None:
        """Landing k flown to `further` s past the horizon; None where it cannot be."""
        observation, base = self.landings.observations[k], self.landings.bases[k]
        values = self.values(z, k)
        nominal = beside[k] if beside is not None and self.lander.varies and observation.dated_alike(values, beside[k]) else None
        grid = observation.grid(self.landings.stop[k], values if nominal is None else nominal, self.horizon + further)
        asked = of_units({**base, **values}), grid, observation.columns, observation.final
        course = self.lander.land(*asked) if nominal is None else self.lander.land(*asked, of_units({**base, **nominal}))
        return course if course is not None and all(np.isfinite(c).all() for c in course.columns.values()) else None

    def _landed(self, k: int, z: Array, beside: Place | None) -> Array | None:
        course = self.course(k, z, beside=beside)
        return None if course is None else self.landings.observations[k].predicted(course, self.values(z, k))


class Nobody:
    """A lander for arithmetic that flies nothing."""

    varies = False

    def land(self, *_: object) -> None:
        return None

    def close(self) -> None:
        return None


__all__ = ["Landings", "Model", "Nobody"]
