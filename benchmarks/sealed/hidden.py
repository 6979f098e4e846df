"""The effect that is hidden in a case, its size set by its signature energy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.effects import Effect
from orchestrator.diagnosis.fit import fitted, refined
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.problem import Landings, Model
from orchestrator.diagnosis.search import Search, UnflyableError
from sealed.energy import energy, scaled_to
from sealed.instruments import observation
from sealed.scene import STOP, Scene, base_of, centred, model_of
from sealed.vehicle import Vehicle

Array = NDArray[np.float64]
Random = np.random.Generator
LARGEST = 3.0  # prior standard deviations
NEAR = 0.25  # of the λ asked for
REFITS = 4  # sizes tried for it


@dataclass(frozen=True)
class Hidden:
    """Effects with their z, and λ together and alone."""

    effects: tuple[Effect, ...]
    z: tuple[tuple[float, ...], ...]
    energies: tuple[float, ...]
    energy: float
    linear: tuple[float, ...] = ()
    """What slopes at the true nuisances say of each."""


At = Callable[[float], tuple[float, ...]]


class Signatures:
    """White changes of one scene's prediction by effects, and what nuisances leave of them: by their slopes, and fitted anew."""

    def __init__(self, vehicle: Vehicle, scene: Scene, lander: Lander) -> None:
        self.vehicle, self.scene, self.lander = vehicle, centred(vehicle, scene), lander
        model = model_of(vehicle, self.scene, lander)
        predicted = model.predict(self.scene.z)
        if predicted is None:
            raise ArithmeticError("the scene cannot be flown")
        self.predicted = predicted
        self.derivatives = model.slopes(self.scene.z, predicted)
        self.slopes = model.whitened(self.derivatives, predicted)

    def flown(self, effects: Sequence[Effect], z: Sequence[Sequence[float]]) -> Array | None:
        """The prediction with effects at a point; None where it cannot be flown."""
        coordinates = tuple(c for effect in effects for c in self.vehicle.coordinates(effect))
        fixed = {name: value for effect in effects for name, value in self.vehicle.fixed(effect).items()}
        model = model_of(self.vehicle, self.scene, self.lander, coordinates, fixed)
        return model.predict(np.concatenate([self.scene.z, *(np.array(part) for part in z)]))

    def signature(self, effects: Sequence[Effect], z: Sequence[Sequence[float]]) -> Array | None:
        """White change by effects at a point; None where it cannot be flown."""
        there = self.flown(effects, z)
        return None if there is None else self.whitened(there)

    def whitened(self, prediction: Array) -> Array:
        """White difference of a prediction and that of the scene without effect."""
        model = model_of(self.vehicle, self.scene, self.lander)
        return model.whitened((prediction - self.predicted)[:, None], self.predicted)[:, 0]

    def energy(self, effects: Sequence[Effect], z: Sequence[Sequence[float]]) -> float | None:
        signature = self.signature(effects, z)
        return None if signature is None else energy(signature, self.slopes)

    def left(self, effects: Sequence[Effect], z: Sequence[Sequence[float]], beside: Effect | None = None) -> float | None:
        """λ that stays when the nuisances, and an effect `beside` that is none of these, are fitted anew to what the effects do.

        Twice φ at the best minimum, without noise, the prior centred on the true nuisances; what `beside` costs by its own prior counts.
        The minimum is looked for from the true nuisances, and by the search's own climb from the first contact on: the ground may tilt so
        that the pads touch as they do with a step. Slopes say something else where contacts change order, mostly more.
        """
        return _least(self.from_truth(effects, z, beside), self._by_climb(effects, z, beside))

    def from_truth(self, effects: Sequence[Effect], z: Sequence[Sequence[float]], beside: Effect | None = None) -> float | None:
        """What `left` says of the minimum that is reached from the true nuisances alone: no less."""
        landings, own = self._explained(effects, z, beside)
        if landings is None:
            return None
        model = Model(landings, (*self.scene.coordinates, *own), self.lander)
        start = np.concatenate([self.scene.z, np.zeros(len(own))])
        mine = range(len(self.scene.z), len(start))
        slopes = np.column_stack([self.derivatives, model.slopes(start, self.predicted, mine)])
        fit = fitted(model, start, slopes, self.predicted)
        return None if fit is None else 2.0 * refined(model, fit).objective

    def _by_climb(self, effects: Sequence[Effect], z: Sequence[Sequence[float]], beside: Effect | None = None) -> float | None:
        landings, own = self._explained(effects, z, beside)
        if landings is None:
            return None
        try:
            return 2.0 * Search(landings, (*self.scene.coordinates, *own), (), Crew(lambda: self.lander)).base().objective
        except UnflyableError:
            return None

    def _explained(
        self, effects: Sequence[Effect], z: Sequence[Sequence[float]], beside: Effect | None
    ) -> tuple[Landings | None, tuple[Coordinate, ...]]:
        """What the effects leave, without noise, as data; and the coordinates of the effect beside the nuisances."""
        there = self.flown(effects, z)
        own = tuple(self.vehicle.coordinates(beside)) if beside else ()
        base = base_of(self.vehicle, self.scene, self.vehicle.fixed(beside) if beside else None)
        return None if there is None else Landings([observation(self.vehicle, self.scene.sampling, there)], [base], [STOP]), own

    def sized_by_what_is_left(self, effect: Effect, target: float, random: Random) -> Hidden | None:
        """The effect in a random direction, so large that nuisances fitted anew leave λ; None where 3 prior sigmas do not reach it."""
        at = self._along(effect, random)
        found = scaled_to(target, lambda k: self.energy([effect], [at(k)]), LARGEST)
        k = found[0] if found else np.inf
        for _ in range(REFITS):
            left = self.from_truth([effect], [at(k)]) if k <= LARGEST else None
            if left is not None and left >= (1.0 - NEAR) * target:  # no more than that: a climb may still find less
                left = _least(left, self._by_climb([effect], [at(k)]))
            if left is None:
                return None
            if abs(left / target - 1.0) <= NEAR:
                return Hidden((effect,), (at(k),), (left,), left, (self.energy([effect], [at(k)]) or 0.0,))
            k *= float(np.clip(np.sqrt(target / max(left, 1e-9)), 0.4, 2.5))
        return None

    def sized(self, effect: Effect, target: float, random: Random) -> Hidden | None:
        """The effect in a random direction, as large as λ by slopes asks; None where 3 prior sigmas do not reach it."""
        at = self._along(effect, random)
        found = scaled_to(target, lambda k: self.energy([effect], [at(k)]), LARGEST)
        return Hidden((effect,), (at(found[0]),), (found[1],), found[1]) if found else None

    def _along(self, effect: Effect, random: Random) -> At:
        """A random direction: z of the effect's parameters by its length."""
        coordinates = self.vehicle.coordinates(effect)
        shape = [self._is_shape(effect, i) for i in range(len(coordinates))]
        direction = random.standard_normal(len(coordinates))
        direction /= np.linalg.norm(direction[~np.array(shape)]) or 1.0
        direction = np.where(shape, np.clip(random.standard_normal(len(coordinates)), -1.5, 1.5), direction)
        direction = np.where([c.positive for c in coordinates], np.abs(direction), direction)

        def at(k: float) -> tuple[float, ...]:
            z = np.where(shape, direction, k * direction)
            return tuple(min(max(x, c.bounds[0]), c.bounds[1]) for x, c in zip(z.tolist(), coordinates, strict=True))

        return at

    def _is_shape(self, effect: Effect, place: int) -> bool:
        """Whether a parameter alone changes nothing: it shapes what another one sizes."""
        coordinates = self.vehicle.coordinates(effect)
        if len(coordinates) == 1:
            return False
        z = [1.0 if i == place else 0.0 for i in range(len(coordinates))]
        signature = self.signature([effect], [z])
        return signature is not None and not signature.any()


def _least(*found: float | None) -> float | None:
    return min((it for it in found if it is not None), default=None)


def parameters(vehicle: Vehicle, effect: Effect, z: Sequence[float]) -> dict[str, float]:
    """p of each parameter."""
    coordinates: list[Coordinate] = vehicle.coordinates(effect)
    return {it.name: c.value(x) for it, c, x in zip(effect.parameters, coordinates, z, strict=True)}
