"""When a finished run is still not to be trusted."""

import pytest
from master_samples import oscillator

from orchestrator.master.result import LedgerRow
from orchestrator.master.settings import MasterSettings
from orchestrator.master.trust import distrust, worst_leak


def row(leak: float, throughput: float) -> LedgerRow:
    return LedgerRow("a.p", "b.q", 10.0, -10.0 + leak, throughput)


def test_a_ledger_that_closes_is_no_ground_for_distrust() -> None:
    assert worst_leak([row(0.1, 100.0), row(-0.1, 50.0)], 0.05) is None


@pytest.mark.parametrize("leak", [6.0, -6.0])
def test_energy_made_or_lost_beyond_the_limit_is(leak: float) -> None:
    failing = worst_leak([row(0.1, 1000.0), row(leak, 100.0)], 0.05)
    assert failing is not None
    assert failing.leak == pytest.approx(leak)


def test_a_connection_that_carried_next_to_nothing_is_not_judged_by_its_own_share() -> None:
    assert worst_leak([row(0.0, 1000.0), row(0.2, 0.3)], 0.05) is None


def test_a_missed_tolerance_names_the_port_and_an_interval_that_would_do() -> None:
    """The estimate is of second order at worst, so the interval named must hold the tolerance."""
    master = oscillator(MasterSettings(max_interval=5e-3, min_interval=5e-3, tolerance=1e-7))
    master.run()
    message = distrust(master, "case.toml")
    assert message.startswith("case.toml: ")
    assert " at a, t = " in message
    named = float(message.split("an interval of about ")[1].split(" s ")[0])
    again = oscillator(MasterSettings(max_interval=named, min_interval=named / 2, tolerance=1e-7))
    again.run()
    assert distrust(again, "case.toml") == ""
