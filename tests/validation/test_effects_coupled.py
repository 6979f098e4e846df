"""Each effect on the body as a unit of its own in the co-simulation, against the twin with the same parameters inside.

Bound: 0.02 deg/s RMS on every rate over 1.5 s, a fifth of the standard deviation of Apollo's rate data. Measured: 0.007 without any effect,
0.007 with jets, 0.016 with the ground effect. At single instants, where a force kinks, the co-simulation is 0.05 deg/s from its twin
without any effect, and 0.11 with the ground effect.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, Array, Landing, orchestrator

RATES = [f"rates.{axis}" for axis in ("yaw", "pitch", "roll")]
BOUND = 0.02  # deg/s
THRUST = 'from = "guidance.engine.thrust"\nto = "effect.engine.thrust"'
CASES: dict[str, tuple[str, str, str, dict[str, Any]]] = {
    "ground effect": ("ThrustGroundEffect", "plume", THRUST, {"share": 0.3}),
    "slosh": ("PropellantSlosh", "slosh", "", {"mass": 300.0}),
    "jets": ("ReactionControl", "rcs", "", {"torque": [0.0, 800.0, -400.0], "start": 0.21, "duration": 0.4}),
    "term on rate": ("BodyTerm", "body_term", "", {"coefficient": -400.0, "axis": 6, "basis": 5}),
    "term on thrust": ("BodyTerm", "body_term", THRUST, {"coefficient": 60.0, "axis": 5, "basis": 8}),
}


def toml(values: dict[str, Any], prefix: str = "") -> str:
    """Lines of a table."""
    return "\n".join(f'"{prefix}{name}" = {value}' for name, value in values.items())


def coupled(unit: str, connection: str, values: dict[str, Any]) -> str:
    """The Zupp-like landing with a unit at the body's third socket; none for no unit."""
    text = f'extends = "{ROOT}/scenarios/apollo11_zupp.toml"\nstop_time = 1.5\n'
    if unit:
        text += f'[units.effect]\nfmu = "{unit}"\n[units.effect.parameters]\n{toml(values)}\n'
        text += '[[connections]]\nports = ["body.body", "effect.body"]\n[[connections]]\nports = ["effect.effect", "body.effect3"]\n'
        text += f"[[connections]]\n{connection}\n" if connection else ""
    return text


def twin(place: str, values: dict[str, Any]) -> str:
    """The twin with the engine and the effect inside."""
    guidance = {"thrust_before_contact": 5000.0, "thrust_start": 5000.0, "decay_time": 1.0}
    text = (
        f'extends = "{ROOT}/scenarios/apollo11_zupp_twin.toml"\nstop_time = 1.5\n[master]\nmax_interval = 5e-4\n[record]\ninterval = 5e-4\n'
    )
    text += "[units.guidance.parameters]\nthrust_start = 0.0\nthrust_before_contact = 0.0\n"
    text += f"[units.lander.parameters]\n{toml(guidance, 'guidance.')}\n{toml(values, place + '.')}\n"
    return text


def run(folder: Path, name: str, text: str, body: str) -> tuple[Array, Array]:
    """Times and rates, deg/s."""
    (folder / f"{name}.toml").write_text(f'title = "{name}"\n{text}', encoding="utf-8")
    done = orchestrator("run", folder / f"{name}.toml", "--out", folder / name, "--no-figures")
    assert done.returncode == 0, done.stderr
    landing = Landing(folder / name, {})
    return landing.series("time"), np.degrees([landing.series(f"{body}.{rate}") for rate in RATES])


def apart(times: Array, ours: Array, instants: Array, inside: Array) -> float:
    """Largest RMS difference of any rate, deg/s, at the times of the co-simulation; the twin's rows are 0.5 ms apart."""
    return max(float(np.sqrt(np.mean((a - np.interp(times, instants, b)) ** 2))) for a, b in zip(ours, inside, strict=True))


@pytest.mark.parametrize("case", CASES)
def test_the_unit_beside_the_body_is_the_effect_inside_the_twin(case: str, tmp_path: Path) -> None:
    unit, place, connection, values = CASES[case]
    times, ours = run(tmp_path, "coupled", coupled(unit, connection, values), "body")
    instants, inside = run(tmp_path, "twin", twin(place, values), "lander")
    assert apart(times, ours, instants, inside) < BOUND


def test_swirl_in_the_guidance_is_swirl_inside_the_twin(tmp_path: Path) -> None:
    swirl = "[units.guidance.parameters]\nswirl = 0.1\n"
    times, ours = run(tmp_path, "coupled", coupled("", "", {}) + swirl, "body")
    instants, inside = run(tmp_path, "twin", twin("guidance", {"swirl": 0.1}), "lander")
    assert apart(times, ours, instants, inside) < BOUND


@pytest.mark.parametrize("unit", ["ThrustGroundEffect", "PropellantSlosh", "ReactionControl", "BodyTerm"])
def test_a_unit_of_no_size_beside_the_body_changes_no_bit(unit: str, tmp_path: Path, base: Callable[[], Array]) -> None:
    connection = THRUST if unit in ("ThrustGroundEffect", "BodyTerm") else ""
    _, ours = run(tmp_path, "coupled", coupled(unit, connection, {}), "body")
    assert np.array_equal(ours, base())


@pytest.fixture(scope="session")
def base(tmp_path_factory: pytest.TempPathFactory) -> Callable[[], Array]:
    """Rates of the landing without a unit."""
    rates = run(tmp_path_factory.mktemp("base"), "base", coupled("", "", {}), "body")[1]
    return lambda: rates
