"""Scheduled times are met to the nanosecond; changes of outputs are located where they can be; nothing else moves."""

from dataclasses import replace
from itertools import pairwise
from math import nan

import pytest
from master_samples import links, mass, oscillator, prepared, spring
from test_checkpoint_master import bits, keeping, through_a_file

from orchestrator.checkpoint.snapshot import put, take
from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.judge import StepLimits, Verdict, resume
from orchestrator.master.master import Master
from orchestrator.master.settings import NANOSECONDS, MasterSettings
from orchestrator.master.system import Link, System

FREE = MasterSettings(max_interval=8e-3, min_interval=1e-3, tolerance=1e9)
FINE = MasterSettings(max_interval=2e-2, min_interval=1e-5, tolerance=2e-7)
DUE = (0.0123456789, 0.05, 0.05 + 1e-9, 0.0991)


def agenda(times: tuple[float, ...] = DUE, rollback: bool = True, name: str = "agenda") -> FunctionUnit:
    """Announces these times, one after the other, and passes its input on."""

    def due(t: float) -> float:
        return next((d for d in times if round(d * NANOSECONDS) > round(t * NANOSECONDS)), -1.0)

    def advance(s: dict, u: dict, t: float, h: float) -> dict:
        return {"plan.next_event_time": due(t + h), "y": u["x"]}

    return FunctionUnit(name, {"x": 0.0}, {}, lambda s, u: {"plan.next_event_time": due(0.0), "y": u["x"]}, advance, rollback)


def switch(*instants: float, rollback: bool = True, name: str = "switch") -> FunctionUnit:
    """Its output counts the instants that lie behind; passes its input on."""

    def on(t: float) -> float:
        return float(sum(t >= instant for instant in instants))

    def advance(s: dict, u: dict, t: float, h: float) -> dict:
        return {"on": on(t + h), "y": u["x"]}

    return FunctionUnit(name, {"x": 0.0}, {}, lambda s, u: {"on": on(0.0), "y": u["x"]}, advance, rollback)


def ends(master: Master) -> list[int]:
    """Of the accepted steps, ns."""
    return [round((row.time + row.interval) * NANOSECONDS) for row in master.log if row.accepted]


def ran(units: list[FunctionUnit], settings: MasterSettings = FREE, located: list[list[str]] | None = None, loop: bool = False) -> Master:
    joined = [Link(0, "y", 1, "x"), Link(1, "y", 0, "x")] if loop else []
    master = prepared(System(units, joined, located=located or []), settings, stop=0.1)
    master.run()
    return master


@pytest.mark.parametrize("loop", [True, False], ids=["repeated", "stepped once"])
@pytest.mark.parametrize("rollback", [True, False])
def test_a_scheduled_time_is_met_to_the_nanosecond(rollback: bool, loop: bool) -> None:
    master = ran([agenda(rollback=rollback), agenda((), name="other")], loop=loop)
    assert master.repeated == [rollback and loop] * 2
    assert {round(d * NANOSECONDS) for d in DUE} <= set(ends(master))
    assert {row.limit for row in master.log if row.time + row.interval == pytest.approx(0.05, abs=1e-12)} == {"scheduled agenda"}
    assert ends(master)[-1] == 100_000_000


def test_a_scheduled_time_costs_one_step_and_the_next_is_as_long_as_before() -> None:
    master = ran([agenda((0.0171,))])
    intervals = [round(row.interval * NANOSECONDS) for row in master.log]
    assert intervals[:4] == [8_000_000, 8_000_000, 1_100_000, 8_000_000]


@pytest.mark.parametrize("value", [-1.0, 0.0, 1e300, 5.0])
def test_times_that_are_past_or_beyond_the_end_change_nothing(value: float) -> None:
    unit = FunctionUnit("u", {}, {}, lambda s, u: {"next_event_time": value}, lambda s, u, t, h: {"next_event_time": value})
    plain = FunctionUnit("u", {}, {}, lambda s, u: {"y": value}, lambda s, u, t, h: {"y": value})
    assert repr(ran([unit]).log) == repr(ran([plain]).log)


@pytest.mark.parametrize("loop", [True, False], ids=["repeated", "stepped once"])
def test_a_change_is_located_within_the_tolerance_and_the_interval_comes_back(loop: bool) -> None:
    settings = replace(FREE, event_tolerance=2e-5)
    master = ran([switch(0.0337, 0.0703), agenda(())], settings, [["on"], []], loop)
    for instant in (0.0337, 0.0703):
        (held,) = [row for row in master.log if row.accepted and row.time < instant <= row.time + row.interval]
        assert held.interval <= 2e-5
        assert held.limit == "event switch.on"
    assert max(row.interval for row in master.log if row.accepted and row.time > 0.034) == 8e-3
    assert ends(master)[-1] == 100_000_000
    assert {row.limit for row in master.log if not row.accepted} == {"event switch.on"}
    assert len(master.log) < 2 * 10 + 100 / 8 + 2          # ten halvings an event


