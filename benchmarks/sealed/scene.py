"""The landings of a case before anything is hidden in them: what was known, what was true, what the vehicle is really like."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.problem import Landings, Model
from sealed.instruments import Sampling, drawn_sampling, observation
from sealed.kinds import Plan
from sealed.vehicle import JITTERED, Known, Vehicle

Array = NDArray[np.float64]
Random = np.random.Generator
MOVED = {"velocity_body": 0.1, "attitude": 0.03, "rates": 0.01, "ground_slope": 0.015, "ground_azimuth": 0.3}
"""Standard deviation by which the conditions of a landing differ from the scenario's."""
PRIOR = {"velocity_body": (0.03, "m/s"), "attitude": (0.0035, "rad"), "rates": (0.00175, "rad/s"), "ground_slope": (0.007, "rad"),
         "ground_azimuth": (0.07, "rad"), "soil.bearing_strength": (0.12, "N/m"), "soil.friction": (0.03, "1")}  # fmt: skip
OF_LOG = ("soil.bearing_strength",)


@dataclass(frozen=True)
class Scene:
    """One landing: what is public of it, and how it really began (z of the nuisances, then of the reality gap)."""

    known: tuple[Known, ...]
    sampling: Sampling
    coordinates: tuple[Coordinate, ...]
    z: Array
    settled: Mapping[str, float] = field(default_factory=dict)
    """Twin's variable → true value, of what nobody looks for."""


def conditions(vehicle: Vehicle, random: Random, moved: float) -> tuple[Known, ...]:
    """What was known before the landing; `moved`: how far from the scenario, in MOVED."""
    found = []
    for name, (spread, unit) in PRIOR.items():
        mean = vehicle.addresses.base_value(name)
        mean = mean + moved * MOVED.get(name, 0.0) * random.standard_normal(len(mean))
        if name == "ground_slope":
            mean = np.maximum(mean, 0.0)
        measure = unit if name not in OF_LOG else vehicle.addresses.unit_of_measure(name)
        found.append(Known(name, tuple(mean.tolist()), spread, measure, name in OF_LOG))
    return tuple(found)


def drawn_scene(vehicle: Vehicle, random: Random, plan: Plan, gap: Array, moved: float) -> Scene:
    """A landing of a vehicle whose reality gap is `gap`."""
    known = conditions(vehicle, random, moved)
    nuisances = vehicle.nuisances(known)
    z = random.standard_normal(len(nuisances))
    if plan.kind == "decoy":
        which = random.choice(len(nuisances) - 1, size=int(random.integers(2, 5)), replace=False)
        z[which] = random.uniform(2.0, 3.0, len(which)) * random.choice([-1.0, 1.0], len(which))
    z[-1] = 0.0  # the clock's origin is in the sampling
    sampling = drawn_sampling(random, plan.colour, plan.misstated, vehicle.addresses.legs)
    return Scene(known, sampling, (*nuisances, *vehicle.gap()), np.concatenate([z, gap]))


def centred(vehicle: Vehicle, scene: Scene) -> Scene:
    """The same landing with the true nuisances at z = 0, a prior that pulls to what they are; what no diagnosis looks for stays true."""
    free = [c.name in vehicle.looked_for or c.name not in JITTERED for c in scene.coordinates]
    there = [c.mean + c.sigma * float(x) for c, x in zip(scene.coordinates, scene.z, strict=True)]
    coordinates = tuple(replace(c, mean=p) for c, p, own in zip(scene.coordinates, there, free, strict=True) if own)
    others = [c for c, own in zip(scene.coordinates, free, strict=True) if not own]
    settled = vehicle.values(others, scene.z[~np.array(free)])
    return replace(scene, coordinates=coordinates, z=np.zeros(len(coordinates)), settled=settled)


def base_of(vehicle: Vehicle, scene: Scene, fixed: Mapping[str, float] | None = None) -> dict[str, float]:
    """Every value of the twin that coordinates do not move."""
    return {**vehicle.base, **scene.settled, **(fixed or {})}


def model_of(
    vehicle: Vehicle, scene: Scene, lander: Lander, more: tuple[Coordinate, ...] = (), fixed: Mapping[str, float] | None = None
) -> Model:
    """The scene as the search's problem: its nuisances and tolerances, then `more`."""
    landings = Landings([observation(vehicle, scene.sampling)], [base_of(vehicle, scene, fixed)], [STOP])
    return Model(landings, (*scene.coordinates, *more), lander)


STOP = 4.0  # s since first contact
