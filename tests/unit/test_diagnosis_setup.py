"""From folders and a scenario to a search: names of landings, priors beside tolerances, units of somebody else, the twin itself."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from diagnosis_samples import coordinate

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses, Slot
from orchestrator.diagnosis.diagnose import beside_scenarios
from orchestrator.diagnosis.effects.library import LIBRARY, load_library
from orchestrator.diagnosis.landing import TELEMETRY
from orchestrator.diagnosis.measured import read_measured
from orchestrator.diagnosis.observation import SEEN
from orchestrator.diagnosis.overlay import overlay, overridden, slot_of_unit
from orchestrator.diagnosis.revision import write_landing, write_revision
from orchestrator.diagnosis.setup import Setup, known_otherwise, names_of, set_up
from orchestrator.errors import MeasuredError, UserError
from orchestrator.results.provenance import scenario_text
from orchestrator.scenario.read import read_table

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


def measured_with(tmp_path: Path, old: str, new: str) -> Setup:
    """The example's setup with a line of its landing.toml changed."""
    shutil.copytree(DATA, tmp_path / "data", dirs_exist_ok=True)
    text = (tmp_path / "data" / "landing.toml").read_text("utf-8")
    assert old in text
    (tmp_path / "data" / "landing.toml").write_text(text.replace(old, new, 1), "utf-8")
    return setup_with(SCENARIOS / "apollo11_zupp.toml", tmp_path / "data")


def setup_with(path: Path, data: Path) -> Setup:
    effects = load_library([beside_scenarios(LIBRARY.name)])
    return set_up(draw_up(read_scenario(path), path), [read_measured(data)], effects, beside_scenarios("tolerances.toml"))


@pytest.mark.parametrize(("value", "slow"), [(0.0, ""), (2.0, "the scenario begins 2 m above the ground")])
def test_a_scenario_that_does_not_begin_at_contact_is_not_searched_with_the_twin(tmp_path: Path, value: float, slow: str) -> None:
    path = tmp_path / "aloft.toml"
    path.write_text(f'extends = "{(SCENARIOS / "apollo11_zupp.toml").as_posix()}"\n[start]\nvalue = {value}\n', "utf-8")
    found = setup_with(path, DATA)
    assert found.why_slow.startswith(slow)
    assert bool(found.why_slow) == bool(slow)


def test_without_a_sensor_in_the_scenario_effects_of_one_are_seen_all_the_same(tmp_path: Path) -> None:
    """Rates are read where the sensor behind the twin sends them; without such an effect they are the body's."""
    path = tmp_path / "bare.toml"
    tree = read_table(SCENARIOS / "apollo11_zupp.toml")
    tree["units"].pop("sensor")
    tree["connections"] = [it for it in tree["connections"] if not any("sensor" in str(value) for value in it.values())]
    path.write_text(scenario_text(tree), "utf-8")
    found = setup_with(path, DATA)
    assert not found.why_slow
    assert {t.column for t in found.landings.observations[0].tracks if t.channel.startswith("rates.")} == set(TELEMETRY)


def test_an_effect_on_the_clock_of_a_series_that_is_not_there_is_left_out(tmp_path: Path) -> None:
    found = measured_with(tmp_path, "[series.rates]", '[series.gyros]\ncolumns = ["yaw_rate", "pitch_rate", "roll_rate"]')
    assert "no series \"rates\"" in found.skipped["clock_offset"]
    assert "clock_offset" in {h.name for h in setup_with(SCENARIOS / "apollo11_zupp.toml", DATA).hypotheses}


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("[prior.velocity_body]", '[prior."soil.plowing"]\nmean = 1454.0\nsigma = 9.0\nunit = "m/s"\n[prior.velocity_body]',
         "prior.soil.plowing: is in m/s, the scenario has it in N/m"),
        ('[values."stroke.+Z.primary"]', '[values."leg+Z.primary.load"]\nvalue = 1\nsigma = 1\nunit = "deg"\n[values."stroke.+Z.primary"]',
         "values.leg+Z.primary.load: is in rad, the scenario has it in N"),
        ("value = 0.0129\nsigma = 0.006", "low = 0.0", "values.penetration.+Y: one end, at 0, does not tell how sharply it is meant"),
    ],
)
def test_a_unit_that_is_not_the_parameter_s_and_an_end_at_zero_are_refused(tmp_path: Path, old: str, new: str, says: str) -> None:
    with pytest.raises(MeasuredError, match=re.escape(says)):
        measured_with(tmp_path, old, new)


def test_a_record_of_more_than_the_landing_is_to_be_cut(tmp_path: Path) -> None:
    data = read_measured(DATA)
    long = replace(data, series=[replace(one, times=one.times * 1000.0) for one in data.series])
    path = SCENARIOS / "apollo11_zupp.toml"
    with pytest.raises(MeasuredError, match=r"series\.\w+: spans 3\d\d\d s, the scenario lands in .* cut it to the landing"):
        set_up(draw_up(read_scenario(path), path), [long], {}, beside_scenarios("tolerances.toml"))
