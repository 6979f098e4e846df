"""The effect that is hidden in a case, its size set by its signature energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.effects import Effect
from orchestrator.diagnosis.landing import Lander
from sealed.energy import energy, scaled_to
from sealed.scene import Scene, model_of
from sealed.vehicle import Vehicle

Array = NDArray[np.float64]
Random = np.random.Generator
LARGEST = 3.0  # prior standard deviations


@dataclass(frozen=True)
class Hidden:
    """Effects with their z, and λ together and alone."""

    effects: tuple[Effect, ...]
    z: tuple[tuple[float, ...], ...]
    energies: tuple[float, ...]
    energy: float


class Signatures:
    """White changes of one scene's prediction, against one set of nuisance slopes."""

    def __init__(self, vehicle: Vehicle, scene: Scene, lander: Lander) -> None:
        self.vehicle, self.scene, self.lander = vehicle, scene, lander
        model = model_of(vehicle, scene, lander)
        predicted = model.predict(scene.z)
        if predicted is None:
            raise ArithmeticError("the scene cannot be flown")
        self.predicted = predicted
        self.slopes = model.whitened(model.slopes(scene.z, predicted), predicted)

    def signature(self, effects: Sequence[Effect], z: Sequence[Sequence[float]]) -> Array | None:
        """White change by effects at a point; None where it cannot be flown."""
        coordinates = tuple(c for effect in effects for c in self.vehicle.coordinates(effect))
        fixed = {name: value for effect in effects for name, value in self.vehicle.fixed(effect).items()}
        model = model_of(self.vehicle, self.scene, self.lander, coordinates, fixed)
        there = model.predict(np.concatenate([self.scene.z, *(np.array(part) for part in z)]))
        return None if there is None else self.whitened(there)

    def whitened(self, prediction: Array) -> Array:
        """White difference of a prediction and that of the scene without effect."""
        model = model_of(self.vehicle, self.scene, self.lander)
        return model.whitened((prediction - self.predicted)[:, None], self.predicted)[:, 0]

    def columns(self, effect: Effect) -> list[Array]:
        """White slopes by an effect's parameters where it is null, each by a tenth of its prior's standard deviation."""
        count = len(effect.parameters)
        points = [[0.1 if i == place else 0.0 for i in range(count)] for place in range(count)]
        return [10.0 * column for z in points if (column := self.signature([effect], [z])) is not None]

    def energy(self, effects: Sequence[Effect], z: Sequence[Sequence[float]]) -> float | None:
        signature = self.signature(effects, z)
        return None if signature is None else energy(signature, self.slopes)

    def sized(self, effect: Effect, target: float, random: Random) -> Hidden | None:
        """The effect in a random direction, as large as λ asks; None where 3 prior sigmas do not reach it."""
        coordinates = self.vehicle.coordinates(effect)
        shape = [self._is_shape(effect, i) for i in range(len(coordinates))]
        direction = random.standard_normal(len(coordinates))
        direction /= np.linalg.norm(direction[~np.array(shape)]) or 1.0
        direction = np.where(shape, np.clip(random.standard_normal(len(coordinates)), -1.5, 1.5), direction)
        direction = np.where([c.positive for c in coordinates], np.abs(direction), direction)

        def at(k: float) -> tuple[float, ...]:
            z = np.where(shape, direction, k * direction)
            return tuple(min(max(x, c.bounds[0]), c.bounds[1]) for x, c in zip(z.tolist(), coordinates, strict=True))

        found = scaled_to(target, lambda k: self.energy([effect], [at(k)]), LARGEST)
        return Hidden((effect,), (at(found[0]),), (found[1],), found[1]) if found else None

    def _is_shape(self, effect: Effect, place: int) -> bool:
        """Whether a parameter alone changes nothing: it shapes what another one sizes."""
        coordinates = self.vehicle.coordinates(effect)
        if len(coordinates) == 1:
            return False
        z = [1.0 if i == place else 0.0 for i in range(len(coordinates))]
        signature = self.signature([effect], [z])
        return signature is not None and not signature.any()


def parameters(vehicle: Vehicle, effect: Effect, z: Sequence[float]) -> dict[str, float]:
    """p of each parameter."""
    coordinates: list[Coordinate] = vehicle.coordinates(effect)
    return {it.name: c.value(x) for it, c, x in zip(effect.parameters, coordinates, z, strict=True)}
