"""Scenario files: overlays, expansion, overrides, and one line for each thing that can be wrong."""

from pathlib import Path
from typing import Any

import pytest

from orchestrator.errors import ScenarioError, UserError
from orchestrator.master.slave import Interface, Kind, Variable
from orchestrator.scenario.expand import expand
from orchestrator.scenario.parameters import start_values
from orchestrator.scenario.read import check_table, merge, read_table
from orchestrator.scenario.record import DISCRETE, matching_outputs

FOUR = """
title = "four legs"
stop_time = 1.0
[each]
leg = ["+Z", "+Y"]
[units.body]
fmu = "Body"
[units."leg{leg}"]
fmu = "Leg"
parameters = { azimuth = { "+Z" = 0.0, "+Y" = 1.5 }, mass = 3.0 }
[[connections]]
ports = ["leg{leg}.mount", "body.leg{leg#}"]
[[connections]]
from = "body.height"
to = "leg{leg}.height"
[start]
vary = "body.position_start"
zero = "leg{leg}.gap"
"""


def written(folder: Path, text: str, name: str = "case.toml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def scenario_of(folder: Path, text: str, *overrides: str) -> Any:
    path = written(folder, text)
    return expand(check_table(read_table(path), path.name), path.name, overrides)


def test_each_multiplies_units_connections_and_conditions(tmp_path: Path) -> None:
    scenario = scenario_of(tmp_path, FOUR)
    assert [(u.name, u.parameters.get("azimuth")) for u in scenario.units] == [("body", None), ("leg+Z", 0.0), ("leg+Y", 1.5)]
    assert [(c.first, c.second, c.both_ways) for c in scenario.connections] == [
        ("leg+Z.mount", "body.leg1", True),
        ("leg+Y.mount", "body.leg2", True),
        ("body.height", "leg+Z.height", False),
        ("body.height", "leg+Y.height", False),
    ]
    assert scenario.zero == ["leg+Z.gap", "leg+Y.gap"]


def test_an_overlay_replaces_values_adds_units_and_connections_and_keeps_the_order(tmp_path: Path) -> None:
    written(tmp_path, FOUR, "base.toml")
    overlay = 'extends = "base.toml"\nstop_time = 2.0\n[units.slosh]\nfmu = "Slosh"\n[[connections]]\nports = ["slosh.w", "body.effect1"]\n'
    scenario = scenario_of(tmp_path, overlay)
    assert scenario.table.title == "four legs"
    assert scenario.table.stop_time == 2.0
    assert [u.name for u in scenario.units] == ["body", "leg+Z", "leg+Y", "slosh"]
    assert len(scenario.connections) == 5


def test_merging_is_deep() -> None:
    assert merge({"a": {"b": 1, "c": 2}, "d": [1]}, {"a": {"b": 3}, "d": [2]}) == {"a": {"b": 3, "c": 2}, "d": [2]}


def test_paths_are_relative_to_the_file_that_states_them(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    written(tmp_path, FOUR.replace('"Leg"', '"legs/My Leg.fmu"').replace("stop_time", 'fmus = "built"\nstop_time'), "base.toml")
    path = written(tmp_path / "sub", 'extends = "../base.toml"')
    tree = read_table(path)
    assert tree["fmus"] == str((tmp_path / "built").resolve())
    assert tree["units"]["leg{leg}"]["fmu"] == str((tmp_path / "legs" / "My Leg.fmu").resolve())
    assert tree["units"]["body"]["fmu"] == "Body"


@pytest.mark.parametrize(("given", "said", "last"), [
    ({"inertia[1]": 5.0, "inertia": [1.0, 2.0, 3.0]}, "inertia[1]=9", ["inertia", "inertia[1]"]),
    ({"inertia": [1.0, 2.0, 3.0], "inertia[1]": 5.0}, "inertia=[4, 5, 6]", ["inertia[1]", "inertia"]),
])  # fmt: skip
def test_what_is_set_last_counts_of_a_vector_and_its_elements(given: dict[str, Any], said: str, last: list[str]) -> None:
    table = check_table({"stop_time": 1.0, "units": {"body": {"fmu": "B", "parameters": given}}}, "x")
    (unit,) = expand(table, "x", [f"body.{said}"]).units
    assert list(unit.parameters) == last
    merged = merge({"parameters": given}, {"parameters": {last[-1]: 0.0}})
    assert list(merged["parameters"]) == last


def test_set_reaches_one_unit_or_all_that_match(tmp_path: Path) -> None:
    scenario = scenario_of(tmp_path, FOUR, "leg*.mass=4", "leg+Y.mass=5.5", "body.inertia=[1, 2, 3]", "body.name=plain words")
    assert [u.parameters.get("mass") for u in scenario.units] == [None, 4, 5.5]
    assert scenario.units[0].parameters == {"inertia": [1, 2, 3], "name": "plain words"}


def test_the_order_of_stepping_can_be_stated(tmp_path: Path) -> None:
    scenario = scenario_of(tmp_path, FOUR + '[master]\norder = ["leg{leg}"]\n')
    assert [u.name for u in scenario.units] == ["leg+Z", "leg+Y", "body"]


def test_what_was_run_is_a_scenario_that_runs_the_same(tmp_path: Path) -> None:
    scenario = scenario_of(tmp_path, FOUR, "leg+Y.mass=5.5")
    again = expand(check_table(scenario.as_run(), "again"), "again")
    assert again.zero == scenario.zero == ["leg+Z.gap", "leg+Y.gap"]
    assert again.units == scenario.units
    assert again.connections == scenario.connections


WRONG = {
    "[master]\ntolerence = 1": 'case.toml: master.tolerence: unknown key; did you mean "tolerance"?',
    "[units.x]\nfmu = 'A'\nparameter = {}": 'case.toml: units.x.parameter: unknown key; did you mean "parameters"?',
    "[recrod]": 'case.toml: recrod: unknown key; did you mean "record"?',
    "[[connections]]\nport = ['a.b', 'c.d']": 'case.toml: connections.3.port: unknown key; did you mean "ports"?',
    "[[connections]]\nfrom = 'a.b'": "case.toml: connections.3: give either ports = [a, b] or both from and to",
    "[[connections]]\nports = ['a.b']": "case.toml: connections.3.ports = ['a.b']: list should have at least 2 items",
    "[master]\npasses = 0": "case.toml: master.passes = 0: input should be greater than or equal to 1",
    "[master]\ntolerance = nan": "case.toml: master.tolerance = nan: input should be",
    "[master]\nmin_interval = 1.0": "case.toml: master: min_interval 1 s exceeds max_interval 0.002 s",
    "[master]\norder = ['bdy']": 'case.toml: master.order: no unit "bdy"; did you mean "body"?',
    "[units.'b{lge}']\nfmu = 'A'": 'case.toml: b{lge}: "{lge}" is not in [each]; did you mean "leg"?',
    "[units.'b.c']\nfmu = 'A'": 'case.toml: units."b.c": a unit\'s name may hold letters',
    "[units.x]\nfmu = 'A'\nparameters = { m = { a = 1 } }": "case.toml: x.m: is a table of values by instance, but",
    "[units.'x{leg}']\nfmu = 'A'\nparameters = { m = { '+Z' = 1 } }": 'case.toml: x+Y.m: has no value for instance "+Y"',
    "[units.'x{leg}']\nfmu = 'A'\nparameters = { m = { '+Z' = 1, '+Yy' = 2 } }": 'x+Z.m: "+Yy" is no instance; did you mean "+Y"?',
    "[units.x": "case.toml: not valid TOML: ",
    "[units.x]": "case.toml: units.x.fmu: is missing; add it",
}


@pytest.mark.parametrize(("added", "message"), WRONG.items())
def test_what_is_wrong_is_said_in_one_line(tmp_path: Path, added: str, message: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        scenario_of(tmp_path, f"{FOUR}\n{added}\n")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (FOUR.replace("stop_time = 1.0", "stop_time = -1.0"), "case.toml: stop_time -1 s is not after start_time 0 s"),
        (FOUR.replace("stop_time = 1.0", ""), "case.toml: stop_time: is missing"),
        ('extends = "case.toml"', "case.toml: extends itself"),
        ('extends = "absent.toml"', "absent.toml: no such file (extended by case.toml)"),
        ("extends = 3", "case.toml: extends = 3: expects the name of one TOML file"),
        ("title = 'x'\nstop_time = 1.0", "case.toml: units: is missing"),
    ],
)
def test_whole_files_that_are_wrong(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        scenario_of(tmp_path, text)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("body", "--set body: expects unit.parameter=value"),
        ("bdy.mass=1", '--set bdy.mass=1: no unit "bdy"; did you mean "body"?'),
    ],
)
def test_overrides_that_are_wrong(tmp_path: Path, override: str, message: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        scenario_of(tmp_path, FOUR, override)
    assert message in str(caught.value)


def interface() -> Interface:
    variables = [
        Variable("mass", causality="parameter", unit="kg", minimum=1.0, maximum=1e5),
        *(Variable(f"inertia[{i}]", causality="parameter", unit="kg.m2") for i in (1, 2, 3)),
        Variable("count", Kind.INTEGER, causality="parameter"),
        Variable("on", Kind.BOOLEAN, causality="parameter"),
        Variable("label", Kind.STRING, causality="parameter"),
        Variable("pad.thrust", causality="input", unit="N"),
        *(Variable(f"pad.position[{i}]", causality="output", unit="m") for i in (1, 2, 3)),
    ]
    return Interface("Leg", {v.name: v for v in variables})


def test_values_reach_their_elements() -> None:
    given = {"mass": 2, "inertia": [1, 2.5, 3], "count": 2, "on": True, "label": "x", "pad.thrust": 5.0, "inertia[2]": 9}
    assert start_values("leg", interface(), given) == {
        "mass": 2.0, "inertia[1]": 1.0, "inertia[2]": 9.0, "inertia[3]": 3.0, "count": 2, "on": True, "label": "x", "pad.thrust": 5.0,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"mas": 1}, 'leg.mas: unknown parameter; did you mean "mass"?'),
        ({"mass": 0.5}, "leg.mass = 0.5: is below its minimum 1 kg; give a value from 1 up to 100000"),
        ({"mass": 2e5}, "leg.mass = 200000.0: is above its maximum 100000 kg; give"),
        ({"mass": float("nan")}, "leg.mass = nan: is not a number, expects a value in kg"),
        ({"mass": "heavy"}, "leg.mass = 'heavy': expects a number in kg"),
        ({"mass": True}, "leg.mass = True: expects a number in kg"),
        ({"inertia": [1, 2]}, "leg.inertia: gives 2 values, expects 3; give one for each of inertia[1] ..."),
        ({"inertia": 1}, "leg.inertia: gives 1 value, expects 3"),
        ({"count": 1.5}, "leg.count = 1.5: expects a whole number"),
        ({"on": 1}, "leg.on = 1: expects true or false"),
        ({"label": 1}, "leg.label = 1: expects a string"),
        ({"pad.position": [1, 2, 3]}, "leg.pad.position: is an output, expects a parameter or an input"),
    ],
)
def test_values_a_unit_cannot_hold(given: dict[str, Any], message: str) -> None:
    with pytest.raises(UserError) as caught:
        start_values("leg", interface(), given)
    assert message in str(caught.value)


