"""Bad input to a built unit: named, discarded, never passed on, and the host lives."""

from collections.abc import Callable
from pathlib import Path

import pytest
from hosted import DISCARD, OK, Hosted

Host = Callable[..., Hosted]


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_an_input_that_is_no_number_is_named_and_not_passed_on(toy: Path, host: Host, value: float) -> None:
    one = host(toy, name="left")
    assert one.step(0.0, 1e-2) == OK
    before = one.bytes_of_state()
    one["end.force[2]"] = value
    assert one.step(1e-2, 1e-2) == DISCARD
    assert one.log[-1] == f"MassSpring left: at 0.01 s: end.force[2] is {value}, expects a finite number"
    assert one["end.position[2]"] == 0.0
    one["end.force[2]"] = 0.0
    assert one.bytes_of_state() == before
    assert one.step(1e-2, 1e-2) == OK


def test_a_parameter_out_of_its_bounds_is_named_and_no_step_is_done(toy: Path, host: Host) -> None:
    one = host(toy, mass=-5.0)
    assert one["message"] == "mass is -5.0 kg, expects at least 1e-06 kg"
    assert one.log == ["MassSpring it: mass is -5.0 kg, expects at least 1e-06 kg"]
    assert one["end.position[1]"] == 0.1      # its start value: nothing was computed
    for n in range(3):
        assert one.step(n * 1e-2, 1e-2) == DISCARD
    one.slave.reset()
    one.begin(mass=5.0)
    assert one["message"] == ""
    assert one.step(0.0, 1e-2) == OK


def test_an_integer_out_of_its_bounds_and_a_rule_of_the_unit_are_named(toy: Path, host: Host) -> None:
    assert host(toy, law=3)["message"] == "law is 3, expects at most 2"
    assert host(toy, rate=13.0)["message"] == "rate is 13.0 N/m, expects any other number"


def test_a_units_own_refusal_leaves_it_as_before_the_step(toy: Path, host: Host) -> None:
    one = host(toy)
    one["end.force[1]"] = 1e4
    before = one.bytes_of_state()
    assert one.step(0.0, 0.1) == DISCARD
    assert "expects at most longest, 5.0 m" in one["message"]
    assert one.bytes_of_state() == before


def test_an_exception_is_one_line_and_may_happen_again(toy: Path, host: Host) -> None:
    one = host(toy, mass=3.0)
    for n in range(3):
        assert one.step(n * 1e-2, 1e-2) == DISCARD
    assert one["message"] == "at 0.02 s: ZeroDivisionError: float division by zero"


@pytest.mark.parametrize("step", [0.0, -1.0, float("nan")])
def test_a_step_must_be_longer_than_nothing(toy: Path, host: Host, step: float) -> None:
    one = host(toy)
    assert one.step(0.0, step) == DISCARD
    assert "expects more than 0 s" in one["message"]


def test_an_unknown_value_reference_does_not_kill_the_host(toy: Path, host: Host) -> None:
    one = host(toy)
    one.slave.getReal([100000])
    assert one["message"] == "value reference 100000 is unknown to get"
    one.slave.setReal([100000], [1.0])
    assert one["message"] == "value reference 100000 is unknown to set"


def test_a_parameter_is_fixed_once_stepping(toy: Path, host: Host) -> None:
    one = host(toy)
    one["mass"] = 7.0
    assert one["mass"] == 2.0
    assert "mass is no input" in one["message"]


def test_a_unit_with_wrong_parameters_never_crashes_its_host(fmus: dict[str, Path], host: Host) -> None:
    for name, fmu in fmus.items():
        parameters = [v for v in host(fmu).description.modelVariables if v.causality == "parameter" and v.type == "Real"]
        for parameter in [v.name for v in parameters][:3]:
            one = host(fmu, initialise=False)
            one[parameter] = float("nan")
            one.slave.exitInitializationMode()
            assert one.step(0.0, 1e-3) == DISCARD, name
            assert f"{parameter} is nan" in one["message"], name


@pytest.mark.parametrize(
    ("units", "values", "says"),
    [
        (("VehicleBody", "LunarLander"), {"inertia[1]": 4e4}, "the principal moments are 17409, 20800 and 40000 kg.m2"),
        (("VehicleBody", "LunarLander"), {"inertia_products[1]": 17000.0}, "expects each more than 0"),
        (("GearLeg", "LunarLander"), {"primary_boundary": 0.9}, "primary_boundary is 0.9 m, expects less than primary_limit, 0.812 m"),
        (("GearLeg", "LunarLander"), {"transition_width": 0.05, "tension_boundary": 0.02}, "expects less than tension_boundary, 0.02 m"),
        (("GearLeg", "LunarLander"), {"compression_limit": 2.0}, "compression_limit is 2 m, must be below the secondary's length 1."),
        (("LunarLander",), {"mass": 200.0}, "mass is 200 kg, expects more than the 311.76 kg of legs and slosh"),
        (("LunarLander",), {"inertia[1]": 3e3, "inertia[2]": 3e3, "inertia[3]": 3e3}, "its legs leave a principal moment of -1110"),
    ],
)
def test_the_twin_refuses_what_its_units_refuse(
    fmus: dict[str, Path], host: Host, units: tuple[str, ...], values: dict[str, float], says: str
) -> None:
    for name in units:
        one = host(fmus[name], **values)
        assert says in one["message"], name
        assert one.step(0.0, 1e-3) == DISCARD


@pytest.mark.parametrize("name", ["RegolithContact", "LunarLander"])
def test_a_run_that_begins_before_zero_is_refused_where_a_contact_is_dated(fmus: dict[str, Path], host: Host, name: str) -> None:
    one = host(fmus[name], initialise=False)
    one.slave.reset()
    one.slave.setupExperiment(startTime=-2.0)
    one.slave.enterInitializationMode()
    one.slave.exitInitializationMode()
    assert "the run begins at -2 s, expects 0 s or later" in one["message"]
    assert one.step(-2.0, 1e-3) == DISCARD


def test_a_flat_body_is_a_body(fmus: dict[str, Path], host: Host) -> None:
    assert host(fmus["VehicleBody"], **{"inertia[1]": 3e4, "inertia[2]": 1e4, "inertia[3]": 2e4}).step(0.0, 1e-3) == OK


@pytest.mark.parametrize(("name", "port"), [("GearLeg", "body.quaternion"), ("RegolithContact", "pad.quaternion")])
def test_an_input_quaternion_that_is_no_rotation_is_named(fmus: dict[str, Path], host: Host, name: str, port: str) -> None:
    one = host(fmus[name])
    one[f"{port}[1]"] = 2.0
    assert one.step(0.0, 1e-3) == DISCARD
    assert f"{port} is (2, 0, 0, 0), expects length 1, to 0.1" in one["message"]
    one[f"{port}[1]"] = 1.05
    assert one.step(0.0, 1e-3) == OK
    other = host(fmus[name], initialise=False)
    other[f"{port}[1]"] = 0.0
    other.slave.exitInitializationMode()
    assert f"{port} is (0, 0, 0, 0), expects length 1" in other["message"]
