"""What a crew is asked to do: predictions, slopes, and fits. Each is a picklable object that is called with a lander."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.fit import Fit, fitted, refined
from orchestrator.diagnosis.landing import Course, Lander
from orchestrator.diagnosis.observation import of_units
from orchestrator.diagnosis.problem import Landings, Model

Array = NDArray[np.float64]
INSENSITIVE = 1.0  # norm of a column: below, the hypothesis cannot be felt where it is null, and must be started elsewhere
FARTHEST = 3.0  # of z
ENERGY = 64.0  # λ, sigma squared, at which a hypothesis is held
FURTHER = 2.5  # times that, where the first try was not hopeless
HOPELESS = 16.0  # of φ: half of what holding an absent effect costs


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
    """The nuisances alone fitted to one horizon, slopes made anew at its beginning and where they prove poor."""

    landings: Landings
    nuisances: tuple[Coordinate, ...]
    z: Array
    horizon: float
    gently: bool = False
    """With threefold noise first: from a draw of the prior, not from where a shorter horizon ended."""

    def __call__(self, lander: Lander) -> tuple[Point, Fit] | None:
        """Where the fit began, with the slopes there, and how it ended."""
        model = Model(self.landings, self.nuisances, lander, self.horizon)
        predicted = model.predict(self.z)
        if predicted is None:
            return None
        slopes = model.slopes(self.z, predicted)
        every = tuple(range(len(self.z)))
        began = Point(self.z, predicted, slopes, self.horizon)
        fit: Fit | None = None
        if self.gently:
            fit = fitted(model, self.z, slopes, predicted, temper=3.0, steps=4, renew=every)
        z, slopes, predicted = (fit.z, fit.slopes, fit.predicted) if fit else (self.z, slopes, predicted)
        fit = fitted(model, z, slopes, predicted, steps=8, renew=every, renewals=2)
        return None if fit is None else (began, fit)


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
        same = np.array_equal(self.z[:count], self.point.z) and not self.z[count:].any()
        predicted = self.point.predicted if same else model.predict(self.z)
        if predicted is None:
            return None
        slopes = np.column_stack([self.point.slopes, model.slopes(self.z, predicted, mine)])
        return fitted(model, self.z, slopes, predicted, steps=self.steps, renew=(*self.fresh, *mine))


@dataclass(frozen=True)
class GoOn:
    """A fit taken on at its horizon; the columns `renew` are made anew, once, where a step gains too little."""

    landings: Landings
    fit: Fit
    horizon: float
    renew: tuple[int, ...]

    def __call__(self, lander: Lander) -> Fit | None:
        model = Model(self.landings, self.fit.coordinates, lander, self.horizon)
        return fitted(model, self.fit.z, self.fit.slopes, self.fit.predicted, steps=8, renew=self.renew)


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
        first = fitted(model, null, slopes, self.point.predicted, steps=4)
        if first is None:
            return None
        jacobian = model.whitened(slopes, self.point.predicted)
        deaf = float(np.linalg.norm(jacobian[:, count:], axis=0).max()) < INSENSITIVE
        found = [first]
        for own in [np.array(s) for s in self.starts] if deaf else self._beyond(jacobian, count):
            for size in (1.0, FURTHER):
                fit = self._let_go(model, lander, slopes, np.clip(size * own, *self._limits(count)), first.objective + HOPELESS)
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

    def _let_go(self, model: Model, lander: Lander, slopes: Array, own: Array, ceiling: float) -> Fit | None:
        """The nuisances fitted around the held effect, then all; None where holding it is hopeless."""
        count = len(self.point.z)
        nuisances, effect = self.coordinates[:count], self.coordinates[count:]
        held = tuple(replace(c, low=c.value(z), high=c.value(z), positive=False) for c, z in zip(effect, own.tolist(), strict=True))
        around = Model(self.landings, (*nuisances, *held), lander, self.point.horizon)
        fit = fitted(around, np.concatenate([self.point.z, own]), slopes, steps=4)
        if fit is None or fit.objective > ceiling:
            return None
        mine = range(count, len(self.coordinates))
        fresh = np.column_stack([fit.slopes[:, :count], model.slopes(fit.z, fit.predicted, mine)])
        return fitted(model, fit.z, fresh, fit.predicted, steps=4)


@dataclass(frozen=True)
class Shake:
    """A fit to whole landings taken on from a point of its own posterior, drawn at random.

    Contacts leave kinks in φ at which slopes promise gains that no step makes: the fit stands, 8 to 10 above the minimum beside it.
    """

    landings: Landings
    fit: Fit
    renew: tuple[int, ...]
    seed: int

    def __call__(self, lander: Lander) -> Fit | None:
        model = Model(self.landings, self.fit.coordinates, lander)
        spread = np.linalg.cholesky(self.fit.covariance)
        drawn = np.random.default_rng(self.seed).standard_normal(len(self.fit.z))
        return fitted(model, self.fit.z + spread @ drawn, self.fit.slopes, steps=6, renew=self.renew)


@dataclass(frozen=True)
class Refine:
    """A fit taken on with the columns `which` made anew."""

    landings: Landings
    fit: Fit
    which: tuple[int, ...]

    def __call__(self, lander: Lander) -> Fit:
        return refined(Model(self.landings, self.fit.coordinates, lander), self.fit, self.which)


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
