"""What the example landing could tell apart, by the built FMUs through the command line; and that the example is in order."""

import json
from pathlib import Path

import pytest
from conftest import ROOT, orchestrator

from orchestrator.diagnosis.measured import faults, read_measured

EXAMPLE = ROOT / "scenarios" / "measured" / "example_soil"


@pytest.mark.parametrize("landing", ["fit", "holdout"])
def test_the_example_is_complete_and_without_fault(landing: str) -> None:
    measured = read_measured(EXAMPLE / landing)
    assert not faults(measured)
    assert "synthetic" in measured.source
    assert {s.name for s in measured.series} == {"rates", "attitude"}


def test_measured_data_are_not_listed_among_the_scenarios() -> None:
    listed = orchestrator("list")
    assert listed.returncode == 0
    assert "example_soil" not in listed.stdout


@pytest.mark.slow
def test_the_example_shows_soil_damping_but_not_apart_from_momentum_transfer(tmp_path: Path) -> None:
    """Cosine 0.92 measured; λ of one prior sigma of damping (50 kN s/m) 703: 20 kN s/m are five times what just shows."""
    done = orchestrator("distinguish", "apollo11_zupp", "--measured", EXAMPLE / "fit", "--out", tmp_path, "--workers", 1)
    assert done.returncode == 0, done.stderr
    found = json.loads((tmp_path / "distinguish.json").read_text("utf-8"))
    assert (tmp_path / "distinguish.html").is_file()
    effects = {e["name"]: e for e in found["effects"]}
    assert effects["soil_damping"]["lambda"] > 300.0
    assert 1e3 < effects["soil_damping"]["detectable"] < 1e4
    assert ["inertial_drag", "soil_damping"] in [sorted(group) for group in found["groups"]]
    parts = {sensor["channel"]: sensor["splits"] for sensor in found["sensors"]}
    assert any({"inertial_drag", "soil_damping"} <= set(split) for split in parts["strut loads, 50 Hz"])
