"""Verifies: order of convergence and step control of the master.

Setup: two masses (1 and 2 kg) and a spring as three units with slopes, against e = e₀ cos(ωt), ω² = k (1/m₁ + 1/m₂), over 1.95 periods.
Tolerance: the first pass is of order 1, the second of 3 because a mean with its slope is exact to second order, each further one gains one;
±0.25 leaves room for the next term of the error series at these intervals.
"""

import numpy as np
import pytest
from master_samples import error_of, fixed, oscillator, prepared, spring

from orchestrator.errors import UnitError
from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.settings import MasterSettings
from orchestrator.master.system import Link, System


@pytest.mark.parametrize(("passes", "order"), [(1, 1), (2, 3), (3, 4)])
def test_halving_the_interval_shows_the_order_of_the_passes(passes: int, order: int) -> None:
    errors = []
    for interval in (5e-3, 2.5e-3):
        master = oscillator(fixed(interval, passes))
        master.run()
        errors.append(error_of(master))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.25)


def test_slopes_earn_their_place() -> None:
    errors = {}
    for slope in (True, False):
        master = oscillator(fixed(5e-3, 2), slope=slope)
        master.run()
        errors[slope] = error_of(master)
    assert errors[False] > 20.0 * errors[True]


def test_a_tighter_tolerance_gives_a_smaller_error() -> None:
    errors, steps = [], []
    for tolerance in (1e-4, 1e-5, 1e-6):
        master = oscillator(MasterSettings(max_interval=0.1, min_interval=1e-6, tolerance=tolerance))
        master.run()
        errors.append(error_of(master))
        steps.append(sum(row.accepted for row in master.log))
        assert master.unresolved == 0
        assert max(row.estimate for row in master.log if row.accepted) <= tolerance
    assert errors[0] > 4 * errors[1] > 16 * errors[2]
    assert steps[0] < steps[1] < steps[2]


def test_rejected_steps_leave_no_trace() -> None:
    """A run told beforehand which intervals will be accepted, with no rejection, ends on the same bits."""
    master = oscillator(MasterSettings(max_interval=0.1, min_interval=1e-6, tolerance=1e-5))
    master.run()
    rejected = sum(not row.accepted for row in master.log)
    assert rejected > 5
    again = oscillator(MasterSettings(max_interval=0.1, min_interval=1e-6, tolerance=1e9))
    for row in master.log:
        if row.accepted:
            again._advance(round(row.interval * 1e9))
    assert again.plan.board.now.tobytes() == master.plan.board.now.tobytes()


def test_the_oscillator_repeats_itself_to_the_bit() -> None:
    runs = [oscillator(MasterSettings(tolerance=1e-6)) for _ in range(2)]
    for master in runs:
        master.run()
    first, second = (master.recorder.columns() for master in runs)
    assert all(np.array_equal(first[name], second[name]) for name in first)


def test_a_loop_that_cannot_roll_back_is_stepped_once_with_intervals_that_shrink_where_motion_changes() -> None:
    master = oscillator(MasterSettings(max_interval=2e-3, tolerance=1e-6), spring_unit=spring(rollback=False))
    master.run()
    assert master.repeated == [False, False, False]
    assert [slave.steps for slave in master.system.slaves] == [len(master.log)] * 3
    assert all(row.accepted for row in master.log)
    assert min(row.interval for row in master.log[:-1]) < 5e-4
    assert error_of(master) < 0.01


def test_explicit_steps_that_cannot_shrink_count_as_unresolved() -> None:
    master = oscillator(MasterSettings(max_interval=2e-3, min_interval=2e-3, tolerance=1e-6), spring_unit=spring(rollback=False))
    master.run()
    assert master.unresolved > 0.5 * len(master.log)


def test_a_unit_of_one_step_size_fixes_the_interval_for_all() -> None:
    rigid = spring()
    rigid.interface.capabilities["canHandleVariableCommunicationStepSize"] = False
    master = oscillator(MasterSettings(max_interval=5e-3, tolerance=1e-7), spring_unit=rigid)
    master.run()
    assert {row.interval for row in master.log} == {5e-3}
    assert any("spring: takes one step size only" in warning for warning in master.warnings)
    assert master.unresolved > 0


def test_a_step_that_does_not_divide_the_run_is_refused_where_a_unit_takes_no_other() -> None:
    rigid = spring()
    rigid.interface.capabilities["canHandleVariableCommunicationStepSize"] = False
    with pytest.raises(UnitError, match=r"spring: takes one step size only, but master.max_interval of 0.003 s does not divide"):
        oscillator(MasterSettings(max_interval=3e-3, tolerance=1e-7), spring_unit=rigid)


def test_a_loop_without_estimate_is_told_to_the_user() -> None:
    master = oscillator(MasterSettings(passes=1))
    assert any("no port gives an error estimate" in warning for warning in master.warnings)


def test_rows_are_recorded_at_the_interval_asked_for_and_at_the_end() -> None:
    master = oscillator(MasterSettings(max_interval=1e-3, min_interval=1e-3, tolerance=1e9, record_interval=0.1))
    master.run()
    assert master.recorder.times == pytest.approx(np.arange(11) / 10, abs=1e-12)


def test_initialising_again_starts_afresh() -> None:
    master = oscillator(MasterSettings())
    before = master.plan.board.now.copy()
    master.initialise(0.0, 1.0, [{"x": 5.0}, {}, {}])
    assert master.value(0, "x") == 5.0
    master.initialise(0.0, 1.0, [{}] * 3)
    assert np.array_equal(master.plan.board.now, before)


@pytest.mark.parametrize(("gain", "settles"), [(0.4, True), (-1.5, False)])
def test_start_values_that_do_not_settle_round_the_system_are_told(gain: float, settles: bool) -> None:
    """A loop of direct feedthrough: y = 1 + gain x on one side, y = x on the other."""
    def unit(name: str, gain: float, constant: float) -> FunctionUnit:
        def out(u: dict[str, float]) -> dict[str, float]:
            return {"y": constant + gain * u["x"]}

        return FunctionUnit(name, {"x": 0.0}, {}, lambda _, u: out(u), lambda _, u, t, h: out(u), True)

    system = System([unit("amplifier", gain, 1.0), unit("wire", 1.0, 0.0)], [Link(0, "y", 1, "x"), Link(1, "y", 0, "x")])
    master = prepared(system, MasterSettings(max_interval=1e-3, tolerance=1e9))
    told = [line for line in master.warnings if "as start values go round the system" in line]
    assert bool(told) is not settles
    assert settles or told[0].startswith("amplifier.y: still changes from ") or told[0].startswith("wire.y: still changes from ")
    assert not settles or master.value(0, "y") == pytest.approx(1.0 / (1.0 - gain), rel=1e-12)