def test_a_located_change_under_error_control_leaves_the_controller_its_interval() -> None:
    def made(located: list[list[str]]) -> Master:
        units = [mass("a", 1.0, 0.0), mass("b", 2.0, 1.2), spring(), switch(0.3)]
        master = prepared(System(units, [*links(), Link(0, "x", 3, "x")], located=located), FINE)
        master.run()
        return master

    free, held = made([]), made([[], [], [], ["on"]])
    assert min(row.interval for row in held.log) <= 1e-4 < min(row.interval for row in free.log)
    (before,) = [row.interval for row in free.log if row.accepted and row.time < 0.3 <= row.time + row.interval]
    (after,) = [n.interval for r, n in pairwise([r for r in held.log if r.accepted]) if r.time < 0.3 <= r.time + r.interval]
    assert after > 0.5 * before


def test_a_unit_without_rollback_is_not_bisected_and_the_user_is_told() -> None:
    plain, asked = ran([switch(0.0337, rollback=False)]), ran([switch(0.0337, rollback=False)], located=[["on"]])
    assert repr(asked.log) == repr(plain.log)
    assert asked.warnings == ["switch.on: its changes are not located, because units that are stepped after it cannot roll back"]


def test_beside_a_unit_without_rollback_a_repeated_one_is_still_located() -> None:
    units = [switch(0.0337), agenda(()), agenda((), rollback=False, name="sensor")]
    system = System(units, [Link(0, "y", 1, "x"), Link(1, "y", 0, "x"), Link(0, "y", 2, "x")], located=[["on"], [], []])
    master = prepared(system, FREE, stop=0.1)
    master.run()
    assert any(row.limit == "event switch.on" and row.accepted for row in master.log)
    assert units[2].steps == sum(row.accepted for row in master.log)


def test_a_unit_of_one_step_size_keeps_it() -> None:
    def fixed() -> FunctionUnit:
        unit = agenda((0.0171,))
        variable = {**unit.interface.capabilities, "canHandleVariableCommunicationStepSize": False}
        unit.interface = replace(unit.interface, capabilities=variable)
        return unit

    master = ran([fixed(), switch(0.0337)], replace(FREE, max_interval=5e-3), [[], ["on"]])
    assert {row.interval for row in master.log} == {5e-3}
    assert len([w for w in master.warnings if "one step size only" in w]) == 3


def test_where_nothing_is_located_the_bits_are_the_same() -> None:
    asked = prepared(System([mass("a", 1.0, 0.0), mass("b", 2.0, 1.2), spring(), switch(9.0)], links(), located=[[], [], [], ["on"]]), FINE)
    asked.run()
    plain = oscillator(FINE)
    plain.run()
    assert repr(asked.log) == repr(plain.log)


@pytest.mark.parametrize("at", [0, 2, -1])
def test_a_run_goes_on_from_the_middle_of_a_search(at: int) -> None:
    def made() -> Master:
        units = [keeping(u) for u in (mass("a", 1.0, 0.0), mass("b", 2.0, 1.2), spring(), switch(0.1234), agenda())]
        return prepared(System(units, links(), recorded=[["x"], [], [], [], []], located=[[], [], [], ["on"], []]), FINE)

    whole, resumed, taken = made(), made(), []
    whole.run(lambda _: taken.append(take(whole)) if whole.events.aim > whole.time else None)
    assert len(taken) > 2
    put(resumed, through_a_file(taken[at]))
    assert resumed.events.aim > resumed.time
    resumed.run()
    ours, theirs = bits(resumed), bits(whole)
    assert {path for path in theirs if ours.get(path) != theirs[path]} == set()


def test_the_interval_comes_back_only_as_far_as_the_estimate_allows() -> None:
    limits, verdict = StepLimits(50_000, 5_000_000, 1e-6), Verdict(True, False, 200_000)
    assert resume(verdict, 100_000, 4_000_000, 0.0, limits) == 4_000_000
    assert resume(verdict, 100_000, 4_000_000, 1e-8, limits) == 900_000
    assert resume(verdict, 100_000, 4_000_000, nan, limits) == 200_000
    assert resume(verdict._replace(unresolved=True), 100_000, 4_000_000, 1e-8, limits) == 200_000


def test_a_time_announced_just_past_the_stop_does_not_carry_the_run_beyond_it() -> None:
    master = ran([agenda((0.10003,)), agenda((), name="other")], replace(FREE, max_interval=1.5e-3))
    assert master.time == 100_000_000
    assert all(row.time + row.interval <= 0.1 + 1e-12 for row in master.log)


@pytest.mark.parametrize("start", [-0.05, -0.1])
def test_before_zero_times_are_met_and_nothing_is_sought_that_is_not(start: float) -> None:
    """Also one announced for 0 s itself; a run that stops at or before 0 s ends."""
    units = [agenda((-0.0321, 0.0)), switch(-0.0171)]
    master = Master(System(units, [], located=[[], ["on"]]), FREE)
    master.initialise(start, start + 0.1, [{}, {}])
    master.prepare()
    master.run()
    assert {-32_100_000, 0} <= set(ends(master))
    assert ends(master)[-1] == round((start + 0.1) * NANOSECONDS)
    assert all(row.interval > 0.0 and row.limit != "event " for row in master.log)
    assert any(row.limit == "event switch.on" and row.accepted for row in master.log)
