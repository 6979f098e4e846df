"""The quarter vehicle benchmark without the other masters: our error and steps, as the acceptance asks, and honest counting."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))

import hosts
import packs
import quarter
import reference


@pytest.fixture(scope="module")
def outcome() -> hosts.Outcome:
    packs.quarter_vehicle_fmus()
    return quarter.run_case(("ours", "default", "ours", {}), quarter.task())


def test_the_pad_goes_in_as_deep_as_the_study_says() -> None:
    assert reference.trajectory()[1] == pytest.approx(0.0543, abs=5e-5)


def test_our_master_is_accurate_with_few_steps(outcome: hosts.Outcome) -> None:
    assert outcome.message == ""
    assert reference.error(outcome.times, outcome.values[quarter.PAD]) <= 2e-4
    assert outcome.counts["QuarterVehicle"] <= 350


def test_steps_are_counted_whatever_is_undone(outcome: hosts.Outcome) -> None:
    assert outcome.counts["QuarterVehicle"] > len(outcome.times) - 1


def test_equal_error_is_interpolated_between_tolerances() -> None:
    ecco = [{"master": quarter.ECCO, "error": e, "pad_steps": n, "wall_s": w} for e, n, w in ((1e-3, 1000, 1.0), (1e-5, 100000, 100.0))]
    mine = {"master": "ours", "setting": "default", "error": 1e-4, "pad_steps": 100, "wall_s": 0.1}
    (row,) = quarter.at_equal_error([*ecco, mine])
    assert row["times fewer pad steps"] == pytest.approx(100.0)
    assert row["times less wall time"] == pytest.approx(100.0)
