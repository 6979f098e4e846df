"""The proof's arithmetic, with a co-simulation made of three lines."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from orchestrator.diagnosis.before_after import before_after, write_before_after
from orchestrator.diagnosis.flight import Flight
from orchestrator.diagnosis.landing import ATTITUDE, Course
from orchestrator.diagnosis.observation import Observation, Reading, Track
from orchestrator.diagnosis.proof import Belief, Observed, Proof, numerics_gate, prove
from orchestrator.master.settings import MasterSettings

TIMES = np.linspace(0.0, 1.0, 41)
PITCH = ATTITUDE[1]
SIGMA = 0.01


class Stub:
    """pitch = slope t; half the interval moves it by `unresolved`, half of that by half as much; `wild`: every flight moves it."""

    def __init__(self, unresolved: float = 0.0, reason: str = "", wild: float = 0.0) -> None:
        table = SimpleNamespace(master=MasterSettings())
        self.addresses = SimpleNamespace(blueprint=SimpleNamespace(scenario=SimpleNamespace(table=table)))
        self.unresolved, self.reason, self.wild, self.flown = unresolved, reason, wild, 0
        self.intervals: list[float] = []

    def fly(self, values: Any, inserts: Any, stop: float, columns: Any, final: Any, settings: Any = None) -> Flight:
        self.flown += 1
        if values.get("fails"):
            return Flight(None, "leg+Z gave up")
        share = settings["master"]["max_interval"] / MasterSettings().max_interval if settings else 1.0
        self.intervals.append(share)
        pitch = values["slope"] * TIMES + 2.0 * self.unresolved * share + self.wild * self.flown
        return Flight(Course(TIMES, {PITCH: pitch}, {"stroke": values["slope"]}), self.reason)


def observed(name: str, slope: float, holdout: bool = False) -> Observed:
    noise = SIGMA * np.random.default_rng(3).standard_normal(len(TIMES))
    track = Track("attitude", PITCH, PITCH, TIMES, slope * TIMES + noise, SIGMA, 0.0)
    return Observed(name, Observation([track], [Reading("stroke.+Z", "stroke", slope, SIGMA)]), 1.0, holdout)


def belief(slope: float, count: int = 2, predicted: float | None = None) -> Belief:
    rows = [] if predicted is None else [np.append(predicted * TIMES, predicted)] * count
    return Belief("b", [{"slope": slope}] * count, [{}] * count, (), rows)


@pytest.fixture
def proof() -> Proof:
    landings = [observed("one", 1.0), observed("two", 1.0, holdout=True)]
    return prove(Stub(), landings, belief(0.5), belief(1.0, predicted=1.001), belief(0.6), belief(0.9))


def test_the_gap_closes_on_the_held_out_landing(proof: Proof) -> None:
    assert proof.gap.fit_before > 20.0
    assert proof.gap.holdout_before > 20.0
    assert proof.gap.fit_after == pytest.approx(1.0, abs=0.2)
    assert proof.gap.closure == pytest.approx(1.0, abs=0.02)
    assert proof.simulations == 2 * 4 + 2


def test_ablation_and_placebo_do_worse(proof: Proof) -> None:
    assert proof.checks["ablation"]["ok"]
    assert proof.checks["placebo"]["ok"]
    assert proof.checks["twin"]["worst"] == pytest.approx(0.1, rel=0.01)
    assert proof.warnings == []


def test_a_twin_that_is_off_an_ablation_that_is_as_good_and_a_better_runner_up_are_warned_of() -> None:
    landings = [observed("one", 1.0)]
    found = prove(Stub(), landings, belief(0.5, 1), belief(0.95, 1, predicted=0.9), belief(0.95, 1), belief(1.0, 1))
    twin, ablation, placebo = found.warnings
    assert twin.startswith("twin and units differ by 5.00 sigma")
    assert ablation.startswith("without the effect chi-square rises by 0.0 only")
    assert placebo.startswith("the runner-up does as well in the co-simulation")


def test_an_unresolved_simulation_is_resolved_by_finer_intervals_or_fails_the_gate() -> None:
    landing, wild = observed("one", 1.0), Stub(wild=0.01)
    fine, coarse = (numerics_gate(Stub(u), {"slope": 1.0}, (), landing, {}) for u in (0.001, 0.007))
    assert (fine.ok, fine.halved, fine.settings) == (True, 0, {})
    assert fine.worst == pytest.approx(0.1)
    assert (coarse.ok, coarse.halved) == (True, 2)
    assert (coarse.own, coarse.worst) == pytest.approx((0.7, 0.175))
    assert coarse.settings["max_interval"] == pytest.approx(0.25 * MasterSettings().max_interval)
    assert coarse.settings["tolerance"] == pytest.approx(0.25 * MasterSettings().tolerance)
    never = numerics_gate(wild, {"slope": 1.0}, (), landing, {})
    assert (never.ok, never.halved, never.settings) == (False, 0, {})
    assert never.worst == pytest.approx(1.0)
    assert wild.intervals == [1.0, 0.5, 0.25, 0.125, 0.0625]


def test_what_the_scenarios_interval_does_not_resolve_is_flown_with_a_finer_one() -> None:
    simulation = Stub(0.003)
    found = prove(simulation, [observed("one", 1.0)], belief(0.5, 1), belief(1.0, 1))
    assert simulation.intervals == [1.0, 0.5, 0.25, 0.5, 0.5]
    assert found.checks["interval"]["halved"] == 1
    assert found.warnings[0] == (
        "half the scenario's interval and tolerance move a channel by 0.30 sigma: flown with 0.5 of both, half of which moves 0.15 sigma"
    )


class Branching(Stub):
    """Runs with more than `until` of the interval take a branch that is off by 0.005."""

    until = 0.25

    def fly(self, values: Any, inserts: Any, stop: float, columns: Any, final: Any, settings: Any = None) -> Flight:
        flight = super().fly(values, inserts, stop, columns, final, settings)
        assert flight.course is not None
        off = 0.005 if self.intervals[-1] > self.until else 0.0
        return Flight(Course(TIMES, {PITCH: flight.course.columns[PITCH] + off}, flight.course.final), flight.reason)


def test_units_that_agree_with_the_twin_by_finer_intervals_alone_are_flown_with_these() -> None:
    simulation, landings = Branching(), [observed("one", 1.0), observed("two", 1.0, holdout=True)]
    found = prove(simulation, landings, belief(0.5, predicted=0.5), belief(1.0, predicted=1.0))
    assert simulation.intervals == [1.0, 0.5, 1.0, 1.0, 1.0, 1.0, 0.5, 0.25, 0.25, 0.25, 0.25, 0.25]
    assert found.numerics.settings["max_interval"] == pytest.approx(0.25 * MasterSettings().max_interval)
    assert found.checks["twin"]["worst"] == pytest.approx(0.0, abs=1e-9)
    assert found.warnings == [
        "twin and units differ by 0.50 sigma with the scenario's interval and tolerance, though half of them changes nothing: "
        "flown with 0.25 of both"
    ]


def test_where_the_gate_has_halved_already_both_are_said() -> None:
    simulation = Branching(0.003)
    simulation.until = 0.2
    found = prove(simulation, [observed("one", 1.0)], belief(0.5, 1), belief(1.0, 1, predicted=1.0))
    assert (found.numerics.halved, found.numerics.agreed) == (1, 3)
    assert found.warnings == [
        "half the scenario's interval and tolerance move a channel by 0.30 sigma: flown with 0.5 of both, half of which moves 0.15 sigma",
        "twin and units differ by 0.80 sigma with 0.5 of the scenario's interval and tolerance, though half of them changes nothing: "
        "flown with 0.125 of both",
    ]


def test_units_that_never_agree_with_the_twin_are_flown_as_the_scenario_says() -> None:
    simulation = Branching()
    simulation.until = 0.0
    found = prove(simulation, [observed("one", 1.0)], belief(0.5, 1), belief(1.0, 1, predicted=1.0))
    assert simulation.intervals == [1.0, 0.5, 1.0, 1.0, 0.5, 0.25, 0.125]
    assert found.numerics.settings == {}
    assert found.warnings == ["twin and units differ by 0.50 sigma: the search's own numbers are not exact"]


def test_a_run_that_cannot_be_trusted_fails_the_gate() -> None:
    gate = numerics_gate(Stub(reason="2 % of the steps missed the tolerance"), {"slope": 1.0}, (), observed("one", 1.0), {})
    assert not gate.ok
    assert gate.reason == "2 % of the steps missed the tolerance"


def test_a_landing_that_cannot_be_flown_is_said() -> None:
    landings = [observed("one", 1.0)]
    failing = Belief("b", [{"fails": 1.0}], [{}])
    found = prove(Stub(), landings, belief(0.5, 1), failing)
    assert "winner, one: leg+Z gave up" in found.warnings
    assert "whether half the interval and tolerance change anything is not known: leg+Z gave up" in found.warnings
    assert np.isnan(found.gap.fit_after)
    assert not found.numerics.ok


def test_before_and_after_are_written_sample_by_sample(proof: Proof, tmp_path: Path) -> None:
    text, table = write_before_after(tmp_path, before_after(proof))
    rows = pq.read_table(table)
    assert rows.num_rows == 2 * (len(TIMES) + 1)
    assert text.read_text("utf-8").splitlines()[0] == "landing,channel,time_s,data,before,after,sigma"
    np.testing.assert_allclose(rows["before"].to_numpy()[: len(TIMES)], 0.5 * TIMES)
    np.testing.assert_allclose(rows["after"].to_numpy()[: len(TIMES)], TIMES)
