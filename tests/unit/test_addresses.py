"""Addresses of the diagnosis in a scenario of separate units, and the overlay made of new values."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from orchestrator.blueprint import Blueprint, draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses, Slot, known_addresses
from orchestrator.diagnosis.effects.effect import Insert
from orchestrator.diagnosis.overlay import Change, overlay, write_overlay
from orchestrator.diagnosis.recorded import column, contact_columns, twin_column
from orchestrator.diagnosis.twin_parameters import twin_parameters
from orchestrator.errors import AddressError
from orchestrator.master.slave import Kind
from orchestrator.results.schema import LegChannels

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
LEGS = ("+Z", "+Y", "-Z", "-Y")


def drawn(name: str, **parameters: object) -> Blueprint:
    path = SCENARIOS / f"{name}.toml"
    return draw_up(read_scenario(path, [f"{key.replace('__', '.')}={value}" for key, value in parameters.items()]), path)


@pytest.fixture(scope="module")
def zupp() -> Addresses:
    return Addresses(drawn("apollo11_zupp"))


@pytest.fixture(scope="module")
def adams() -> Addresses:
    return Addresses(drawn("apollo11_adams"))


def test_a_soil_parameter_is_that_of_every_soil(zupp: Addresses) -> None:
    assert zupp.resolve("soil.friction") == [Slot(f"soil{leg}", "friction") for leg in LEGS]
    assert zupp.base_value("soil.friction").tolist() == [0.33]
    assert zupp.twin("soil.friction") == [f"soil.friction[{k}]" for k in (1, 2, 3, 4)]


def test_one_leg_s_soil_is_one_element_of_the_twin(zupp: Addresses) -> None:
    assert zupp.resolve("soil[-Z].friction") == [Slot("soil-Z", "friction")]
    assert zupp.twin("soil[-Z].friction") == ["soil.friction[3]"]


def test_one_component_of_a_vector_under_one_leg(zupp: Addresses) -> None:
    assert zupp.resolve("soil[+Y].ground_origin[1]") == [Slot("soil+Y", "ground_origin[1]")]
    assert zupp.twin("soil[+Y].ground_origin[1]") == ["soil.ground_origin[4]"]


def test_a_leg_s_parameter_is_shared_in_the_twin_and_has_none_for_one_leg(zupp: Addresses) -> None:
    assert zupp.twin("gear.transition_width") == ["transition_width"]
    assert zupp.twin("gear[+Z].transition_width") is None
    assert zupp.base_value("gear.primary_load").tolist() == [20017.0, 42358.0]


def test_short_names_are_those_of_the_data_format(zupp: Addresses) -> None:
    assert zupp.base_value("attitude").tolist() == [0.263370, 0.016459, 0.044419]
    assert zupp.twin("attitude") == ["yaw_start", "pitch_start", "roll_start"]
    assert zupp.base_value("mass").tolist() == [7063.5]
    assert len(zupp.resolve("mass")) == 5
    assert zupp.twin("mass") == ["mass"]
    assert zupp.base_value("velocity_body").tolist() == [-0.5730, -0.6147, -0.2130]
    assert zupp.base_value("ground_slope").tolist() == [0.078540]


def test_a_clock_is_no_unit_s_parameter(zupp: Addresses) -> None:
    assert zupp.resolve("clock.rates") == []
    assert zupp.base_value("clock.rates").tolist() == [0.0]
    assert zupp.twin("clock.rates") == []


def test_the_unit_of_measure_is_that_of_the_fmu(zupp: Addresses) -> None:
    assert zupp.unit_of_measure("soil.damping") == "N.s/m"
    assert zupp.unit_of_measure("mass") == "kg"


@pytest.mark.parametrize(
    ("address", "says"),
    [
        ("soil.frition", 'RegolithContact has no parameter "frition"; did you mean "friction"?'),
        ("sole.friction", 'no place "sole"; did you mean "soil"?'),
        ("soil[+X].friction", 'no leg "+X" in [results.legs]; did you mean'),
        ("body[+Z].mass", "body is not one a leg; write body.mass"),
        ("masss", 'is no address; did you mean "mass"?'),
        ("body.rates_start[4]", "rates_start has 3 elements"),
        ("body.position", "no parameter"),
        ("soil..x", "is no address"),
    ],
)
def test_an_unknown_address_names_the_nearest(zupp: Addresses, address: str, says: str) -> None:
    with pytest.raises(AddressError) as error:
        zupp.resolve(address)
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_every_known_address_resolves(zupp: Addresses) -> None:
    for address in known_addresses(zupp):
        assert zupp.resolve(address)
        assert np.isfinite(zupp.base_value(address)).all()


@pytest.mark.parametrize(
    ("channel", "recorded", "in_twin"),
    [
        ("rates.roll", "sensor.telemetry.roll", "sensor.telemetry.roll"),
        ("attitude.yaw", "body.attitude.yaw", "attitude.yaw"),
        ("stroke.-Z.left", "leg-Z.left.stroke", "leg3.left.stroke"),
        ("penetration.+Y", "soil+Y.penetration", "soil2.penetration"),
        ("skid.+Z", "soil+Z.skid", "soil1.skid"),
        ("contact_time.-Y", "soil-Y.contact_time", "soil4.contact_time"),
        ("peak.rates.roll", "sensor.telemetry.roll", "sensor.telemetry.roll"),
        ("leg+Z.primary.load", "leg+Z.primary.load", "leg1.primary.load"),
        ("body.body.position[1]", "body.body.position[1]", "body.position[1]"),
    ],
)
def test_a_channel_has_a_recorded_column_and_one_of_the_twin(zupp: Addresses, channel: str, recorded: str, in_twin: str) -> None:
    assert column(zupp, channel) == recorded
    assert twin_column(zupp, channel) == in_twin


def test_an_unknown_channel_names_the_nearest(zupp: Addresses) -> None:
    with pytest.raises(AddressError, match=r'unit leg\+Z has no output "primry.load"; did you mean "primary.load"'):
        column(zupp, "leg+Z.primry.load")
    with pytest.raises(AddressError, match="no leg"):
        column(zupp, "skid.+X")


def run_with(tree: dict[str, object], name: str = "apollo11_zupp") -> Addresses:
    path = SCENARIOS / f"{name}.toml"
    return Addresses(draw_up(read_scenario(path, changes=tree), path))


def test_an_overlay_sets_what_it_says_and_nothing_else(zupp: Addresses) -> None:
    soils = {"soil.friction": 0.5, "soil[-Y].bearing_strength": 1e5}
    changed = soils | {"body.rates_start[2]": 0.01, "mass": 6000.0, "gear.primary_load[2]": 40000.0, "clock.rates": 0.1}
    changed["attitude"] = [0.1, 0.2, 0.3]  # type: ignore[assignment]
    new = run_with(overlay(zupp, changed))
    assert new.base_value("soil.friction").tolist() == [0.5]
    assert new.base_value("soil.bearing_strength").tolist() == [350254.0, 350254.0, 350254.0, 1e5]
    assert new.base_value("body.rates_start").tolist() == [-0.0108, 0.01, -0.05]
    assert new.base_value("gear.primary_load").tolist() == [20017.0, 40000.0]
    assert new.base_value("gear.azimuth").tolist() == zupp.base_value("gear.azimuth").tolist()
    assert new.base_value("mass").tolist() == [6000.0]
    assert new.base_value("attitude").tolist() == [0.1, 0.2, 0.3]
    touched = {"friction", "bearing_strength", "rates_start[2]", "mass", "vehicle_mass", "primary_load[2]"}
    touched |= {"yaw_start", "pitch_start", "roll_start"}
    for unit, interface in zupp.blueprint.interfaces.items():
        for variable in interface.of("parameter"):
            if variable.name not in touched and variable.kind is not Kind.STRING:
                assert new.number(Slot(unit, variable.name)) == zupp.number(Slot(unit, variable.name))


def test_an_overlay_goes_over_an_overlay_and_over_tables_by_instance(adams: Addresses) -> None:
    first = run_with(overlay(adams, {"soil[+Z].friction": 0.5}), "apollo11_adams")
    again = overlay(first, {"soil[+Y].friction": 0.7, "gear[+Z].azimuth": 0.01})
    new = run_with(again, "apollo11_adams")
    assert new.base_value("soil.friction").tolist() == [0.5, 0.7, 0.36, 0.36]
    assert new.base_value("gear.azimuth").tolist()[:2] == [0.01, 1.5707963267948966]


def test_an_inserted_unit_comes_with_parameters_and_connections(zupp: Addresses) -> None:
    connections = [{"from": "body.rates.roll", "to": "again.rates.roll"}]
    insert = Insert.model_validate({"unit": "again", "fmu": "RateSensor", "parameters": {"scale": 1.1}, "connections": connections})
    new = run_with(overlay(zupp, {}, [insert]))
    assert "again" in new.blueprint.interfaces
    assert new.number(Slot("again", "scale")) == 1.1


def test_a_body_s_effect_port_that_is_taken_is_replaced_by_a_free_one(zupp: Addresses) -> None:
    entry = {"unit": "one", "fmu": "GuidanceControl", "connections": [{"ports": ["one.engine", "body.effect1"]}]}
    first = run_with(overlay(zupp, {}, [Insert.model_validate(entry)]))
    other = entry | {"unit": "two", "connections": [{"ports": ["two.engine", "body.effect1"]}]}
    assert overlay(first, {}, [Insert.model_validate(other)])["connections"] == [{"ports": ["two.engine", "body.effect2"]}]


def test_a_value_of_the_wrong_length_is_refused(zupp: Addresses) -> None:
    with pytest.raises(AddressError, match="is given 2 numbers, expects 3"):
        overlay(zupp, {"rates": [0.1, 0.2]})


def test_a_written_overlay_runs_from_any_folder_and_says_why(zupp: Addresses, tmp_path: Path) -> None:
    damping = Change("soil.damping", 2e4, 3e3, "N.s/m", "the regolith resists\nsinking")
    rates = Change("rates", [0.0, 0.01, 0.02], [1e-3] * 3, "rad/s")
    path = write_overlay(tmp_path / "deep" / "revised.toml", zupp, [damping, rates], remarks=["found by a search"])
    text = path.read_text()
    assert "# soil.damping = 20000 ± 3e+03 N.s/m: the regolith resists sinking\n" in text
    assert "# found by a search\n" in text
    new = Addresses(draw_up(read_scenario(path), path))
    assert new.base_value("soil.damping").tolist() == [2e4]
    assert new.base_value("rates").tolist() == [0.0, 0.01, 0.02]
    assert new.results.references is not None
    assert (path.parent / new.results.references).is_file()


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        ({"leg+Z__transition_width": 2e-3}, "leg+Z.transition_width is 0.002 and leg+Y.transition_width 0.001, the twin has one for both"),
        ({"body__mass": 7000.0}, "body.mass is 7000 and leg+Z.vehicle_mass 7063.5"),
        ({"soil+Z__footpad_radius": 0.3}, "footpad_radius"),
    ],
)
def test_a_scenario_that_the_twin_cannot_stand_in_for_says_why(setting: dict[str, float], says: str) -> None:
    found, reason = twin_parameters(Addresses(drawn("apollo11_zupp", **setting)))
    assert found is None
    assert says in reason


def test_a_scenario_with_somebody_else_s_unit_has_no_twin(zupp: Addresses) -> None:
    insert = Insert.model_validate({"unit": "foreign", "fmu": "LunarLander"})
    found, reason = twin_parameters(run_with(overlay(zupp, {}, [insert])))
    assert found is None
    assert "unit foreign (LunarLander) has no part in the twin" in reason


@pytest.mark.parametrize("name", ["apollo11_zupp", "apollo11_adams"])
def test_the_twin_of_a_scenario_has_the_parameters_of_its_twin_scenario(name: str) -> None:
    found, reason = twin_parameters(Addresses(drawn(name)))
    assert found is not None, reason
    twin = drawn(f"{name}_twin")
    flat = {f"{key}[{i}]" if len(values) > 1 else key: value for key, values in found.items() for i, value in enumerate(values, 1)}
    for unit, prefix in (("lander", ""), ("guidance", "guidance.")):
        given = twin.values[list(twin.interfaces).index(unit)]
        for variable in twin.interfaces[unit].of("parameter"):
            text = variable.kind is Kind.STRING
            if text or variable.name in ("tolerance", "longest_step", "position_start[1]") or variable.name.startswith("guidance."):
                continue
            asked = given.get(variable.name, variable.start)
            assert flat.get(prefix + variable.name, number(variable.start)) == number(asked), prefix + variable.name


def number(text: object) -> float:
    """A start value as the description writes it."""
    return float({"true": "1", "false": "0"}.get(str(text).lower(), str(text)))


def test_instants_of_contact_have_the_twin_s_names_where_the_legs_have_and_those_of_the_units_elsewhere(zupp: Addresses) -> None:
    assert contact_columns(zupp) == {leg: f"soil{k}.contact_time" for k, leg in enumerate(("+Z", "+Y", "-Z", "-Y"), 1)}
    legs = {"front": LegChannels(leg="leg+Z", soil="soil+Z"), "deaf": LegChannels(leg="leg+Y", soil="sensor")}
    other: Any = SimpleNamespace(results=SimpleNamespace(legs=legs), blueprint=zupp.blueprint, where="other.toml")
    assert contact_columns(other) == {"front": "soil+Z.contact_time"}
