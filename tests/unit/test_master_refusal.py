"""Discard, errors, values that are not finite, claims that are not true, and who is stepped how often."""

from math import nan

import pytest
from master_samples import fixed, links, mass, oscillator, prepared, spring

from orchestrator.errors import StepError, UnitError
from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.settings import MasterSettings
from orchestrator.master.system import Link, System

COARSE = MasterSettings(max_interval=8e-3, min_interval=1e-3, tolerance=1e9)


def clock(
    name: str = "clock", longest: float = 1.0, refuse_from: float = 9.0, nan_from: float = 9.0, rollback: bool = True
) -> FunctionUnit:
    """Counts its steps; refuses, or gives NaN, as asked."""

    def advance(s: dict, u: dict, t: float, h: float) -> dict | None:
        if h > longest + 1e-12 or t >= refuse_from:
            unit.messages.append("too long for me")
            return None
        s["count"] += 1
        return {"count": s["count"], "y": nan if t >= nan_from else t}

    unit = FunctionUnit(name, {"x": 0.0}, {"count": 0}, lambda s, u: {"count": s["count"], "y": 0.0}, advance, rollback)
    return unit


def test_a_refused_interval_is_retried_at_half_its_length() -> None:
    master = prepared(System([clock(longest=2e-3)], [], recorded=[["count", "y"]]), COARSE, stop=0.016)
    master.run()
    taken = [row for row in master.log if row.accepted]
    assert all(row.interval <= 2e-3 for row in taken)
    assert sum(row.interval for row in taken) == pytest.approx(0.016, abs=1e-12)
    assert {row.limit for row in master.log if not row.accepted} == {"discard by clock"}
    assert master.recorder.columns()["clock.count"][-1] == len(taken)      # refused attempts are undone


@pytest.mark.parametrize(("longest", "stop"), [(1.5e-3, 1.8e-3), (2.5e-3, 6.9e-3)])
def test_what_was_refused_does_not_come_back_as_the_rest_of_the_run(longest: float, stop: float) -> None:
    """The rest is cut so that no interval is shorter than the smallest; a unit that refuses the rest must be given less all the same."""
    settings = MasterSettings(max_interval=4e-3, min_interval=1e-3, tolerance=1e9)
    master = prepared(System([clock(longest=longest)], [], recorded=[["count"]]), settings, stop=stop)
    master.run(lambda _: None if len(master.log) < 50 else pytest.fail("the same interval again and again"))
    assert master.complete
    assert max(row.interval for row in master.log if row.accepted) <= longest


def test_a_tolerance_that_no_interval_holds_ends_the_run_near_its_stop_too() -> None:
    system = System([mass("a", 1.0, 0.0), mass("b", 2.0, 1.2), spring()], links(), recorded=[["x"], ["x"], ["stretch"]])
    master = prepared(system, MasterSettings(max_interval=1e-3, min_interval=5e-5, tolerance=1e-13), stop=1.025e-3)
    master.run(lambda _: None if len(master.log) < 200 else pytest.fail("the same interval again and again"))
    assert master.complete
    assert len(master.log) < 200


def test_a_refusal_in_a_loop_undoes_every_unit() -> None:
    picky = spring()
    inner = picky._advance
    picky._advance = lambda s, u, t, h: inner(s, u, t, h) if h <= 2.5e-3 else None
    master = oscillator(MasterSettings(max_interval=5e-3, min_interval=1e-3, tolerance=1e9), spring_unit=picky)
    master.run()
    reference = oscillator(fixed(2.5e-3, 2))
    reference.run()
    assert sum(not row.accepted for row in master.log) > 0
    assert master.recorder.columns()["spring.stretch"][-1] == reference.recorder.columns()["spring.stretch"][-1]


def test_a_refusal_at_the_smallest_interval_ends_the_run_with_the_units_words_and_keeps_the_rows() -> None:
    master = prepared(System([clock(refuse_from=0.01)], [], recorded=[["y"]]), COARSE)
    with pytest.raises(StepError, match=r"clock: refused the step at t = 0\.0\d+ s even at the smallest interval.*too long for me"):
        master.run()
    assert len(master.recorder.times) == 3
    assert not master.complete


