"""What was fitted becomes values by address, a scenario that can be run, a library's entry."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.believed import belief_of, without_effect
from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.effects import load_library
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.found_term import FoundTerm, write_effect
from orchestrator.diagnosis.from_twin import said_by_address
from orchestrator.diagnosis.landing import RATES, SPIN
from orchestrator.diagnosis.master_lander import unit_base, unit_slots
from orchestrator.diagnosis.measured import read_measured
from orchestrator.diagnosis.moves import Move, Named, applied_moves, effect_moves
from orchestrator.diagnosis.observation import Observation, Reading
from orchestrator.diagnosis.outcome import Estimate
from orchestrator.diagnosis.overlay import overlay
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.recorded import column, cosimulation_column, twin_column
from orchestrator.diagnosis.revision import write_landing, write_revision
from orchestrator.diagnosis.setup import set_up
from orchestrator.diagnosis.twin_parameters import twin_parameters
from orchestrator.errors import AddressError

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
ZUPP = SCENARIOS / "apollo11_zupp.toml"
EFFECTS = load_library([SCENARIOS / "candidates"])
TERM = FoundTerm(
    "momentum_transfer",
    "Momentum transfer",
    "Soil set in motion takes momentum.",
    "F_n += c (|δ̇|/0.1)²",
    "soil.normal",
    "dissipative",
    "soil.normal_term",
    Estimate(120.0, 9.0, "N"),
    {"soil.normal_term_rate": 2.0, "soil.normal_term_phase": 1},
)


def addresses_of(path: Path) -> Addresses:
    return Addresses(draw_up(read_scenario(path), path))


@pytest.fixture(scope="module")
def zupp() -> Addresses:
    return addresses_of(ZUPP)


def named(name: str, **parameters: float) -> Named:
    units = {it.name: it.unit for it in EFFECTS[name].parameters}
    return Named(EFFECTS[name], {key: Estimate(value, 0.1 * abs(value), units[key]) for key, value in parameters.items()})


def test_a_later_move_acts_on_what_the_earlier_left(zupp: Addresses) -> None:
    moves = [Move("soil.friction", 0.4, "set"), Move("soil[-Z].friction", 0.1), Move("soil.friction", np.log(2.0), "scale")]
    values = applied_moves(zupp, moves).values
    np.testing.assert_allclose(values["soil.friction"], [0.8, 0.8, 1.0, 0.8])
    np.testing.assert_allclose(values["soil[-Z].friction"], [1.0])


def test_clocks_are_kept_apart_from_the_units(zupp: Addresses) -> None:
    applied = applied_moves(zupp, [*named("clock_offset", offset=0.03).moves(), Move("time.origin", 0.004)])
    assert applied.values == {}
    assert applied.seen == {"clock.rates": 0.03, "time.origin": 0.004}


def test_an_effect_s_minus_takes_away(zupp: Addresses) -> None:
    values = applied_moves(zupp, named("cg_offset", y=0.05).moves()).values
    assert set(values["gear.cg_offset[1]"]) == {0.05}
    assert values["guidance.thrust_offset[1]"] == [-0.05]


def test_a_parameter_that_the_effect_does_not_have_is_refused() -> None:
    with pytest.raises(AddressError, match=r"inertial_drag: no parameter damping; it has drag"):
        effect_moves(EFFECTS["inertial_drag"], {"damping": 1.0})


def test_what_the_twin_was_given_comes_back_from_the_units(zupp: Addresses) -> None:
    """Values by the twin's names -> by address -> overlay -> the scenario's twin: the same values."""
    given = {
        "mass": 7000.0,
        "velocity_start[2]": -0.6,
        "pitch_start": 0.02,
        "soil.friction[3]": 0.4,
        "soil.ground_origin[4]": 0.1,
        "cg_offset[2]": 0.03,
        "transition_width": 2e-3,
        "guidance.swirl": 0.01,
        "plume.share": 0.3,
        "azimuth[2]": 1.5,
    }
    said = said_by_address(zupp, given | {"sensor.time_constant": 0.05, "clock.rates": 0.02, "tolerance": 1e-3})
    assert said.seen == {"clock.rates": 0.02}
    tree = overlay(zupp, said.values, [EFFECTS["ground_effect"].insert])
    back, reason = twin_parameters(Addresses(draw_up(read_scenario(ZUPP, changes=tree), ZUPP)))
    assert back is not None, reason
    vectors = zupp.twin_interface.vectors
    found = {it.name: value for name, values in back.items() if name in vectors for it, value in zip(vectors[name], values, strict=True)}
    assert {name: found[name] for name in given} == given
    assert back["sensor.time_constant"] == [0.05]


def test_a_fit_is_flown_with_its_effect_or_without_it(zupp: Addresses) -> None:
    watched = Observation([], [Reading("stroke.+Z", "stroke", 0.0, 0.01)])
    landings = Landings([watched, watched], [{"mass": 7063.5, "pitch_start": 0.02}, {"mass": 7000.0}], [1.0, 1.0])
    slip = tuple((f"soil.friction[{k}]", 1.0) for k in (1, 2, 3, 4))
    pitch = Coordinate("pitch", (("pitch_start", 1.0),), 0.01, landing=0)
    coordinates = (pitch, Coordinate("friction", slip, 0.1, mean=0.33, operation="set"))
    nothing = np.zeros((2, 2))
    fit = Fit(coordinates, np.array([1.0, -0.3]), np.array([0.1, 0.2]), np.zeros(2), nothing, nothing, 0.0)
    whole, bare = belief_of(zupp, "friction", [(landings, fit)]), without_effect(zupp, "friction", [(landings, fit)], 1)
    np.testing.assert_allclose(whole.values[0]["body.pitch_start"], [0.03])
    np.testing.assert_allclose(whole.values[1]["soil.friction"], [0.3] * 4)
    assert [float(row[0]) for row in whole.predicted if row is not None] == [0.1, 0.2]
    assert bare.values[0].keys() == {"body.pitch_start"}
    assert bare.values[1] == {"body.mass": [7000.0], "gear.vehicle_mass": [7000.0] * 4}


def test_a_search_through_the_master_speaks_of_units(zupp: Addresses) -> None:
    insert = EFFECTS["ground_effect"].insert
    assert insert is not None
    base = unit_base(zupp, [insert])
    assert base["soil-Z.friction"] == 0.33
    assert base["plume.height"] == 1.0
    assert unit_slots(zupp, "soil.friction") == [[f"soil{leg}.friction" for leg in ("+Z", "+Y", "-Z", "-Y")]]
    landings = Landings([Observation([], [])], [base], [1.0])
    coordinates = (Coordinate("share", (("plume.share", 1.0),), 0.2), Coordinate("friction", (("soil-Z.friction", 1.0),), 0.1))
    nothing = np.zeros((0, 2))
    fit = Fit(coordinates, np.array([1.0, 0.5]), np.zeros(0), np.zeros(0), nothing, nothing, 0.0)
    values = belief_of(zupp, "both", [(landings, fit)], [insert]).values[0]
    assert values == {"plume.share": [0.2], "soil-Z.friction": [0.38]}


def test_what_the_scenario_has_anyway_is_not_said(zupp: Addresses) -> None:
    assert said_by_address(zupp, {"mass": 7063.5, "soil.friction[1]": 0.33}).values == {}


def test_what_a_search_is_set_up_with_can_all_be_said_by_address(zupp: Addresses) -> None:
    measured = read_measured(SCENARIOS / "measured" / "example_soil" / "fit")
    setup = set_up(zupp.blueprint, [measured], EFFECTS, SCENARIOS / "tolerances.toml", [])
    said = said_by_address(zupp, setup.landings.bases[0]).values
    assert {address.partition(".")[0] for address in said} <= {"body", "guidance", "soil"}, "of a landing, start and ground alone differ"
    assert said_by_address(zupp, setup.landings.bases[0] | {"soil.friction[3]": 0.4}).values.keys() - said.keys() == {"soil.friction"}


@pytest.mark.parametrize("scenario", ["apollo11_zupp", "apollo11_zupp_twin"])
def test_a_twin_s_column_leads_back_to_the_recorded_one(scenario: str) -> None:
    addresses = addresses_of(SCENARIOS / f"{scenario}.toml")
    names = ("attitude.pitch", "stroke.+Z.left", "stroke.-Y.primary", "penetration.+Y", "skid.-Z", "contact_time.+Z", "rates.roll")
    for name in names:
        twin = twin_column(addresses, name)
        assert twin is not None
        assert cosimulation_column(addresses, twin) == column(addresses, name)
    body = addresses.results.body
    assert cosimulation_column(addresses, SPIN[1]) == f"{body}.body.angular_acceleration[2]"
    assert cosimulation_column(addresses, RATES[0]) == f"{body}.rates.yaw"


def test_the_revised_scenario_has_the_effects_and_not_the_nuisances(zupp: Addresses, tmp_path: Path) -> None:
    found = [named("inertial_drag", drag=2000.0), named("ground_effect", share=0.2, height=0.1), named("clock_offset", offset=0.03)]
    path = write_revision(tmp_path / "out", zupp, found, remarks=["by a search"], master={"max_interval": 5e-4})
    revised = addresses_of(path)
    assert revised.blueprint.scenario.table.master.max_interval == 5e-4
    assert revised.blueprint.scenario.table.master.tolerance == zupp.blueprint.scenario.table.master.tolerance
    assert revised.base_value("soil.inertial_drag").tolist() == [2000.0]
    assert revised.base_value("plume.share").tolist() == [0.2]
    np.testing.assert_allclose(revised.base_value("plume.height"), [np.exp(0.1)])
    assert revised.base_value("velocity_body").tolist() == zupp.base_value("velocity_body").tolist()
    assert revised.results.clock_offsets == {"rates": 0.03}
    text = path.read_text(encoding="utf-8")
    assert "# soil.inertial_drag = 2000 ± 200 N.s2/m2: Momentum transfer to the soil" in text
    assert "clock.rates = 0.03 s" in text


def test_a_landing_as_fitted_stands_on_the_revised_scenario(zupp: Addresses, tmp_path: Path) -> None:
    found = [named("inertial_drag", drag=2000.0)]
    revised = write_revision(tmp_path, zupp, found)
    nuisances = [Move("velocity_body", [-0.55, -0.6, -0.2], "set"), Move("soil.friction", 0.35, "set"), Move("time.origin", 0.004)]
    applied = applied_moves(zupp, [*nuisances, *found[0].moves()])
    path = write_landing(tmp_path, 1, revised, applied.values, applied.seen, "apollo")
    tree = tomllib.loads(path.read_text(encoding="utf-8"))
    assert tree["extends"] == "revised.toml"
    assert "landing 1 (apollo) as fitted" in tree["title"]
    landing = addresses_of(path)
    assert landing.base_value("velocity_body").tolist() == [-0.55, -0.6, -0.2]
    assert landing.base_value("soil.friction").tolist() == [0.35]
    assert landing.base_value("soil.inertial_drag").tolist() == [2000.0]
    assert "time.origin = 0.004 s" in path.read_text(encoding="utf-8")


def test_a_found_term_becomes_a_library_s_entry_and_a_revision(zupp: Addresses, tmp_path: Path) -> None:
    write_effect(tmp_path / "found", TERM)
    (entry,) = load_library([tmp_path / "found"]).values()
    assert (entry.name, entry.title) == ("momentum_transfer", "Momentum transfer")
    assert entry.parameters[0].prior.shape == "half-normal"
    revised = addresses_of(write_revision(tmp_path, zupp, [TERM.named()]))
    assert revised.base_value("soil.normal_term").tolist() == [120.0]
    assert revised.base_value("soil.normal_term_phase").tolist() == [1.0]
    assert revised.base_value("soil.normal_term_rate").tolist() == [2.0]
