"""From folders and a scenario to a search: names of landings, priors beside tolerances, units of somebody else, the twin itself."""

from dataclasses import replace
from pathlib import Path

import pytest
from diagnosis_samples import coordinate

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses, Slot
from orchestrator.diagnosis.diagnose import beside_scenarios
from orchestrator.diagnosis.effects.library import LIBRARY, load_library
from orchestrator.diagnosis.measured import read_measured
from orchestrator.diagnosis.observation import SEEN
from orchestrator.diagnosis.overlay import overlay, overridden, slot_of_unit
from orchestrator.diagnosis.revision import write_landing, write_revision
from orchestrator.diagnosis.setup import Setup, known_otherwise, names_of, set_up
from orchestrator.errors import MeasuredError, UserError

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
FOREIGN = SCENARIOS.parent / "build" / "foreign"
DATA = SCENARIOS / "measured" / "example_soil" / "fit"
built = pytest.mark.skipif(not FOREIGN.is_dir(), reason="python examples/c_units/build.py builds the units in C")


def addresses_of(name: str, *overrides: str) -> Addresses:
    path = SCENARIOS / f"{name}.toml"
    return Addresses(draw_up(read_scenario(path, overrides), path))


def setup_of(name: str) -> Setup:
    path = SCENARIOS / f"{name}.toml"
    effects = load_library([beside_scenarios(LIBRARY.name)])
    return set_up(draw_up(read_scenario(path), path), [read_measured(DATA)], effects, beside_scenarios("tolerances.toml"))


def test_landings_are_called_as_their_folders_with_as_many_above_as_it_takes() -> None:
    assert names_of([Path("a/fit"), Path("a/holdout")]) == ["fit", "holdout"]
    assert names_of([Path("one/flight/data"), Path("two/flight/data"), Path("three")])[:2] == ["one/flight/data", "two/flight/data"]


def test_a_landing_given_twice_is_refused() -> None:
    with pytest.raises(MeasuredError, match="is given twice"):
        names_of([Path("a/fit"), Path("a/../a/fit")])


def test_what_the_data_say_of_every_landing_is_no_tolerance_beside() -> None:
    mass, plowing = (replace(coordinate(name), slots=((name, 1.0),)) for name in ("mass", "plowing"))
    told = [replace(coordinate("mass", 0.001), slots=(("mass", 1.0),), landing=k) for k in (0, 1)]
    assert known_otherwise([mass, plowing], told, 2) == [plowing]
    assert known_otherwise([mass, plowing], told[:1], 2) == [mass, plowing]
    assert known_otherwise([mass, plowing], [replace(told[0], landing=-1)], 2) == [plowing]


def test_a_scenario_that_is_the_twin_itself_is_refused_in_a_line() -> None:
    with pytest.raises(UserError, match="give a scenario of separate units"):
        setup_of("apollo11_zupp_twin")


@built
@pytest.mark.parametrize(("scenario", "missing"), [("apollo11_soil_c", "adhesion"), ("apollo11_descent_gnc2", "swirl")])
def test_effects_that_somebody_else_s_unit_cannot_show_are_left_out(scenario: str, missing: str) -> None:
    found = setup_of(scenario)
    assert missing in found.skipped
    assert missing not in {h.name for h in found.hypotheses}
    slots = {name for h in found.hypotheses for c in h.coordinates for name, _ in c.slots}
    assert all(name in found.base or name.startswith(SEEN) for name in slots)


def test_a_fit_by_units_names_becomes_a_landing_that_runs(tmp_path: Path) -> None:
    """As a search through the master leaves it, legs and all."""
    zupp = addresses_of("apollo11_zupp")
    revised = write_revision(tmp_path, zupp, [])
    path = write_landing(tmp_path, 1, revised, {"soil+Z.bearing_strength": [3e5], "leg-Y.damping_ratio": [0.07]}, {})
    landed = Addresses(draw_up(read_scenario(path), path))
    assert landed.number(Slot("soil+Z", "bearing_strength")) == 3e5
    assert landed.number(Slot("leg-Y", "damping_ratio")) == 0.07
    assert landed.number(Slot("soil+Y", "bearing_strength")) == zupp.number(Slot("soil+Y", "bearing_strength"))


def test_where_a_unit_is_called_as_its_place_the_address_counts() -> None:
    zupp = addresses_of("apollo11_zupp")
    assert slot_of_unit(zupp, "body.mass") is None
    assert slot_of_unit(zupp, "soil+Z.friction") == Slot("soil+Z", "friction")
    assert overlay(zupp, {"body.mass": 7000.0})["units"]["body"]["parameters"] == {"mass": 7000.0}


def test_what_the_command_line_set_is_in_the_revised_scenario(tmp_path: Path) -> None:
    said = ("body.mass=7000", "soil-Z.friction=0.6")
    zupp = addresses_of("apollo11_zupp", *said)
    assert overridden(zupp) == {Slot("body", "mass"): 7000.0, Slot("soil-Z", "friction"): 0.6}
    path = write_revision(tmp_path, zupp, [], overrides=said)
    revised = Addresses(draw_up(read_scenario(path), path))
    assert revised.number(Slot("body", "mass")) == 7000.0
    assert [revised.number(Slot(unit, "friction")) for unit in ("soil-Z", "soil+Z")] == [0.6, zupp.number(Slot("soil+Z", "friction"))]
    assert "--set body.mass=7000" in path.read_text("utf-8")
