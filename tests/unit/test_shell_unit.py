"""The unit's life without an FMU: initial values, stepping, restoring, refusing. tests/fmu does the same through FMI."""

from typing import Any

import numpy as np
import pytest
from lander.shell import Unit, UnitError, input_, nanoseconds, output, parameter, state
from lander.shell.bounds import LARGEST, first_outside_compiled, first_outside_plain


class Integrator(Unit):
    """dx/dt = gain u."""

    variables = (
        parameter("gain", 1.0, "1/s", "", minimum=0.0, maximum=10.0),
        input_("in.u", (0.0, 0.0), "m", "", slope=True, maximum=100.0),
        output("out.x", (0.0, 0.0), "m", "", depends=("in.u",)),
        state("sum", (0.0, 0.0)),
        state("calls", 0.0),
    )
    prepared_for: float = -1.0

    def prepare(self) -> None:
        self.prepared_for = self.value("gain")

    def initialise(self) -> None:
        self["calls"] += 1.0
        self["out.x"] = self["in.u"]

    def advance(self, time: float, step: float) -> None:
        if self["in.u"][0] == 13.0:
            self["sum"] = np.nan
            raise UnitError("13 is refused")
        self["sum"] += self.prepared_for * step * (self["in.u"] + 0.5 * step * self["in.u_slope"])
        self["out.x"] = self["sum"] if self["in.u"][0] != 14.0 else np.nan


def unit(**start: float) -> Any:
    """An Integrator in initialisation mode."""
    one = Integrator(instance_name="one")
    one.setup_experiment(0.0, None, None)
    one.enter_initialization_mode()
    for name, value in start.items():
        one.set_real([one.layout.slices[name].start], [value])
    return one


U, X = [1, 2], [5, 6]


def test_outputs_follow_inputs_in_initialisation_mode_as_often_as_asked() -> None:
    one = unit()
    for value in (1.0, 2.0, 3.0):
        one.set_real(U, [value, 0.0])
        assert one.get_real(X) == [value, 0.0]
        assert one.get_real(X) == [value, 0.0]
    one.exit_initialization_mode()
    assert one.value("calls") == 1.0      # initialise finds states at their start values each time
    assert one.message == ""


def test_inputs_set_between_steps_do_not_move_outputs() -> None:
    one = unit(gain=2.0)
    one.exit_initialization_mode()
    one.set_real([1, 3], [1.0, 4.0])
    assert one.get_real(X) == [0.0, 0.0]
    assert one.do_step(0.0, 0.5)
    assert one.get_real(X) == [2.0 * 0.5 * (1.0 + 0.25 * 4.0), 0.0]


def test_spans_and_views_are_the_memory_itself() -> None:
    one = unit()
    one.span("in.u", "in.u_slope")[:] = [1.0, 2.0, 3.0, 4.0]
    assert one["in.u"].tolist() == [1.0, 2.0]
    assert one["in.u_slope"].tolist() == [3.0, 4.0]
    one["in.u"] = 5.0
    assert one.get_real([1, 2, 3]) == [5.0, 5.0, 3.0]


def test_a_refused_step_leaves_the_memory_as_it_was() -> None:
    one = unit()
    one.exit_initialization_mode()
    for value, words in ((13.0, "at 0.0 s: 13 is refused"), (14.0, "at 0.0 s: out.x[1] is nan, expects a finite number"),
                         (101.0, "at 0.0 s: in.u[1] is 101.0 m, expects at most 100.0 m")):
        one.set_real(U, [value, 0.0])
        before = one.memory.copy()
        assert not one.do_step(0.0, 0.1)
        assert one.message == words
        assert np.array_equal(one.memory, before)
    assert one.log_queue[0].msg == "Integrator one: at 0.0 s: 13 is refused"


def test_a_step_before_initialisation_is_discarded() -> None:
    assert not unit().do_step(0.0, 0.1)


def test_a_restored_state_brings_its_parameters_and_prepares_for_them() -> None:
    one, other = unit(gain=2.0), unit(gain=3.0)
    for it in (one, other):
        it.exit_initialization_mode()
    content = Integrator._fmu_state_to_bytes(one._get_fmu_state())
    other._set_fmu_state(Integrator._fmu_state_from_bytes(content))
    assert (other.value("gain"), other.prepared_for) == (2.0, 2.0)
    assert Integrator._fmu_state_to_bytes(other._get_fmu_state()) == content


def test_a_state_from_before_the_end_of_initialisation_can_be_restored() -> None:
    one = unit()
    state = one._get_fmu_state()
    one.exit_initialization_mode()
    one._set_fmu_state(state)
    assert not one.do_step(0.0, 0.1)
    one.set_real([0], [5.0])
    one.exit_initialization_mode()
    assert one.do_step(0.0, 0.1)
    assert one.prepared_for == 5.0


def test_failed_initialisation_can_be_mended_by_another_try() -> None:
    one = unit(gain=11.0)
    one.exit_initialization_mode()
    assert one.message == "gain is 11.0 1/s, expects at most 10.0 1/s"
    assert not one.do_step(0.0, 0.1)
    assert one.message == "gain is 11.0 1/s, expects at most 10.0 1/s"


@pytest.mark.parametrize("first_outside", [first_outside_compiled, first_outside_plain])
def test_bounds_find_the_first_value_outside(first_outside: Any) -> None:
    slots, low, high = np.array([1, 2, 4]), np.array([0.0, -LARGEST, -LARGEST]), np.array([1.0, LARGEST, 5.0])
    for memory, answer in (([9.0, 1.0, 0.0, np.nan, 5.0], -1), ([0.0, 1.1, np.inf, 0.0, 0.0], 1), ([0.0, 0.0, np.inf, 0.0, 6.0], 2),
                           ([0.0, 0.0, 0.0, 0.0, np.nan], 4)):
        assert first_outside(np.array(memory), slots, low, high) == answer


def test_times_are_counted_in_nanoseconds() -> None:
    assert nanoseconds(sum([0.1] * 10)) == 1_000_000_000
