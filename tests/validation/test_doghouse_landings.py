"""Landings whose fate is plain, and a small Doghouse whose boundary landings are flown again alone."""

import json
import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from orchestrator.cli import app
from orchestrator.doghouse.flying import Scenario
from orchestrator.doghouse.landing import BOUNDARIES, Inputs
from orchestrator.doghouse.model import Doghouse, read
from orchestrator.results.channels import Channels
from orchestrator.results.failure import failure
from orchestrator.results.schema import read as read_results
from orchestrator.simulation import run_scenario

SCENARIOS = Path(__file__).parents[2] / "scenarios"
LEVEL = [f"lander.soil.ground_slope[{k}]=0" for k in (1, 2, 3, 4)]


def plan() -> Doghouse:
    return read(SCENARIOS / "doghouse.toml")


def landed(inputs: Inputs, more: tuple[str, ...] = (), separate: bool = False) -> dict[str, Any]:
    """Failure measures of one landing, by the twin or by the separate units."""
    scenario = Scenario.read(plan().check if separate else plan().search, SCENARIOS, "doghouse.toml")
    result = run_scenario(scenario.path, [*scenario.overrides(inputs), *more])
    assert result.complete, result.message
    return failure(Channels(result.times, result.columns), read_results(result.results), result.parameters)


@pytest.mark.parametrize("friction", [0.33, 3.0])
def test_a_slow_landing_on_level_ground_keeps_all_its_margins(friction: float) -> None:
    found = landed(Inputs(0.1, 0.5, 0.0, 0.0, 0.0, 0.0, friction), tuple(LEVEL))
    assert found["failed"] == []
    assert found["tip_over"]["decided"]
    assert found["tip_over"]["least_angle_deg"] > 38.0  # 40.4 at rest on undeformed legs
    assert found["tip_over"]["least_energy_margin_J"] > 0.8 * found["tip_over"]["final_energy_margin_J"]
    assert found["primary_stroke"]["peak_m"] < 0.05
    assert found["secondary_tension"]["peak_m"] < 0.1


def test_across_the_slope_at_three_metres_a_second_with_locked_pads_and_leaning_ahead_it_goes_over() -> None:
    found = landed(Inputs(3.0, 1.0, 45.0, 90.0, 6.0, 90.0, 3.0))
    assert found["tip_over"]["tipped"]
    assert "tip_over" in found["failed"]


@pytest.mark.slow
def test_twin_and_separate_units_agree_on_the_corner_of_the_certified_envelope() -> None:
    """Tolerance: 0.5 deg and 5 mm, between the twin at 3e-3 m/s a step and the master at 1e-5 m; found: 0.01 deg and below 1 mm."""
    corner = Inputs(1.2192, 2.1336, 0.0, 0.0, 6.0, 270.0, 0.33)
    one, other = landed(corner), landed(corner, separate=True)
    assert one["tip_over"]["least_angle_deg"] == pytest.approx(other["tip_over"]["least_angle_deg"], abs=0.5)
    for name in BOUNDARIES[1:]:
        assert one[name]["margin_m"] == pytest.approx(other[name]["margin_m"], abs=5e-3), name


SMALL = {
    "heading_deg": "[45.0]",
    "motion_deg": "[180.0]",
    "tilt_toward_deg": "[90.0]",
    "friction": "[3.0]",
    "rays_deg": "[58.0]",
    "bracket_m_s": "0.2",
    "landings": "2",
}


def small_plan(folder: Path) -> Path:
    """The plan with one ray and two combinations."""
    text = (SCENARIOS / "doghouse.toml").read_text()
    for key, value in SMALL.items():
        text, count = re.subn(rf"^{key} = [^#\n\"]*$|^{key} = [^#\n\"]*(?=#)", f"{key} = {value}  ", text, count=1, flags=re.MULTILINE)
        assert count == 1, key
    path = folder / "small.toml"
    path.write_text(text.replace('scenario = "', f'scenario = "{SCENARIOS}/'))
    return path


@pytest.mark.slow
def test_boundary_landings_flown_alone_fall_on_the_side_they_were_said_to_and_a_second_call_flies_nothing(tmp_path: Path) -> None:
    small = small_plan(tmp_path)
    out = tmp_path / "out"
    for _ in range(2):
        done = CliRunner().invoke(app, ["doghouse", str(small), "--out", str(out), "--workers", "1", "--no-check", "--quiet"])
        assert done.exit_code == 0, done.output
    summary = json.loads((out / "doghouse.json").read_text())
    assert summary["cost"]["flown_now"] == 0.0
    assert (out / "doghouse.png").is_file()
    (point,) = summary["boundaries"]["tip_over"]
    for key, fails in ((None, False), ("beyond", True)):
        side = point if key is None else point[key]
        found = landed(Inputs(**side["inputs"]))
        assert ("tip_over" in found["failed"]) is fails
        assert found["tip_over"]["least_angle_deg"] == side["margin"]
