"""Units of FMI 3.0: reading, arrays and types, states, early returns, and what they are refused."""

from pathlib import Path

import numpy as np
import pytest
from fmi3_c_sample import c_sample3
from fmi_samples import sample_fmus

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.errors import StepError, UnitError
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.load import load
from orchestrator.fmi.texts import text_of
from orchestrator.fmi.unit import FmuUnit
from orchestrator.master.slave import Binding, Kind, Status, Value
from orchestrator.scenario.parameters import start_values
from orchestrator.simulation import Simulation, run_scenario

INPUTS = ["u[1]", "u[2]", "u[3]", "k", "flags[2]"]
OUTPUTS = ["y[1]", "y[2]", "x", "k_out", "any", "steps", "big_out", "mode_out", "small_out"]


def unit(inputs: list[str], outputs: list[str], coupled: int, state: bool = True, **values: Value) -> tuple[FmuUnit, Binding]:
    made = load("three", read_interface(c_sample3(state)))
    binding = Binding(inputs, [], outputs, coupled, np.zeros(len(inputs)), np.zeros(len(outputs)))
    made.bind(binding)
    made.set_up(0.0, 1.0, values)
    return made, binding


def scenario(folder: Path, text: str, state: bool = True) -> Path:
    path = folder / "three.toml"
    fmu = c_sample3(state)
    path.write_text(text.replace("THREE", fmu.as_posix()).replace("TWO", (sample_fmus() / "SampleMass.fmu").as_posix()))
    return path


def test_arrays_are_read_as_elements_with_the_dimensions_their_structural_parameters_start_with() -> None:
    interface = read_interface(c_sample3())
    assert interface.fmi_version == "3.0"
    assert [v.name for v in interface.vectors["m"]] == [f"m[{i}]" for i in range(1, 7)]
    assert [v.start for v in interface.vectors["m"]] == ["1", "0", "0", "0", "1", "0"]
    assert [v.name for v in interface.vectors["reading"]] == ["reading[1]", "reading[2]"]      # an alias
    kinds = {name: interface.variables[name].kind for name in ("big", "mode", "any", "said", "picture", "tick", "gain")}
    assert list(kinds.values()) == [Kind.INTEGER, Kind.INTEGER, Kind.BOOLEAN, Kind.STRING, Kind.BINARY, Kind.CLOCK, Kind.REAL]
    assert interface.claims("canGetAndSetFMUstate")
    assert interface.claims("hasEventMode")


def test_every_type_travels_both_ways() -> None:
    given = {"gain": 0.5, "m[4]": 1.0, "big": 2**63 + 1, "mode": 2, "small": -7}
    three, binding = unit(INPUTS, OUTPUTS, 2, **given)
    binding.u[:] = 1.0, 2.0, 4.0, -5.0, 1.0
    three.begin()
    assert three.step(0.0, 0.5) is Status.OK
    three.observe()
    assert binding.y.tolist() == [0.5, 1.5, 3.5, -4.0, 1.0, 1.0, float(2**63), 2.0, -7.0]
    three.close()


def test_elements_that_nothing_feeds_keep_their_start_value() -> None:
    three, binding = unit(["u[2]", "flags[1]"], ["y[2]", "any"], 1, **{"u[3]": 9.0, "m[6]": 1.0})
    binding.u[:] = 5.0, 0.0
    three.begin()
    three.step(0.0, 0.1)
    assert binding.y.tolist() == [28.0, 0.0]      # 2 (1·0 + 5·1 + 9·1)
    three.set_up(0.0, 1.0, {})
    binding.u[1] = 1.0
    three.begin()
    assert binding.y.tolist() == [10.0, 1.0]
    three.close()


def test_two_names_of_one_variable_both_give_its_value() -> None:
    three, binding = unit([], ["y[1]", "y[2]", "reading[1]", "reading[2]", "x"], 5)
    three.begin()
    assert binding.y.tolist() == [2.0, 4.0, 2.0, 4.0, 0.0]
    three.close()


def test_strings_travel() -> None:
    three, binding = unit(["label"], ["said"], 0, mode=2)
    other, given = unit([], ["said"], 0, label="LM")
    other.begin()
    binding.u[0] = given.y[0]
    three.begin()
    three.step(0.0, 0.1)
    third, last = unit(["label"], ["said"], 0)
    last.u[0] = binding.y[0]
    third.begin()
    third.step(0.0, 0.1)
    again, expected = unit([], ["said"], 0, label="LM off on")
    again.begin()
    assert last.y[0] == expected.y[0]
    for it in (three, other, third, again):
        it.close()


def test_an_integer_too_large_for_its_type_is_refused_with_both_values() -> None:
    three, binding = unit(["small"], ["small_out"], 0)
    three.begin()
    binding.u[0] = 128.0
    with pytest.raises(StepError, match="three: small is sent 128, Int8 takes -128 to 127"):
        three.step(0.0, 0.1)
    three.close()


