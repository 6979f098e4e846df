"""What a crew is asked to do: predictions, slopes, and fits. Each is a picklable object that is called with a lander."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import SHARED, Coordinate, clipped, folded
from orchestrator.diagnosis.fit import Fit, fitted, objective, refined, seen_from
from orchestrator.diagnosis.landing import Course, Lander
from orchestrator.diagnosis.observation import ORIGIN, of_units
from orchestrator.diagnosis.problem import Landings, Model

Array = NDArray[np.float64]
INSENSITIVE = 1.0  # norm of a column: below, the hypothesis cannot be felt where it is null, and must be started elsewhere
LOOSE = 1.0  # squared posterior standard deviations: what chance and kinks leave of a draw's prediction
TIMES = tuple(np.linspace(-3.0, 3.0, 61).tolist())  # of z: zeros of the clock that a course is compared at
LATER = 0.2  # s past the horizon that it is flown for that
FARTHEST = 3.0  # of z
TAILS = 3.0  # degrees of freedom of draws: over a kink the posterior is wider than Laplace's approximation of it
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


def point_of(fit: Fit, horizon: float = np.inf) -> Point:
    """Where a fit ended, for others to start from."""
    return Point(fit.z, fit.predicted, fit.slopes, horizon)


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
            place, worth = self._clock(k), []
            for time in TIMES if place is not None else ():
                z[place] = time
                worth.append(self._missed(model, k, z, course) / 9.0 + time * time)
            if place is not None:
                z[place] = TIMES[int(np.argmin(worth))]
            total += self._missed(model, k, z, course) / 9.0
        return total + float(z @ z), z

    def _missed(self, model: Model, k: int, z: Array, course: Course) -> float:
        observation = self.landings.observations[k]
        missed = observation.residual(observation.predicted(course, model.values(z, k))) * model.weights[self.landings.parts[k]]
        return float(missed @ missed)

    def _clock(self, k: int) -> int | None:
        """The coordinate that is this landing's zero of the clock alone."""
        alone = (SHARED, k) if len(self.landings.observations) == 1 else (k,)
        return next((i for i, c in enumerate(self.coordinates) if c.slots[0][0] == ORIGIN and c.landing in alone), None)


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
        found: list[tuple[float, Array, Array]] = []
        for draw in (np.zeros(len(z)), *random):
            there = clipped(coordinates, folded(coordinates, z + spread @ draw))
            predicted = model.predict(there)
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
class Start:
    """The nuisances alone fitted to the first horizon from a draw of their prior: with threefold noise, then with their own."""

    landings: Landings
    nuisances: tuple[Coordinate, ...]
    z: Array
    horizon: float

    def __call__(self, lander: Lander) -> tuple[Point, Fit] | None:
        """Where the fit began, with the slopes there, and how it ended."""
        model = Model(self.landings, self.nuisances, lander, self.horizon)
        predicted = model.predict(self.z)
        if predicted is None:
            return None
        slopes = model.slopes(self.z, predicted)
        every = tuple(range(len(self.z)))
        began = Point(self.z, predicted, slopes, self.horizon)
        fit = fitted(model, self.z, slopes, predicted, temper=3.0, steps=4, renew=every)
        fit = fit and fitted(model, fit.z, fit.slopes, fit.predicted, steps=8, renew=every, renewals=2)
        return None if fit is None else (began, fit)


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
        same = np.array_equal(self.z[:count], self.point.z) and not self.z[count:].any()
        predicted = self.point.predicted if same else model.predict(self.z)
        if predicted is None:
            return None
        slopes = np.column_stack([self.point.slopes, model.slopes(self.z, predicted, mine)])
        return fitted(model, self.z, slopes, predicted, steps=self.steps, renew=(*self.fresh, *mine))


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
class Refine:
    """A fit seen by these landings, which may be finer than those it was made with, and taken on with slopes of its very point."""

    landings: Landings
    fit: Fit

    def __call__(self, lander: Lander) -> Fit:
        model = Model(self.landings, self.fit.coordinates, lander)
        predicted = model.predict(self.fit.z)
        if predicted is None:
            return self.fit
        return refined(model, seen_from(model, self.fit.z, predicted, self.fit.slopes))


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
