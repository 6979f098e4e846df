"""Hidden effects found from data alone, by the command line with the whole library.

The landings are made with the sealed cases' generator and flown otherwise than the search flies."""

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, orchestrator

sys.path.insert(0, str(ROOT / "benchmarks"))

from sealed import truth
from sealed.hidden import Hidden, Signatures
from sealed.instruments import clean_readings, noisy, public
from sealed.kinds import Plan
from sealed.make import scenes_of
from sealed.outside import LAWS
from sealed.vehicle import Vehicle

from orchestrator.diagnosis.measured import write_measured

pytestmark = pytest.mark.slow


@dataclass(frozen=True)
class Case:
    """What is hidden, at which signature energy (sigma squared after nuisances), and what the verdict must be."""

    effect: str
    energy: float
    seed: int
    verdict: str
    names: tuple[str, ...] = ()


CASES = {
    "a force in the soil": Case("soil_damping", 150.0, 11, "effect", ("soil_damping",)),
    "a sensor's axes": Case("gyro_cross_axis", 150.0, 12, "effect", ("gyro_cross_axis",)),
    "nothing": Case("", 0.0, 13, "nothing_missing"),
    "a law outside the library": Case("outside_yaw_angle", 300.0, 14, "none_of_my_effects"),
    "one of two that look alike": Case("telemetry_lowpass", 30.0, 15, "cannot_tell", ("telemetry_lowpass", "clock_offset")),
}


@pytest.fixture(scope="module")
def vehicle() -> Vehicle:
    return Vehicle()


def write(vehicle: Vehicle, case: Case, folder: Path) -> None:
    """Two landings of one vehicle with the case's effect at the same strength in both, white noise of the stated size."""
    plan = Plan(0, "single large" if case.effect else "null white", case.energy, 0.0, 1.0, "twin")
    scenes = scenes_of(vehicle, plan, [case.seed])
    random = np.random.default_rng([case.seed, 1])
    hidden = Hidden((), (), (), 0.0)
    if case.effect:
        lander = vehicle.lander()
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


def diagnosed(folder: Path) -> dict[str, Any]:
    done = orchestrator(
        "diagnose", "apollo11_zupp", "--measured", folder / "fit", "--holdout", folder / "holdout", "--out", folder / "out",
        "--verdict-only", "--workers", 2,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return dict(json.loads((folder / "out" / "diagnosis.json").read_text("utf-8")))


@pytest.mark.parametrize("what", CASES)
def test_what_is_hidden_gets_its_verdict(what: str, vehicle: Vehicle, tmp_path: Path) -> None:
    case = CASES[what]
    write(vehicle, case, tmp_path)
    found = diagnosed(tmp_path)
    told = [(c["name"], round(c["log_evidence"], 1), round(c["adequacy"], 4), c["holdout_gain"]) for c in found["candidates"][:4]]
    assert found["verdict"] == case.verdict, told
    if case.verdict == "effect":
        assert tuple(effect["name"] for effect in found["effects"]) == case.names, told
        assert found["gap"]["closure"] >= 0.8, found["gap"]
    if case.verdict == "cannot_tell":
        assert set(found["cannot_tell"]["names"]) >= set(case.names), told