def test_a_restored_or_deserialised_unit_repeats_its_step_to_the_bit() -> None:
    three, binding = unit(INPUTS, OUTPUTS, 2)
    binding.u[:] = 0.1, 0.2, 0.3, 0.0, 0.0
    three.begin()
    three.step(0.0, 0.1)
    three.save()
    data = three.serialised_state()
    outcomes = []
    for adopt in (False, False, True):
        three.step(0.1, 0.1)
        three.observe()
        outcomes.append(binding.y.tobytes())
        if adopt:
            three.adopt_state(data)
        three.restore()
    assert len(set(outcomes)) == 1
    three.close()


@pytest.mark.parametrize("state", [True, False])
def test_an_early_return_is_a_discard_that_tells_how_far_the_unit_came(state: bool) -> None:
    """One that could not go back is not allowed to return early, and discards."""
    three, _ = unit(INPUTS, OUTPUTS, 2, state, wall=0.15)
    three.begin()
    assert three.step(0.1, 0.1) is Status.DISCARD
    assert three.reached == pytest.approx(0.15)
    three.close()


PAIR = """
stop_time = 0.4
[units.three]
fmu = "THREE"
[units.two]
fmu = "TWO"
[[connections]]
from = "three.y[2]"
to = "two.end.force"
[[connections]]
from = "two.end.velocity"
to = "three.u[1]"
[master]
max_interval = 0.01
tolerance = 1e-4
"""


def test_units_of_both_versions_run_side_by_side_and_repeat_their_intervals(tmp_path: Path) -> None:
    """y[2] = 2·2 N stands still, so v = 4 t and x' = 4 t + 5. Tolerance: rounding, since the velocity is a line in time."""
    result = run_scenario(scenario(tmp_path, PAIR))
    assert result.trusted, result.message
    assert {r.fmi_version: r.stepped for r in result.unit_records} == dict.fromkeys(("3.0", "2.0"), "2 passes, rolled back between")
    assert result.columns["two.end.velocity"][-1] == pytest.approx(1.6, abs=1e-12)
    assert result.columns["three.x"][-1] == pytest.approx(0.5 * 4 * 0.16 + 5 * 0.4, abs=0.01)
    assert {r.trial.serialisation for r in result.unit_records if r.trial} == {"true"}


TEXT = PAIR + """
[units.last]
fmu = "THREE"
[[connections]]
from = "three.said"
to = "last.label"
"""


@pytest.mark.parametrize("isolate", [True, False])
def test_text_travels_between_units_wherever_they_run(tmp_path: Path, isolate: bool) -> None:
    path = scenario(tmp_path, TEXT)
    changes = {"units": {"last": {"isolate": isolate}}}
    simulation = Simulation(draw_up(read_scenario(path, ["three.label=LM", "three.mode=on"], changes), path))
    assert simulation.run().complete
    unit = simulation.system.slaves[2]
    said = unit.interface.variables["said"]
    unit.bind(Binding([], [], ["said"], 0, np.zeros(0), y := np.zeros(1)))
    unit.observe()
    unit.exchange()
    simulation.close()
    assert (said.kind, text_of(y[0])) == (Kind.STRING, "LM on off")


def test_early_returns_are_met_by_everybody(tmp_path: Path) -> None:
    result = run_scenario(scenario(tmp_path, PAIR), ["three.wall=0.153"])
    ends = [round(row.time + row.interval, 9) for row in result.log if row.accepted]
    assert {0.153, 0.306} <= set(ends)
    assert {row.limit for row in result.log if not row.accepted} == {"early return of three"}


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("three.error_from=0.2", "three: doStep returned Error: the tank is empty"),
        ("three.end_from=0.2", "three: asks to end the run in the step from t = 0.2 s: we have landed"),
    ],
)
def test_a_unit_that_fails_or_wants_to_end_is_named(tmp_path: Path, override: str, words: str) -> None:
    result = run_scenario(scenario(tmp_path, PAIR), [override])
    assert words in result.message
    assert "\n" not in result.message
    assert result.times[-1] == pytest.approx(0.2)


def test_parameters_are_given_by_vector_by_element_or_by_the_name_of_a_value() -> None:
    interface = read_interface(c_sample3())
    assert start_values("three", interface, {"mode": "on", "u": [4, 5, 6], "m[2]": 1, "label": "LM"}) == {
        "mode": 2, "u[1]": 4.0, "u[2]": 5.0, "u[3]": 6.0, "m[2]": 1.0, "label": "LM",
    }  # fmt: skip


REFUSED = {
    ("mode", "of"): """three.mode = 'of': is none of its values; did you mean "off"?""",
    ("mode", 3): "three.mode = 3: is above its maximum 2",
    ("small", 200): "three.small = 200: is above its maximum 127",
    ("n", 4): "three.n = 4: a structural parameter stays at its start value 3",
    ("picture", "00"): "three.picture = '00': is of type Binary, which this master does not set",
    ("u", (1, 2)): "three.u: gives 2 values, expects 3",
}


@pytest.mark.parametrize(("given", "message"), REFUSED.items())
def test_a_value_that_does_not_fit_is_refused_in_one_line(given: tuple[str, Value | tuple[int, ...]], message: str) -> None:
    with pytest.raises(UnitError) as caught:
        start_values("three", read_interface(c_sample3()), {given[0]: list(given[1]) if isinstance(given[1], tuple) else given[1]})
    assert message in str(caught.value)
