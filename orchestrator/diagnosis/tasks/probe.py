"""An effect held where it would stand out, and let go."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.fit import Fit, fitted, gauss_newton_step, objective
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.problem import Landings, Model, Place
from orchestrator.diagnosis.tasks.fits import Point

Array = NDArray[np.float64]
INSENSITIVE = 1.0  # norm of a column: below, the hypothesis cannot be felt where it is null, and must be started elsewhere
FARTHEST = 3.0  # of z
ENERGY = 64.0  # λ, sigma squared, at which a hypothesis is held
FURTHER = 2.5  # times that, where the first try was not hopeless
AS_FORESEEN = 0.7, 1.4  # times the cost that the slopes foresee
HOPELESS = 16.0  # of φ: half of what holding an absent effect costs


@dataclass(frozen=True)
class Probe:
    """A hypothesis fitted from a base fit that explains the data, or nearly: at its null, and from beyond.

    Nuisances that have absorbed an effect sit in a minimum of their own, where the effect's slope may point the wrong way. So the effect is
    HELD at a size at which it would stand out by λ = ENERGY beside the nuisances, these are fitted around it, and then it is let go. If it
    is absent, holding it costs λ/2 of φ; who pays more than HOPELESS is not let go.
    """

    landings: Landings
    coordinates: tuple[Coordinate, ...]
    point: Point
    starts: tuple[tuple[float, ...], ...]
    """z of the own coordinates to try where the hypothesis cannot be felt at its null."""

    def __call__(self, lander: Lander) -> Fit | None:
        count = self.point.slopes.shape[1]
        mine = tuple(range(count, len(self.coordinates)))
        model = Model(self.landings, self.coordinates, lander, self.point.horizon)
        null = np.concatenate([self.point.z, np.zeros(len(mine))])
        slopes = np.column_stack([self.point.slopes, model.slopes(null, self.point.predicted, mine)])
        base = model.place(null)
        first = fitted(model, null, slopes, self.point.predicted, steps=4, beside=base)
        if first is None:
            return None
        jacobian = model.whitened(slopes, self.point.predicted)
        deaf = float(np.linalg.norm(jacobian[:, count:], axis=0).max()) < INSENSITIVE
        found = [first]
        for own in [np.array(s) for s in self.starts] if deaf else self._beyond(jacobian, count):
            for size in (1.0, FURTHER):
                fit = self._let_go(model, base, slopes, np.clip(size * own, *self._limits(count)), first.objective + HOPELESS)
                if fit is None:
                    break
                found.append(fit)
        return min(found, key=lambda fit: fit.objective)

    def _limits(self, count: int) -> tuple[Array, Array]:
        low, high = np.array([c.bounds for c in self.coordinates[count:]]).reshape(-1, 2).T
        return low, high

    def _beyond(self, jacobian: Array, count: int) -> list[Array]:
        """Own z along the most visible direction, at λ = ENERGY; both ways where both are open."""
        nuisances, own = jacobian[:, :count], jacobian[:, count:]
        left = own - nuisances @ np.linalg.solve(nuisances.T @ nuisances + np.eye(count), nuisances.T @ own)
        sizes, directions = np.linalg.eigh(own.T @ left)
        move = directions[:, -1] * min(np.sqrt(ENERGY / max(sizes[-1], 1e-12)), FARTHEST)
        low, high = self._limits(count)
        both = [np.clip(sign * move, low, high) for sign in (1.0, -1.0)]
        return [z for z in both if np.linalg.norm(z) > 0.5 * np.linalg.norm(move)]

    def _let_go(self, model: Model, base: Place, slopes: Array, own: Array, ceiling: float) -> Fit | None:
        """The nuisances fitted around the held effect, then all; None where holding it is hopeless."""
        count = len(self.point.z)
        nuisances, effect = self.coordinates[:count], self.coordinates[count:]
        held = tuple(replace(c, low=c.value(z), high=c.value(z), positive=False) for c, z in zip(effect, own.tolist(), strict=True))
        around = Model(self.landings, (*nuisances, *held), model.lander, self.point.horizon)
        if self._hopeless(around, base, slopes, own, ceiling):
            return None
        z = np.concatenate([self.point.z, own])
        fit = fitted(around, z, slopes, steps=4, beside=base, ceiling=ceiling, renew=range(count))
        if fit is None or fit.objective > ceiling:
            return None
        mine = range(count, len(self.coordinates))
        fresh = np.column_stack([fit.slopes[:, :count], model.slopes(fit.z, fit.predicted, mine)])
        return fitted(model, fit.z, fresh, fit.predicted, steps=4, beside=base)

    def _hopeless(self, around: Model, base: Place, slopes: Array, own: Array, ceiling: float) -> bool:
        """Whether holding the effect costs what the slopes foresee, and that is too much: where they are right, no fit need be flown."""
        count = len(self.point.z)
        jacobian = around.whitened(slopes, self.point.predicted)
        residual = around.residual(self.point.predicted)
        foreseen = residual - jacobian[:, count:] @ own
        move = gauss_newton_step(jacobian[:, :count], foreseen, self.point.z, around.coordinates[:count], 1.0)
        z = np.concatenate([self.point.z + move, own])
        before = objective(residual, np.append(self.point.z, 0.0 * own))
        cost = objective(foreseen - jacobian[:, :count] @ move, z) - before
        if before + cost < ceiling:
            return False
        there = around.predict(z, beside=base)
        if there is None:
            return False
        paid = objective(around.residual(there), z) - before
        return AS_FORESEEN[0] * cost < paid < AS_FORESEEN[1] * cost
