"""FMUs behind the master's protocol: reading, stepping, states, messages, and what happens when they misbehave."""

import shutil
import signal
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_samples import oscillator, sample_fmus

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.checkpoint.schedule import Schedule
from orchestrator.errors import StepError, UnitError
from orchestrator.fmi import load as loading
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.slave2 import Fmi2Unit
from orchestrator.fmi.texts import text_of
from orchestrator.fmi.types import types_of
from orchestrator.fmi.unpack import content_hash, unpack
from orchestrator.master.slave import Binding, Interface, Kind, Status, Variable
from orchestrator.master.system import System
from orchestrator.simulation import Simulation, run_scenario


def mass(**values: float) -> tuple[Fmi2Unit, Binding]:
    unit = Fmi2Unit("a+Z", sample_fmus() / "SampleMass.fmu")
    binding = Binding(["end.force", "end.force_slope"], [], ["end.velocity", "position", "end.work"], 1, np.zeros(2), np.zeros(3))
    unit.bind(binding)
    unit.set_up(0.0, 1.0, values)
    unit.begin()
    return unit, binding


def moody(**values: float) -> Fmi2Unit:
    unit = Fmi2Unit("moody", sample_fmus() / "SampleMoody.fmu")
    unit.bind(Binding([], [], ["time"], 1, np.zeros(0), np.zeros(1)))
    unit.set_up(0.0, 1.0, values)
    unit.begin()
    return unit


def test_the_interface_is_read_from_the_model_description() -> None:
    interface = read_interface(sample_fmus() / "SampleMass.fmu")
    assert interface.model_name == "SampleMass"
    assert interface.claims("canGetAndSetFMUstate")
    assert not interface.claims("canInterpolateInputs")
    assert set(interface.ports["end"]) == {
        "end.force", "end.force_slope", "end.velocity", "end.velocity_mean", "end.velocity_slope", "end.work",
    }  # fmt: skip
    assert interface.variables["mass"].start == "1"


def test_a_unit_takes_inputs_steps_and_gives_its_coupled_outputs_only() -> None:
    unit, binding = mass(mass=2.0, position_start=3.0)
    assert binding.y.tolist() == [0.0, 3.0, 0.0]
    binding.u[:] = 4.0, 0.0
    assert unit.step(0.0, 0.5) is Status.OK
    assert binding.y.tolist() == [1.0, 3.0, 0.0]      # position and work wait for observe
    unit.observe()
    assert binding.y.tolist() == [1.0, 3.25, 1.0]
    unit.close()


def test_a_restored_unit_repeats_its_step_to_the_bit() -> None:
    unit, binding = mass()
    binding.u[:] = 1.7, -0.3
    unit.step(0.0, 0.1)
    unit.save()
    outcomes = []
    for _ in range(3):
        unit.step(0.1, 0.1)
        unit.observe()
        outcomes.append(binding.y.tobytes())
        unit.restore()
    assert len(set(outcomes)) == 1
    unit.close()


def test_a_state_travels_as_bytes_to_another_instance() -> None:
    unit, binding = mass()
    other, other_binding = mass()
    binding.u[:] = other_binding.u[:] = 1.0, 0.0
    unit.step(0.0, 0.5)
    unit.save()
    other.adopt_state(unit.serialised_state())
    other.restore()
    unit.step(0.5, 0.1)
    other.step(0.5, 0.1)
    assert binding.y[0] == other_binding.y[0] == pytest.approx(0.6)
    unit.close()
    other.close()


def test_set_up_again_starts_afresh() -> None:
    unit, binding = mass(position_start=1.0)
    unit.step(0.0, 0.5)
    unit.set_up(0.0, 1.0, {"position_start": 2.0})
    unit.begin()
    assert binding.y.tolist() == [0.0, 2.0, 0.0]
    unit.close()


def test_a_refused_step_is_a_discard_and_its_reason_is_kept() -> None:
    unit = moody(longest=0.1)
    assert unit.step(0.0, 0.2) is Status.DISCARD
    assert unit.messages[-1] == "interval of 0.2 s is too long for me"
    assert unit.step(0.0, 0.1) is Status.OK
    unit.close()


def test_a_fatal_unit_is_reported_in_its_own_words_and_never_touched_again() -> None:
    unit = moody(raise_from=0.05)
    with pytest.raises(StepError, match=r"moody: doStep returned Fatal: .*the ground gave way"):
        unit.step(0.1, 0.1)
    unit.close()


def test_unpacking_is_by_content_under_a_plain_name(tmp_path: Path) -> None:
    odd = tmp_path / "Ünit #1 100%.fmu"
    shutil.copy(sample_fmus() / "SampleMass.fmu", odd)
    folder = unpack(odd, content_hash(odd))
    assert folder == unpack(sample_fmus() / "SampleMass.fmu", content_hash(odd))
    assert str(folder).isascii()
    assert not set(str(folder)) & set("#+% ")
    unit = Fmi2Unit("odd", odd)
    unit.close()