def test_a_refusal_by_a_unit_that_cannot_roll_back_names_it() -> None:
    master = prepared(System([clock(rollback=False, longest=1e-3)], [], recorded=[["y"]]), COARSE)
    with pytest.raises(StepError, match="clock cannot roll back: too long for me; lower max_interval"):
        master.run()


def test_a_value_that_is_not_finite_names_unit_and_variable() -> None:
    master = prepared(System([clock(nan_from=0.1)], [], recorded=[["count", "y"]]), COARSE)
    with pytest.raises(StepError, match=r"clock: y is nan near t = 0\.1"):
        master.run()
    assert 0.09 < master.recorder.times[-1] < 0.11


def test_a_claim_of_rollback_that_is_not_true_is_found_at_the_start() -> None:
    hidden = [0.0]

    def advance(s: dict, u: dict, t: float, h: float) -> dict:
        hidden[0] += h
        return {"y": hidden[0]}

    liar = FunctionUnit("liar", {"x": 0.0}, {}, lambda s, u: {"y": hidden[0]}, advance)
    with pytest.raises(UnitError, match=r"liar: claims rollback .*, but y is 0\.008 after a step and 0\.016 after going back and"):
        prepared(System([liar], [], recorded=[["y"]]), COARSE)
    master = prepared(System([liar], [], recorded=[["y"]], once=frozenset({"liar"})), COARSE)
    assert master.rollback == [False]
    assert "liar: claims rollback but does not return to the same bits" in master.warnings[0]


def test_a_sensor_outside_the_loop_is_stepped_once_per_accepted_step_after_the_loop() -> None:
    """It gets the values at the end of the accepted step's start, as any later unit without a mean to take."""
    sensor = clock("sensor", rollback=False)
    system = System([mass("a", 1.0, 0.0), mass("b", 2.0, 1.2), spring(), sensor], [*links(), Link(2, "stretch", 3, "x")])
    master = prepared(system, MasterSettings(max_interval=0.1, min_interval=1e-6, tolerance=1e-5))
    master.run()
    accepted = sum(row.accepted for row in master.log)
    assert len(master.log) > accepted
    assert sensor.steps == accepted
    assert system.slaves[0].steps == 2 * len(master.log)


def test_a_unit_declared_once_is_not_repeated_though_it_could_be() -> None:
    system = System([mass("a", 1.0, 0.0), mass("b", 2.0, 1.2), spring()], links(), once=frozenset({"b"}))
    master = prepared(system, MasterSettings(max_interval=1e-3, tolerance=1e9))
    master.run()
    assert master.repeated == [True, False, True]
    assert [slave.steps for slave in system.slaves] == [2000, 1000, 2000]


def test_an_interpolating_unit_gets_the_standard_derivative_call() -> None:
    """`f` of this mass has no slope input; the binding hands the slope over as der(f)."""
    plain = mass("a", 1.0, 0.0)
    variables = {name: v for name, v in plain.interface.variables.items() if name != "f_slope"}
    capabilities = {"canGetAndSetFMUstate": True, "canInterpolateInputs": True}
    plain.interface = type(plain.interface)("a", variables, capabilities)
    advance = plain._advance
    plain._advance = lambda s, u, t, h: advance(s, u | {"f_slope": u.get("der(f)", 0.0)}, t, h)
    master = prepared(System([plain, mass("b", 2.0, 1.2), spring()], links(), recorded=[["x"], ["x"], ["stretch"]]), fixed(5e-3, 2))
    master.run()
    reference = oscillator(fixed(5e-3, 2))
    reference.run()
    assert master.recorder.columns()["a.x"][-1] == reference.recorder.columns()["a.x"][-1]


def test_a_stop_request_ends_after_the_present_step_and_keeps_what_there_is() -> None:
    master = oscillator(MasterSettings(max_interval=1e-3))

    def after_half(time: float) -> None:
        master.stop_requested = time >= 0.5

    master.run(after_half)
    assert not master.complete
    assert master.recorder.times[-1] == pytest.approx(0.5, abs=1e-9)
