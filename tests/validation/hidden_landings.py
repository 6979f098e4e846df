"""Measured landings with something hidden in them, made with the sealed cases' generator and flown otherwise than the search flies."""

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from conftest import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))

from sealed import truth
from sealed.hidden import Hidden, Signatures
from sealed.instruments import clean_readings, noisy, public
from sealed.kinds import Plan
from sealed.make import FINE, scenes_of
from sealed.outside import LAWS
from sealed.scene import Scene
from sealed.vehicle import Vehicle

from orchestrator.diagnosis.measured import write_measured

FRAMES = np.arange(-0.1, 3.0, 0.02)
"""s since first contact: one recorder takes all channels at once; a landing has 201 instants to meet, with clocks of 35 and 40 Hz 321."""


@dataclass(frozen=True)
class Case:
    """What is hidden, at which signature energy (sigma squared after nuisances), and what the verdict must be."""

    effect: str
    energy: float
    seed: int
    verdict: str
    names: tuple[str, ...] = ()
    one_recorder: bool = True
    """Without, each series has instants of its own, as in the sealed cases."""
    held_out: bool = True
    """Whether the diagnosis gets the second landing."""


def framed(scene: Scene) -> Scene:
    """The scene as a recorder with common frames sees it."""
    times = dict.fromkeys(scene.sampling.times, np.round(scene.sampling.origin + FRAMES, 6))
    return replace(scene, sampling=replace(scene.sampling, times=times))


def write(vehicle: Vehicle, case: Case, folder: Path) -> None:
    """Two landings of one vehicle with the case's effect at the same strength in both, white noise of the stated size."""
    plan = Plan(0, "single large" if case.effect else "null white", case.energy, 0.0, 1.0, "twin")
    scenes = [framed(scene) if case.one_recorder else scene for scene in scenes_of(vehicle, plan, [case.seed])]
    random = np.random.default_rng([case.seed, 1])
    hidden = Hidden((), (), (), 0.0)
    if case.effect:
        lander = vehicle.lander(FINE)
        effect = vehicle.effects.get(case.effect) or LAWS[case.effect]
        sized = Signatures(vehicle, scenes[0], lander).sized(effect, case.energy, random)
        lander.close()
        assert sized is not None, f"{case.effect} does not reach λ = {case.energy} in this landing"
        hidden = sized
    for name, scene in zip(("fit", "holdout"), scenes, strict=True):
        own = [c for effect in hidden.effects for c in vehicle.coordinates(effect)]
        fixed = {k: v for effect in hidden.effects for k, v in vehicle.fixed(effect).items()}
        z = np.concatenate([scene.z, *(np.array(part) for part in hidden.z)])
        values = {**fixed, **vehicle.values([*scene.coordinates, *own], z)}
        course = truth.fly(vehicle, values, hidden.effects, "twin")
        assert course is not None
        readings = noisy(random, vehicle, scene.sampling, clean_readings(vehicle, scene.sampling, course, values))
        write_measured(folder / name, public(vehicle, scene.sampling, readings, scene.known, name))
