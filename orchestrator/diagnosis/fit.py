"""Gauss-Newton on the posterior of a model's coordinates, sparing of landings.

Minimises φ(z) = χ²(z)/(2 T²) + z'z/2. The slopes are made by differences once and then kept up to date by Broyden's rank-one formula,
which costs no landing; they are made anew where a step gains much less than they promise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr

from orchestrator.diagnosis.coordinates import Coordinate, clipped
from orchestrator.diagnosis.problem import FELT, HERE, Model, Place

Array = NDArray[np.float64]
REACH = 2.5  # of one step in any z
ENOUGH = 0.3  # of φ: a step that promises less is lost in what the integrator leaves to chance; Laplace credits it unflown
TRIES = 3  # of a step, each 0.35 times the last
CHANCE = 2.0  # of φ: what the integrator may hide of a step
AGAIN, GAIN = 4, 1.0  # refinements of a fit at most, and of φ that one must bring to be followed by another
POOR = 0.3  # of what was promised: the slopes are no longer those of this place
HOPE = 2.5  # times what the slopes promise of a step: what a fit may still gain that is to come below a ceiling


@dataclass
class Fit:
    """A hypothesis at its best point."""

    coordinates: tuple[Coordinate, ...]
    z: Array
    predicted: Array
    residual: Array
    slopes: Array
    """(n, m): derivatives of the prediction by z."""
    jacobian: Array
    """(n, m): those of the white prediction."""
    log_evidence: float

    @property
    def chi2(self) -> float:
        return float(self.residual @ self.residual)

    @property
    def objective(self) -> float:
        return objective(self.residual, self.z)

    @property
    def covariance(self) -> Array:
        """Of z, by Laplace."""
        return np.asarray(np.linalg.inv(self.jacobian.T @ self.jacobian + np.eye(len(self.z))))

    def estimate(self, place: int) -> tuple[float, float]:
        """p and its standard deviation."""
        c = self.coordinates[place]
        return c.value(float(self.z[place])), c.sigma * float(np.sqrt(self.covariance[place, place]))


def gauss_newton_step(jacobian: Array, residual: Array, z: Array, coordinates: Sequence[Coordinate], temper: float) -> Array:
    """The step of φ's quadratic model, within REACH and the coordinates' limits."""
    low, high = np.array([c.bounds for c in coordinates]).reshape(-1, 2).T
    hessian = jacobian.T @ jacobian / temper**2 + np.eye(len(z))
    slope = jacobian.T @ residual / temper**2 - z
    free = np.ones(len(z), dtype=bool)
    step = np.zeros(len(z))
    for _ in range(4):
        step[:] = 0.0
        step[free] = np.linalg.solve(hessian[np.ix_(free, free)], slope[free])
        stuck = free & (((z <= low) & (step < 0.0)) | ((z >= high) & (step > 0.0)))
        if not stuck.any():
            break
        free &= ~stuck
    largest = float(np.abs(step).max(initial=0.0))
    step *= min(1.0, REACH / largest) if largest > 0.0 else 1.0
    return np.asarray(np.clip(z + step, low, high) - z)


def log_evidence(coordinates: Sequence[Coordinate], z: Array, residual: Array, jacobian: Array) -> float:
    """Laplace: ln ∫ exp(-φ) over the prior, less the constant that all hypotheses share.

    What the quadratic model still promises is credited up to ENOUGH, no more: it was not flown. A half-normal prior counts with
    2 exp(u²/2) Φ(u), u the distance of the limit z = 0 in standard deviations (negative where the optimum lies beyond it).
    """
    hessian = jacobian.T @ jacobian + np.eye(len(z))
    slope = jacobian.T @ residual - z
    positive = np.array([c.positive for c in coordinates], dtype=bool)
    stuck = positive & (z <= 1e-9) & (slope < 0.0)
    free = ~stuck
    promise = 0.5 * float(slope[free] @ np.linalg.solve(hessian[np.ix_(free, free)], slope[free])) if free.any() else 0.0
    total = -0.5 * float(residual @ residual + z @ z) + min(promise, ENOUGH) - 0.5 * float(np.linalg.slogdet(hessian)[1])
    spread = np.sqrt(np.diag(np.linalg.inv(hessian)))
    for i in np.flatnonzero(positive):
        u = float(slope[i] * spread[i] if stuck[i] else z[i] / spread[i])
        total += np.log(2.0) + float(log_ndtr(u)) + (0.5 * u * u if stuck[i] else 0.0)
    return total


def broyden(slopes: Array, move: Array, change: Array) -> None:
    """S += (Δ - S s) s'/s's, in place; change: of the prediction over the move s."""
    size = float(move @ move)
    if size > 1e-12:
        slopes += np.outer(change - slopes @ move, move) / size


def seen_from(model: Model, z: Array, predicted: Array, slopes: Array) -> Fit:
    """A fit at a point, as the present noise of the landings sees it."""
    residual, jacobian = model.residual(predicted), model.whitened(slopes, predicted)
    return Fit(model.coordinates, z, predicted, residual, slopes, jacobian, log_evidence(model.coordinates, z, residual, jacobian))


def fitted(
    model: Model,
    z: Array,
    slopes: Array,
    predicted: Array | None = None,
    *,
    temper: float = 1.0,
    steps: int = 6,
    renew: Sequence[int] = (),
    renewals: int = 1,
    beside: Place | None = None,
    ceiling: float = np.inf,
) -> Fit | None:
    """The model fitted from z with slopes made there or near; None where nothing there can be flown, or all hope is gone.

    renew     columns to make anew where the slopes prove poor, at most `renewals` times
    predicted at z; flown beside what `beside` says, where that is given
    beside    where all is flown beside; the start, without
    ceiling   of φ: who after a first step is further above it than the slopes let hope for is given up
    """
    z, alone = clipped(model.coordinates, z), beside is None
    beside = model.place(z) if beside is None else beside
    predicted = model.predict(z, beside=beside) if predicted is None or (alone and model.lander.varies) else predicted
    if predicted is None:
        return None
    slopes, residual = slopes.copy(), model.residual(predicted)
    for k in range(steps):
        jacobian = model.whitened(slopes, predicted)
        step = gauss_newton_step(jacobian, residual, z, model.coordinates, temper)
        now = objective(residual, z, temper)
        promised = now - objective(residual - jacobian @ step, z + step, temper)
        if promised < ENOUGH:
            break
        if k > 0 and now - HOPE * promised > ceiling:
            return None
        made = _made(model, beside, z, predicted, residual, slopes, step, temper, promised)
        gained = 0.0
        if made is not None:
            gained = now - objective(made[2], made[0], temper)
            z, predicted, residual = made
        if gained < POOR * promised:
            if made is None and promised < CHANCE:
                break
            if renewals == 0 or not renew:
                if made is None:
                    break
                continue
            renewals -= 1
            slopes[:, list(renew)] = model.slopes(z, predicted, renew, slopes)
            beside = model.place(z)
            again = model.own(z) if model.lander.varies else None
            if again is not None:
                predicted, residual = again, model.residual(again)
    return seen_from(model, z, predicted, slopes)


def _made(
    model: Model, beside: Place, z: Array, predicted: Array, before: Array, slopes: Array, step: Array, temper: float, promised: float
) -> tuple[Array, Array, Array] | None:
    """The step, or a part of it, that lowers φ: point, prediction, residual. What was flown teaches the slopes; before: the residual."""
    now = objective(before, z, temper)
    for _ in range(TRIES if promised > CHANCE else 1):
        there = model.predict(z + step, beside=beside)
        if there is not None:
            residual = model.residual(there)
            if model.lander.varies or float(np.linalg.norm(residual - before)) > FELT:  # a smaller change is mostly the integrator's
                broyden(slopes, step, there - predicted)
            if objective(residual, z + step, temper) < now:
                return z + step, there, residual
        step = 0.35 * step
    return None


def refined(model: Model, fit: Fit, steps: int = 4) -> Fit:
    """The fit with all slopes made anew at its very point, taken on from there, and again as long as that gains."""
    for _ in range(AGAIN):
        slopes = model.slopes(fit.z, fit.predicted, like=fit.slopes, felt=HERE)
        here = seen_from(model, fit.z, fit.predicted, slopes)
        found = fitted(model, fit.z, slopes, fit.predicted, steps=steps)
        found = here if found is None else settled(model, found)
        before, fit = here, min(here, found, key=attrgetter("objective"))
        if before.objective - fit.objective < GAIN:
            break
    return fit


def settled(model: Model, fit: Fit) -> Fit:
    """The fit by a landing on its own, beside which others may then be flown."""
    predicted = model.own(fit.z) if model.lander.varies else None
    return fit if predicted is None else seen_from(model, fit.z, predicted, fit.slopes)


def objective(residual: Array, z: Array, temper: float = 1.0) -> float:
    """φ of a white residual and a point."""
    return 0.5 * float(residual @ residual) / temper**2 + 0.5 * float(z @ z)


__all__ = ["Fit", "fitted", "objective", "refined", "seen_from"]