def test_a_file_that_is_no_fmu_is_named(tmp_path: Path) -> None:
    broken = tmp_path / "Broken.fmu"
    broken.write_text("not a zip")
    with pytest.raises(UnitError, match=r"Broken\.fmu: not a readable FMU"):
        read_interface(broken)


def test_an_fmu_without_a_binary_for_this_machine_is_named(tmp_path: Path) -> None:
    bare = tmp_path / "Bare.fmu"
    with zipfile.ZipFile(sample_fmus() / "SampleMass.fmu") as source, zipfile.ZipFile(bare, "w") as target:
        target.writestr("modelDescription.xml", source.read("modelDescription.xml"))
    with pytest.raises(UnitError, match=r"Bare\.fmu: holds binaries for no platform, this machine is "):
        read_interface(bare)


def test_the_oscillator_of_fmus_follows_its_closed_form(tmp_path: Path) -> None:
    """Tolerance: third order, c h³ with 9e-5 m at 10 ms from the same units as functions, gives 7e-7 m at 2 ms over twice the time."""
    result = run_scenario(oscillator(tmp_path))
    expected = 0.2 * np.cos(np.sqrt(150.0) * result.times)
    assert np.abs(result.columns["spring.stretch"] - expected).max() < 7e-7
    assert result.complete
    assert result.trusted
    assert [record.stepped for record in result.unit_records] == ["2 passes, rolled back between"] * 3
    assert [(row.first, row.second) for row in result.ledger] == [("a.end", "spring.a"), ("b.end", "spring.b")]
    assert all(abs(row.leak) < 1e-5 * row.throughput for row in result.ledger)
    assert result.unit_records[1].parameters == {"mass": 2.0, "position_start": 1.2}


@pytest.mark.parametrize(("model", "warned"), [("SampleForgetful", True), ("SampleStateless", False)])
def test_a_unit_that_cannot_truly_roll_back_is_stepped_once_per_accepted_step(tmp_path: Path, model: str, warned: bool) -> None:
    once = "once = true\n" if warned else ""
    damper = f'\n[units.damper]\nfmu = "{model}"\n{once}[[connections]]\nports = ["b.end", "damper.end"]\n'
    text = {'[[connections]]\nports = ["b.end", "spring.b"]': "", "tolerance = 1e-6": "tolerance = 1e-6\npasses = 2"}
    result = run_scenario(oscillator(tmp_path, damper, **text))
    record = {r.name: r for r in result.unit_records}["damper"]
    assert record.stepped == "once per accepted step"
    assert record.steps == result.accepted
    assert any("damper: claims rollback" in w for w in result.warnings) == warned
    assert result.columns["damper.end.count"][-1] == pytest.approx(0.5, abs=1e-9)      # the trial left no trace


TELLERS = """
stop_time = 0.03
fmus = "FMUS"
[units.a]
fmu = "SampleTeller"
parameters = { count = 41, word = "contact", flag = true }
[units.b]
fmu = "SampleTeller"
ONCE
[[connections]]
from = "a.told"
to = "b.count"
[[connections]]
from = "a.seen"
to = "b.flag"
[[connections]]
from = "a.said"
to = "b.word"
[master]
max_interval = 0.01
"""


@pytest.mark.parametrize("once", ["", "once = true"])
def test_whole_numbers_truth_values_and_text_are_set_and_connected(tmp_path: Path, once: str) -> None:
    path = tmp_path / "tellers.toml"
    path.write_text(TELLERS.replace("FMUS", sample_fmus().as_posix()).replace("ONCE", once))
    simulation = Simulation(draw_up(read_scenario(path), path))
    result = simulation.run()
    assert result.complete, result.message
    assert (result.columns["b.told"][-1], result.columns["b.seen"][-1]) == (43.0, 1.0)
    teller = simulation.system.slaves[1]
    teller.bind(Binding([], [], ["said"], 0, np.zeros(0), y := np.zeros(1)))
    teller.exchange()
    assert text_of(y[0]) == "contact!!"
    simulation.close()


def test_checkpoints_are_refused_where_text_travels(tmp_path: Path) -> None:
    path = tmp_path / "tellers.toml"
    path.write_text(TELLERS.replace("FMUS", sample_fmus().as_posix()).replace("ONCE", ""))
    simulation = Simulation(draw_up(read_scenario(path), path))
    with pytest.raises(UnitError, match=r"a\.said -> b\.word: a checkpoint cannot keep text; leave --checkpoint-every out"):
        simulation.run(schedule=Schedule.asked(tmp_path, 0.01))
    simulation.close()


