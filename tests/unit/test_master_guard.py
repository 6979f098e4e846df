"""Explicit coupling beyond its limit ends with an error that names the connection and an interval that would do."""

import re

import pytest
from master_samples import prepared
from quarter_vehicle import error_of, quarter_vehicle

from orchestrator.errors import TrustError
from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.master import Master
from orchestrator.master.settings import MasterSettings
from orchestrator.master.system import Link, PortPair, Scheme, System

MASS, DAMPING = 2.0, 1000.0
LIMIT = MASS / DAMPING      # s; each side takes the other's value at the start of the interval


def exactly(interval: float) -> MasterSettings:
    return MasterSettings(max_interval=interval, min_interval=interval, tolerance=1e9)


def damped(interval: float) -> Master:
    """A mass on a damper that cannot roll back; no member is called velocity, so nothing estimates the error."""

    def move(s: dict, u: dict, t: float, h: float) -> dict:
        s["w"] += h * u["p.f"] / MASS
        return {"p.w": s["w"]}

    mass = FunctionUnit("mass", {"p.f": 0.0}, {"w": 1.0}, lambda s, u: {"p.w": s["w"]}, move)
    damper = FunctionUnit(
        "damper",
        {"p.w": 0.0},
        {},
        lambda s, u: {"p.f": -DAMPING * u["p.w"]},
        lambda s, u, t, h: {"p.f": -DAMPING * u["p.w"]},
        rollback=False,
    )
    links = [Link(0, "p.w", 1, "p.w"), Link(1, "p.f", 0, "p.f")]
    return prepared(System([mass, damper], links, [PortPair(0, "p", 1, "p")], recorded=[["p.w"], []]), exactly(interval))


@pytest.mark.parametrize("share", [1.3, 2.0, 5.0])
def test_swings_that_grow_stop_the_run_early_and_the_interval_named_would_do(share: float) -> None:
    master = damped(share * LIMIT)
    with pytest.raises(TrustError, match=r"mass <-> damper: explicit coupling is beyond its stability limit") as caught:
        master.run()
    assert len(master.recorder.times) < 120
    found = re.search(r"an interval of about (\S+) s would do", str(caught.value))
    assert found is not None
    named = float(found[1])
    assert 0.2 * LIMIT < named < LIMIT
    again = damped(named)
    again.run()
    assert abs(again.recorder.columns()["mass.p.w"][-1]) < 1e-6


def test_below_the_limit_nothing_stops() -> None:
    master = damped(0.4 * LIMIT)
    master.run()
    assert master.complete


def test_the_quarter_vehicle_at_half_a_millisecond_is_stopped_though_no_tolerance_is_asked() -> None:
    master = quarter_vehicle(exactly(5e-4), Scheme.EXPLICIT)
    with pytest.raises(TrustError, match="vehicle <-> soil: explicit coupling is beyond"):
        master.run()


def test_the_quarter_vehicle_within_the_limit_is_not() -> None:
    master = quarter_vehicle(exactly(1e-4), Scheme.EXPLICIT)
    master.run()
    assert error_of(master) < 3e-3
