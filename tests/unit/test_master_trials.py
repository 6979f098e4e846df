"""What units claim is tried before the first step."""

import pickle
from dataclasses import replace
from math import isnan

import pytest
from master_samples import oscillator, prepared, spring
from quarter_vehicle import quarter_vehicle

from orchestrator.errors import UnitError
from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.settings import MasterSettings
from orchestrator.master.system import Link, Scheme, System


def relaxing(order: int, **options: bool) -> FunctionUnit:
    """y' = -100 y by one step of Euler (1) or of Heun (2)."""

    def advance(s: dict, u: dict, t: float, h: float) -> dict:
        z = 100.0 * h
        s["y"] *= 1.0 - z + (z * z / 2.0 if order == 2 else 0.0)
        return {"y": s["y"]}

    return FunctionUnit("relaxing", {"x": 0.0}, {"y": 1.0}, lambda s, u: {"y": s["y"]}, advance, **options)


class Serialising(FunctionUnit):
    """Truly, or losing a digit on the way."""

    digits = 17

    def serialised_state(self) -> bytes:
        return pickle.dumps({k: float(f"{v:.{self.digits}g}") for k, v in self._saved.items()})

    def adopt_state(self, data: bytes) -> None:
        self._saved = pickle.loads(data)


def serialising(digits: int) -> FunctionUnit:
    unit = relaxing(1)
    unit._start["y"] = 1.0 / 3.0
    unit.__class__ = type("Unit", (Serialising,), {"digits": digits})
    unit.interface = replace(unit.interface, capabilities={**unit.interface.capabilities, "canSerializeFMUstate": True})
    return unit


@pytest.mark.parametrize("order", [1, 2])
def test_the_dependence_on_the_step_size_is_measured_and_not_judged(order: int) -> None:
    master = prepared(System([relaxing(order)], [], recorded=[["y"]]), MasterSettings(max_interval=2e-3))
    (record,) = master.trials
    z = 0.2
    whole, half = (1.0 - h + (h * h / 2.0 if order == 2 else 0.0) for h in (z, z / 2))
    assert record.step_size_difference == pytest.approx(abs(half**2 - whole), rel=1e-9)
    assert record.step_size_variable == "y"
    assert master.warnings == []
    assert master.value(0, "y") == 1.0


def test_a_unit_without_rollback_is_not_tried() -> None:
    master = prepared(System([relaxing(1, rollback=False)], [], recorded=[["y"]]), MasterSettings())
    assert master.trials[0].rollback == "not claimed"
    assert isnan(master.trials[0].step_size_difference)
    assert master.system.slaves[0]._state == {"y": 1.0}


@pytest.mark.parametrize(("digits", "found"), [(17, "true"), (12, "claimed, not true")])
def test_serialisation_is_tried_and_a_unit_it_spoils_is_initialised_again(digits: int, found: str) -> None:
    master = prepared(System([serialising(digits)], [], recorded=[["y"]]), MasterSettings())
    assert master.trials[0].serialisation == found
    assert master.trials[0].rollback == "true"
    assert len(master.warnings) == (found != "true")
    assert master.system.slaves[0]._state == {"y": 1.0 / 3.0}


def test_slopes_are_counted_on_connected_inputs() -> None:
    assert [record.slopes for record in oscillator(MasterSettings()).trials] == [1, 1, 2]
    assert [record.slopes for record in quarter_vehicle(MasterSettings(), sloped=False).trials] == [0, 0]


def test_a_refused_trial_is_repeated_with_a_shorter_interval() -> None:
    picky = relaxing(1)
    inner = picky._advance
    picky._advance = lambda s, u, t, h: inner(s, u, t, h) if h <= 5e-4 else None
    master = prepared(System([picky], [], recorded=[["y"]]), MasterSettings(max_interval=2e-3))
    assert master.trials[0].rollback == "true"
    assert master.trials[0].step_size_difference > 0.0


def test_a_scheme_cannot_replace_a_reduced_interface_model() -> None:
    from test_master_reduced_model import coupled

    system = coupled(MasterSettings()).system
    forced = [replace(link, scheme=Scheme.NEWTON) for link in system.links]
    with pytest.raises(UnitError, match=r'soil\.pad: scheme "quasi-newton" cannot replace the reduced interface model'):
        prepared(System(system.slaves, forced, system.pairs, recorded=system.recorded), MasterSettings())


def test_what_was_asked_for_and_cannot_be_done_is_told() -> None:
    master = oscillator(MasterSettings(), spring_unit=spring(rollback=False), scheme=Scheme.NEWTON)
    assert {record.scheme for record in master.connections()} == {"explicit"}
    assert all("quasi-newton was asked for" in record.detail for record in master.connections())


def test_a_chain_without_a_loop_is_one_way() -> None:
    units = [relaxing(1), relaxing(2)]
    units[1].name = "second"
    master = prepared(System(units, [Link(0, "y", 1, "x")]), MasterSettings())
    assert [record.scheme for record in master.connections()] == ["one way"]