def test_a_unit_that_lies_about_its_rollback_is_an_error_that_names_what_differed(tmp_path: Path) -> None:
    damper = '\n[units.damper]\nfmu = "SampleForgetful"\n[[connections]]\nports = ["b.end", "damper.end"]\n'
    with pytest.raises(UnitError, match=r"damper: claims rollback .*, but end.count is 0.002 after a step and 0.004 after going back"):
        run_scenario(oscillator(tmp_path, damper, **{'[[connections]]\nports = ["b.end", "spring.b"]': ""}))


def test_a_fatal_unit_ends_the_run_and_what_was_computed_stays(tmp_path: Path) -> None:
    scenario = tmp_path / "moody.toml"
    scenario.write_text(f'stop_time = 1.0\nfmus = "{sample_fmus().as_posix()}"\n[units.m]\nfmu = "SampleMoody"\n')
    result = run_scenario(scenario, ["m.raise_from=0.1"])
    assert not result.complete
    assert not result.trusted
    assert "the ground gave way" in result.message
    assert 0.09 < result.times[-1] <= 0.1 + 1e-9


@pytest.mark.parametrize("record", ["interval = 10.0", ""])
def test_a_unit_that_fails_in_its_last_row_has_not_completed_the_run(tmp_path: Path, record: str) -> None:
    scenario = tmp_path / "moody.toml"
    head = f'stop_time = 0.2\nfmus = "{sample_fmus().as_posix()}"\n[master]\nmax_interval = 0.1\n[record]\n{record}\n'
    scenario.write_text(head + '[units.m]\nfmu = "SampleMoody"\n')
    result = run_scenario(scenario, ["m.nan_from=0.1"])
    assert "time is nan" in result.message
    assert (result.complete, result.trusted, result.interrupted) == (False, False, False)


class Overheard(Fmi2Unit):
    """Notes what it is given instead of setting it: FMI 2.0 numbers the variables of each type for themselves."""

    def __init__(self, *variables: Variable) -> None:
        self.name, self.interface = "u", Interface("U", {v.name: v for v in variables}, fmi_version="2.0")
        self._types, self._component, self.heard = types_of("2.0"), None, []

    def _function(self, what: str) -> Any:
        return lambda component, references, count, values: self.heard.append((what, list(references), list(values)[:count])) or 0


def test_references_are_each_type_s_own() -> None:
    real, whole = Variable("h", causality="output"), Variable("n", Kind.INTEGER, "parameter", type="Integer")
    unit = Overheard(real, whole, Variable("on", Kind.BOOLEAN, "parameter", reference=1, type="Boolean"),
                     Variable("gain", causality="parameter", start="1.5", reference=1))  # fmt: skip
    unit.change({"n": 5, "on": True, "gain": 2.5})
    assert sorted(unit.heard) == [("SetBoolean", [1], [1]), ("SetInteger", [0], [5]), ("SetReal", [1], [2.5])]


def test_a_value_given_to_an_alias_is_the_variable_s() -> None:
    unit = Overheard(Variable("c", causality="local", reference=7), Variable("damping", causality="parameter", start="0.1", reference=7))
    unit.change({"damping": 0.4})
    assert unit.heard == [("SetReal", [7], [0.4])]


def test_the_start_is_solved_to_the_last_digits(tmp_path: Path) -> None:
    start = '\n[start]\nvary = "b.position_start"\nzero = "b.position"\nvalue = 0.7\n'
    result = run_scenario(oscillator(tmp_path, start))
    assert result.columns["b.position"][0] == pytest.approx(0.7, abs=1e-12)


def test_a_start_that_nothing_moves_is_an_error(tmp_path: Path) -> None:
    start = '\n[start]\nvary = "a.position_start"\nzero = "b.position"\n'
    with pytest.raises(UnitError, match=r"start: b.position = 0 by varying a.position_start: stays at 1.2 whatever the value"):
        run_scenario(oscillator(tmp_path, start))


def test_two_instances_of_one_fmu_do_not_share_their_state(tmp_path: Path) -> None:
    path = oscillator(tmp_path)
    simulation = Simulation(draw_up(read_scenario(path), path))
    assert isinstance(simulation.system, System)
    result = simulation.run()
    assert result.columns["a.position"][-1] != result.columns["b.position"][-1]
    simulation.close()


def test_an_interrupt_while_a_unit_is_loaded_waits_until_it_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """Raised inside, it was "body: cannot be instantiated (... KeyboardInterrupt())", where Ctrl-C came in the first seconds of a run."""
    loaded: list[str] = []

    def slow(name: str, *_: object) -> None:
        signal.raise_signal(signal.SIGINT)
        loaded.append(name)

    monkeypatch.setattr(loading, "Fmi2Unit", slow)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            loading.load("a", read_interface(sample_fmus() / "SampleMass.fmu"))
    finally:
        signal.signal(signal.SIGINT, before)
    assert loaded == ["a"]
