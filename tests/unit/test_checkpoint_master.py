"""A master that adopts another's memory goes on as that one would have: with units made of functions, in memory."""

import copy
import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from master_samples import links, mass, spring
from quarter_vehicle import quarter_vehicle

from orchestrator.checkpoint.checkpoint import pack, unpack
from orchestrator.checkpoint.snapshot import Snapshot, put, take
from orchestrator.checkpoint.trial import require_claims, require_truth
from orchestrator.errors import UnitError
from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.master import Master
from orchestrator.master.settings import MasterSettings
from orchestrator.master.slave import Status
from orchestrator.master.system import PortPair, System

REJECTING = MasterSettings(max_interval=2e-2, min_interval=1e-5, tolerance=2e-7)
SPARSE = replace(REJECTING, record_interval=0.05)


class Keeping(FunctionUnit):
    """Its state can leave the process."""

    def serialised_state(self) -> bytes:
        return pickle.dumps(self._saved)

    def adopt_state(self, data: bytes) -> None:
        self._saved = pickle.loads(data)


def keeping(unit: FunctionUnit) -> FunctionUnit:
    unit.__class__ = Keeping
    unit.interface = replace(unit.interface, capabilities={**unit.interface.capabilities, "canSerializeFMUstate": True})
    return unit


def prepared(settings: MasterSettings, last: FunctionUnit | None = None, stop: float = 1.0) -> Master:
    units = [keeping(mass("a", 1.0, 0.0)), keeping(mass("b", 2.0, 1.2)), last or keeping(spring())]
    master = Master(System(units, links(), recorded=[["x"], ["x"], ["stretch"]]), settings)
    master.initialise(0.0, stop, [{}] * 3)
    master.prepare()
    return master


def run_keeping(master: Master, at: int) -> Snapshot:
    """To the end; the snapshot after so many accepted steps."""
    taken: list[Snapshot] = []

    def after_step(_: float) -> None:
        if sum(row.accepted for row in master.log) == at:
            taken.append(take(master))

    master.run(after_step)
    (snapshot,) = taken
    return snapshot


def through_a_file(snapshot: Snapshot) -> Snapshot:
    return unpack(*copy.deepcopy(pack(snapshot)))


SCRATCH = ("wall_time", "seconds", "_since", "_times", "_rows", "slaves", "slave", "interface")


def bits(thing: Any, path: str = "master", seen: set[int] | None = None) -> dict[str, Any]:
    """Everything reachable from an object, by path: what MEMORY forgets differs here."""
    seen = set() if seen is None else seen
    if isinstance(thing, np.ndarray):
        return {path: thing.tobytes()}
    if isinstance(thing, (bool, int, float, str, type(None))):
        return {path: repr(thing)}
    if id(thing) in seen:
        return {}
    seen.add(id(thing))
    if isinstance(thing, dict):
        parts = {f"{path}[{key}]": value for key, value in thing.items()}
    elif isinstance(thing, (list, tuple)):
        parts = {f"{path}[{n}]": value for n, value in enumerate(thing)}
    elif type(thing).__module__.startswith("orchestrator"):
        parts = {f"{path}.{key}": value for key, value in vars(thing).items() if key not in SCRATCH}
    else:
        return {}
    return {name: value for key, part in parts.items() for name, value in bits(part, key, seen).items()}


@pytest.mark.parametrize("settings", [REJECTING, SPARSE], ids=["every step recorded", "every 50 ms recorded"])
@pytest.mark.parametrize("at", [1, 2, 17, 60])
def test_from_any_step_everything_in_the_master_ends_the_same_to_the_bit(settings: MasterSettings, at: int) -> None:
    whole, resumed = prepared(settings), prepared(settings)
    snapshot = run_keeping(whole, at)
    assert any(not row.accepted for row in whole.log)         # else settling would not be tested
    put(resumed, through_a_file(snapshot))
    assert resumed.time == round(1e9 * sum(row.interval for row in [r for r in whole.log if r.accepted][:at]))
    resumed.run()
    ours, theirs = bits(resumed), bits(whole)
    assert len(theirs) > 50
    assert {path for path in theirs if ours.get(path) != theirs[path]} == set()
    assert resumed.recorder.rows.tobytes() == whole.recorder.rows.tobytes()
    assert [slave.steps for slave in resumed.system.slaves] == [slave.steps for slave in whole.system.slaves]


