"""The library of effects: every file reads, names parameters that exist, and a broken one is refused in one line."""

from pathlib import Path

import pytest

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.effects import Effect, load_effect, load_library
from orchestrator.diagnosis.overlay import overlay
from orchestrator.diagnosis.places import CLOCK, parse, spelt_out
from orchestrator.errors import EffectError

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
EFFECTS = load_library([SCENARIOS / "candidates"])
ZUPP = SCENARIOS / "apollo11_zupp.toml"
TEXT = (SCENARIOS / "candidates" / "layering.toml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def zupp() -> Addresses:
    return Addresses(draw_up(read_scenario(ZUPP), ZUPP))


def targets(effect: Effect) -> list[tuple[str, str, str]]:
    """(address, unit of the parameter, operation) of every target."""
    return [(address, it.unit, it.operation) for it in effect.parameters for _, address in it.signed_targets()]


def test_the_library_has_at_least_forty_effects() -> None:
    assert len(EFFECTS) >= 40
    assert all(effect.name == name for name, effect in EFFECTS.items())


@pytest.mark.parametrize("name", EFFECTS)
def test_every_target_exists_in_units_and_twin_with_its_unit_of_measure(name: str, zupp: Addresses) -> None:
    for address, unit, operation in targets(EFFECTS[name]):
        assert len(zupp.base_value(address)) >= 1
        assert zupp.twin(address) is not None, f"the twin has no {address}"
        assert unit == ("1" if operation == "scale" else zupp.unit_of_measure(address) or "1"), address
        if parse(spelt_out(address)[0]).place != CLOCK:
            assert zupp.resolve(address)


@pytest.mark.parametrize("name", EFFECTS)
def test_an_effect_at_its_start_is_a_scenario_that_can_be_drawn_up(name: str, zupp: Addresses) -> None:
    values = {address: zupp.base_value(address) for address, _, _ in targets(EFFECTS[name])}
    insert = EFFECTS[name].insert
    draw_up(read_scenario(ZUPP, changes=overlay(zupp, values, [insert] if insert else [])), ZUPP)


@pytest.mark.parametrize("name", EFFECTS)
def test_starts_are_well_inside_prior_and_limits(name: str) -> None:
    for parameter in EFFECTS[name].parameters:
        low, high = parameter.limits
        for start in parameter.starts:
            assert abs(start - parameter.null) <= 3.0 * parameter.prior.sigma
            assert low <= start <= high


def test_twins_are_mutual_or_at_least_there() -> None:
    for effect in EFFECTS.values():
        assert effect.name not in effect.twins
        assert all(twin in EFFECTS for twin in effect.twins)


def test_a_target_with_a_minus_moves_the_other_way() -> None:
    assert EFFECTS["cg_offset"].parameters[0].signed_targets() == [(1.0, "gear.cg_offset[1]"), (-1.0, "guidance.thrust_offset[1]")]


def test_starts_of_an_effect_are_taken_together() -> None:
    assert EFFECTS["layering"].starts == [{"stiffness": 3e5, "depth": 0.0}, {"stiffness": 1e6, "depth": 0.02}]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("physics  ", "fysics  ", 'fysics: unknown key; did you mean "physics"?'),
        ("operation = \"add\"", "operatoin = \"add\"", 'parameters.1.operatoin: unknown key; did you mean "operation"?'),
        ('"soil.layer_stiffness"', '"sole.layer_stiffness"', 'no place "sole"; did you mean "soil"?'),
        ('"soil.layer_stiffness"', '"masss"', 'did you mean "mass"?'),
        ("starts    = [300000.0, 1000000.0]", "starts    = [-300000.0, 1000000.0]", "start -300000 is beyond the limits"),
        ("starts    = [300000.0, 1000000.0]", "starts    = [300000.0]", "stiffness 1, depth 2; give as many of each"),
        ("limits    = [0.0, 20000000.0]", "limits    = [20000000.0, 0.0]", "give the lower one first"),
        ("sigma = 1000000.0", "sigma = 0.0", "parameters.1.prior.sigma = 0.0"),
        ("sigma = 1000000.0", "sigma = nan", "parameters.1.prior.sigma"),
        ('"half-normal"', '"uniform"', "parameters.1.prior.shape = 'uniform'"),
        ('"conservative"', '"perpetual"', "energy = 'perpetual'"),
        ('name      = "depth"', 'name      = "stiffness"', 'parameter "stiffness" is there 2 times'),
        ("title  ", "title = ", "not valid TOML"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_file_is_said_in_one_line(tmp_path: Path, old: str, new: str, says: str) -> None:
    assert old in TEXT
    path = tmp_path / "mine.toml"
    path.write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(EffectError) as error:
        load_effect(path)
    assert says in str(error.value)
    assert "mine.toml" in str(error.value)
    assert "\n" not in str(error.value)
    assert error.value.exit_code == 2


def test_a_library_refuses_missing_and_empty_folders_two_of_a_name_and_unknown_twins(tmp_path: Path) -> None:
    with pytest.raises(EffectError, match="no such folder"):
        load_library([tmp_path / "nowhere"])
    with pytest.raises(EffectError, match="holds no effect"):
        load_library([tmp_path])
    (tmp_path / "layering.toml").write_text(TEXT, encoding="utf-8")
    with pytest.raises(EffectError, match="an effect layering is also in"):
        load_library([SCENARIOS / "candidates", tmp_path])
    with pytest.raises(EffectError, match="twins: no effect compaction_exponent"):
        load_library([tmp_path])