def test_globs_choose_outputs_with_and_without_index() -> None:
    units = {"leg+Z": interface(), "leg+Y": interface()}
    assert matching_outputs(["leg+Z.pad.position"], units, "x") == [[f"pad.position[{i}]" for i in (1, 2, 3)], []]
    assert matching_outputs(["leg*.pad.position[2]"], units, "x") == [["pad.position[2]"]] * 2
    with pytest.raises(ScenarioError, match=r'"leg\.z" matches no output; known here'):
        matching_outputs(["leg.z"], units, "x")
    with pytest.raises(ScenarioError, match=r'did you mean "leg\+Z\.pad\.position"'):
        matching_outputs(["leg+Z.pad.postion"], units, "x")


def test_only_boolean_and_integer_outputs_can_be_located() -> None:
    kinds = {"contact": Kind.BOOLEAN, "contact_time": Kind.REAL, "stage": Kind.INTEGER}
    variables = [Variable(name, kind, "output") for name, kind in kinds.items()]
    interfaces = {"soil+Z": Interface("Soil", {v.name: v for v in variables})}
    assert matching_outputs(["soil*.*"], interfaces, "here", DISCRETE) == [["contact", "stage"]]
    with pytest.raises(ScenarioError, match=r'here: "soil.*contact_time" matches no output'):
        matching_outputs(["soil*.contact_time"], interfaces, "here", DISCRETE)