@pytest.mark.parametrize("sloped", [True, False], ids=["with slopes", "without slopes"])
@pytest.mark.parametrize("at", [1, 4, 30])
def test_what_a_quasi_newton_has_learnt_goes_on_with_it(at: int, sloped: bool) -> None:
    def master() -> Master:
        made = quarter_vehicle(MasterSettings(max_interval=1e-2), sloped=sloped)
        for unit in made.system.slaves:
            keeping(unit)
        return made

    whole, resumed = master(), master()
    put(resumed, through_a_file(run_keeping(whole, at)))
    resumed.run()
    ours, theirs = bits(resumed), bits(whole)
    assert {path for path in theirs if ours.get(path) != theirs[path]} == set()
    assert resumed.recorder.rows.tobytes() == whole.recorder.rows.tobytes()


def test_taking_a_snapshot_changes_nothing() -> None:
    whole, watched = prepared(SPARSE), prepared(SPARSE)
    whole.run()
    watched.run(lambda _: take(watched) and None)
    assert bits(watched) == bits(whole)


def test_a_row_that_only_the_interruption_asked_for_is_not_in_the_memory() -> None:
    whole, stopped, resumed = prepared(SPARSE), prepared(SPARSE), prepared(SPARSE)
    whole.run()

    step = stopped.system.slaves[0].step

    def step_and_stop(time: float, interval: float) -> Status:      # as a signal in mid-step does
        stopped.stop_requested = time > 0.33
        return step(time, interval)

    stopped.system.slaves[0].step = step_and_stop                   # type: ignore[method-assign]
    stopped.run()
    assert not stopped.complete
    assert len(stopped.recorder.times) == len(stopped.recorder.rows) + 1
    put(resumed, through_a_file(take(stopped)))
    resumed.run()
    assert resumed.recorder.rows.tobytes() == whole.recorder.rows.tobytes()
    assert list(map(repr, resumed.log)) == list(map(repr, whole.log))


def test_the_ledger_goes_on() -> None:
    def absorber(name: str, sign: float) -> FunctionUnit:
        def advance(s: dict, u: dict, t: float, h: float) -> dict:
            s["w"] += sign * np.cos(10.0 * t) * h           # to and fro: what is summed cannot be had from the ends
            return {"p.y": s["w"], "p.work": s["w"]}

        return keeping(FunctionUnit(name, {"p.x": 0.0}, {"w": 0.3}, lambda s, u: {"p.y": s["w"], "p.work": s["w"]}, advance))

    def master() -> Master:
        units = [absorber("a", 1.0), absorber("b", -0.99)]
        system = System(units, [], [PortPair(0, "p", 1, "p")], recorded=[["p.work"], []])
        made = Master(system, MasterSettings(max_interval=1e-2))
        made.initialise(0.0, 1.0, [{}, {}])
        made.prepare()
        return made

    whole, resumed = master(), master()
    put(resumed, through_a_file(run_keeping(whole, 31)))
    resumed.run()
    (row,) = whole.ledger.rows()
    assert row.throughput > 0.4
    assert resumed.ledger.rows() == [row]


def test_a_unit_that_cannot_serialise_is_named() -> None:
    master = prepared(REJECTING, last=spring())
    with pytest.raises(UnitError, match=r"^spring \(spring\): cannot serialise its state \(canSerializeFMUstate is false\)"):
        require_claims(master.system.slaves)


def test_a_unit_whose_bytes_are_not_its_state_is_named() -> None:
    class Lying(Keeping):
        def serialised_state(self) -> bytes:
            return pickle.dumps({"e": round(self._saved["e"], 0)})

    unit = keeping(spring())
    unit.__class__ = Lying
    master = prepared(REJECTING, last=unit)
    with pytest.raises(UnitError, match=r"^spring: claims to serialise its state but does not go on from it with the same bits"):
        require_truth(master)


def test_the_trial_leaves_no_trace() -> None:
    tried, untried = prepared(REJECTING), prepared(REJECTING)
    require_truth(tried)
    assert [slave.steps for slave in tried.system.slaves] == [0, 0, 0]
    tried.run()
    untried.run()
    assert bits(tried) == bits(untried)
