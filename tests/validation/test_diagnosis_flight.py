"""What a diagnosis reports is flown by the co-simulation of the units; what it searches with must be the same landing.

Setup      landings of 0.25 to 1.2 s from first contact, the built FMUs through the master
Tolerance  0.2 sigma RMS a channel between twin, units and the lander that flies them for a search (sigma: 1.7 mrad/s, 0.9 mrad, 6.35 mm,
           10 mm). Measured: 0.02 to 0.08. With friction 0.4 beside the ground effect 0.18, of which the units' tolerance has all: 1e-6 m
           against an eighth of it. The sensor behind the twin takes the rates as straight lines from instant to instant of the grid: over
           20 ms a lag of 0.1 s is 0.23 sigma off in roll, over 5 ms less than 0.04, so that it is landed on those
"""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import pytest
from conftest import orchestrator

from orchestrator.diagnosis.before_after import before_after, write_before_after
from orchestrator.diagnosis.effects import load_effect, load_library
from orchestrator.diagnosis.effects.effect import Effect
from orchestrator.diagnosis.flight import CoSimulation
from orchestrator.diagnosis.found_term import FoundTerm, body_term_insert, write_effect
from orchestrator.diagnosis.from_twin import said_by_address
from orchestrator.diagnosis.landing import ATTITUDE, NOMINALS, TELEMETRY, Course, TwinLander
from orchestrator.diagnosis.master_lander import MasterLanderMaker
from orchestrator.diagnosis.moves import Move, Named, applied_moves, effect_moves
from orchestrator.diagnosis.observation import NEAR, ORIGIN, Observation, Reading, Track
from orchestrator.diagnosis.outcome import Estimate
from orchestrator.diagnosis.overlay import overlay
from orchestrator.diagnosis.proof import Belief, Observed, in_sigmas, prove
from orchestrator.diagnosis.revision import write_revision
from orchestrator.diagnosis.term_fmu import build_term_fmu
from orchestrator.diagnosis.twin_parameters import twin_parameters
from orchestrator.scenario.read import read_table
from orchestrator.simulation import run_scenario

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
EFFECTS = load_library([SCENARIOS / "candidates"])
INSERTED = [name for name, effect in EFFECTS.items() if effect.insert is not None]
STOP = 1.2
LIMIT = 0.2
READ_OFF = 0.05  # sigma RMS a channel: a quarter of what the twin may differ from the units
FINAL = {f"leg{k}.{strut}.stroke": 0.00635 for k in (1, 2, 3, 4) for strut in ("primary", "right", "left")} | {
    f"soil{k}.{what}": 0.01 for k in (1, 2, 3, 4) for what in ("penetration", "skid")
}


def observation(course: Course | None = None, seed: int | None = None) -> Observation:
    """Apollo's channels every 50 ms; the readings of a course with noise, or zeros."""
    times = np.arange(0.0, STOP, 0.05)
    noise = np.random.default_rng(seed)
    tracks = [Track("rates", name, name, times, np.zeros(len(times)), 0.0017, 0.0) for name in TELEMETRY]
    tracks += [Track("attitude", name, name, times, np.zeros(len(times)), 0.0009, 0.0) for name in ATTITUDE]
    readings = [Reading(name, name, 0.0, sigma) for name, sigma in FINAL.items()]
    empty = Observation(tracks, readings)
    if course is None:
        return empty
    rows = empty.predicted(course, {})
    data = [rows[place] + 0.0 for place in empty.places]
    tracks = [Track(t.series, t.channel, t.column, t.times, d + t.sigma * noise.standard_normal(len(d)), t.sigma, 0.0)
              for t, d in zip(tracks, data, strict=False)]  # fmt: skip
    last = data[len(tracks) :]
    pairs = zip(readings, last, strict=True)
    readings = [Reading(r.name, r.column, float(d[0]) + r.sigma * noise.standard_normal(), r.sigma) for r, d in pairs]
    return Observation(tracks, readings)


def twin_of(simulation: CoSimulation) -> TwinLander:
    parameters, reason = twin_parameters(simulation.addresses)
    assert parameters is not None, reason
    lander, sensor = (simulation.addresses.library(name) for name in ("LunarLander", "RateSensor"))
    base: dict[str, float] = {}
    for name, values in parameters.items():
        prefix, interface = ("sensor.", sensor) if name.startswith("sensor.") else ("", lander)
        base |= {prefix + it.name: value for it, value in zip(interface.vectors[name.removeprefix(prefix)], values, strict=True)}
    return TwinLander(lander.path, sensor.path, base)


def farthest(one: Course | None, other: Course | None) -> float:
    """Largest RMS difference of a channel, sigma."""
    assert one is not None
    assert other is not None
    watched = observation()
    return max(in_sigmas(watched, watched.predicted(one, {}) - watched.predicted(other, {})).values())


@pytest.fixture(scope="module")
def zupp() -> Iterator[CoSimulation]:
    simulation = CoSimulation(SCENARIOS / "apollo11_zupp.toml")
    yield simulation
    simulation.close()


@pytest.fixture(scope="module")
def adams() -> Iterator[CoSimulation]:
    simulation = CoSimulation(SCENARIOS / "apollo11_adams.toml")
    yield simulation
    simulation.close()


def flown(simulation: CoSimulation, values: Mapping[str, list[float]], effect: Effect | None = None, stop: float = STOP) -> Course:
    inserts = [effect.insert] if effect is not None and effect.insert is not None else []
    watched = observation()
    flight = simulation.fly(values, inserts, stop, watched.columns, watched.final)
    assert flight.course is not None, flight.reason
    assert flight.reason == ""
    return flight.course


def test_loaded_units_fly_what_fresh_ones_fly_to_the_bit(zupp: CoSimulation) -> None:
    zupp.fly({"soil.friction": 0.4}, stop=0.1)
    again = zupp.fly({}, stop=0.25).result
    fresh = run_scenario(SCENARIOS / "apollo11_zupp.toml", changes={"stop_time": 0.25})
    assert again is not None
    assert again.columns.keys() == fresh.columns.keys()
    assert all((again.columns[name] == fresh.columns[name]).all() for name in fresh.columns)


def test_an_address_and_a_unit_s_own_name_are_the_same_flight(zupp: CoSimulation) -> None:
    flights = [zupp.fly({name: 0.5}, stop=0.1).course for name in ("soil[-Z].friction", "soil-Z.friction", "soil[+Z].friction")]
    columns = [np.concatenate(list(it.columns.values())) for it in flights if it is not None]
    assert (columns[0] == columns[1]).all()
    assert not (columns[0] == columns[2]).all()


def test_what_cannot_be_flown_says_why_and_the_next_flight_is_as_before(zupp: CoSimulation) -> None:
    before = zupp.fly({}, stop=0.1).course
    refused = zupp.fly({"body.mass": -1.0}, stop=0.1)
    assert refused.course is None
    assert "below its minimum" in refused.reason
    after = zupp.fly({}, stop=0.1).course
    assert before is not None
    assert after is not None
    assert all((before.columns[name] == after.columns[name]).all() for name in before.columns)


@pytest.mark.parametrize("name", INSERTED)
def test_an_effect_that_is_a_unit_flies_and_is_felt(name: str, zupp: CoSimulation) -> None:
    is_felt(EFFECTS[name], zupp)


def test_a_term_found_on_the_body_flies_and_is_felt(zupp: CoSimulation, tmp_path: Path) -> None:
    fixed = {"body_term.axis": 5, "body_term.basis": 5}
    words = ("Drag in pitch", "A torque against the pitch rate.", "κ_y = c ω_y/0.1")
    coefficient, estimate = "body_term.coefficient", Estimate(-900.0, 50.0, "1")
    term = FoundTerm("pitch_drag", *words, "body", "dissipative", coefficient, estimate, fixed, body_term_insert(zupp.addresses))
    is_felt(load_effect(write_effect(tmp_path, term)), zupp)


def is_felt(effect: Effect, zupp: CoSimulation) -> None:
    values = applied_moves(zupp.addresses, effect_moves(effect, effect.starts[0])).values
    base, there = flown(zupp, {}, stop=0.25), flown(zupp, values, effect, 0.25)
    assert max(np.abs(base.columns[column][-1] - there.columns[column][-1]) for column in (*TELEMETRY, *ATTITUDE)) > 1e-6


@pytest.mark.parametrize(
    ("scenario", "name", "parameters"),
    [
        ("zupp", "inertial_drag", {"drag": 3000.0}),
        ("zupp", "ground_effect", {"share": 0.3, "height": 0.2}),
        ("adams", "friction", {"friction": 0.1}),
        ("adams", "telemetry_lowpass", {"time_constant": 0.1}),
    ],
)
def test_the_twin_lands_as_the_units_do_with_an_effect(
    scenario: str, name: str, parameters: dict[str, float], request: pytest.FixtureRequest
) -> None:
    simulation: CoSimulation = request.getfixturevalue(scenario)
    effect = EFFECTS[name]
    given = {p.name: parameters.get(p.name, effect.starts[0][p.name]) for p in effect.parameters}
    values = applied_moves(simulation.addresses, effect_moves(effect, given)).values
    twin = twin_of(simulation)
    watched = observation()
    own = {}
    for address, numbers in values.items():
        names = simulation.addresses.twin(address)
        assert names is not None
        own |= dict(zip(names, np.resize(numbers, len(names)).tolist(), strict=True))
    grid = np.linspace(0.0, STOP, 241) if effect.kind == "sensor" else watched.grid(STOP, {})
    course = twin.land(own, grid, watched.columns, watched.final)
    base = twin.land({}, grid, watched.columns, watched.final)
    twin.close()
    units = flown(simulation, values, effect)
    assert farthest(course, units) < LIMIT
    assert farthest(base, units) > 1.0, "the effect is not felt"
    assert said_by_address(simulation.addresses, own).values == {address: list(numbers) for address, numbers in values.items()}


def test_the_master_lands_for_a_search_as_the_twin_does(zupp: CoSimulation) -> None:
    watched = observation()
    grid = watched.grid(STOP, {})
    effect = EFFECTS["ground_effect"]
    assert effect.insert is not None
    lander = MasterLanderMaker(SCENARIOS / "apollo11_zupp.toml", (effect.insert,))()
    twin = twin_of(zupp)
    bare = lander.land({}, grid, watched.columns, watched.final)
    rough = lander.land({"plume.share": 0.3}, grid, watched.columns, watched.final)
    assert farthest(bare, twin.land({}, grid, watched.columns, watched.final)) < LIMIT
    assert farthest(rough, twin.land({"plume.share": 0.3}, grid, watched.columns, watched.final)) < LIMIT
    assert farthest(bare, rough) > 1.0
    assert lander.land({"body.mass": -1.0}, grid, watched.columns, watched.final) is None
    assert lander.land({"nothing.share": 1.0}, grid, watched.columns, watched.final) is None
    again = lander.land({}, grid, watched.columns, watched.final)
    assert again is not None
    assert bare is not None
    assert all((again.columns[name] == bare.columns[name]).all() for name in bare.columns)
    lander.close()
    twin.close()


def test_the_proof_closes_the_gap_and_says_what_happens_without_the_effect(zupp: CoSimulation, tmp_path: Path) -> None:
    effect = EFFECTS["inertial_drag"]
    truth = applied_moves(zupp.addresses, effect_moves(effect, {"drag": 3000.0})).values
    landing = Observed("truth", observation(flown(zupp, truth), seed=1), STOP)
    softer = applied_moves(zupp.addresses, [Move("soil.friction", 0.4, "set")]).values
    null, winner, other = (Belief(name, [values], [{}]) for name, values in (("null", {}), ("winner", truth), ("other", softer)))
    proof = prove(zupp, [landing], null, winner, null, other)
    assert proof.warnings == []
    assert proof.gap.fit_before > 1.5
    assert proof.gap.fit_after == pytest.approx(1.0, abs=0.2)
    assert proof.gap.closure > 0.9
    assert proof.checks["interval"]["worst"] < LIMIT
    assert proof.checks["energy"]["worst"] < 1e-3
    assert all(path.is_file() for path in write_before_after(tmp_path, before_after(proof)))


def test_the_revised_scenario_runs_from_the_command_line(zupp: CoSimulation, tmp_path: Path) -> None:
    parameters = {"offset": Estimate(0.03, 0.002, "s")}
    drag = {"drag": Estimate(3000.0, 100.0, "N.s2/m2")}
    share = {"share": Estimate(0.3, 0.1, "1")}
    found = [Named(EFFECTS[n], p) for n, p in (("clock_offset", parameters), ("inertial_drag", drag), ("ground_effect", share))]
    revised = write_revision(tmp_path / "diagnosis", zupp.addresses, found)
    short = tmp_path / "short.toml"
    short.write_text('extends = "diagnosis/revised.toml"\nstop_time = 0.25\n', encoding="utf-8")
    assert revised.name == "revised.toml"
    done = orchestrator("run", short, "--out", tmp_path / "run", "--no-figures")
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "run" / "summary.json").read_text(encoding="utf-8"))
    assert summary["complete"]
    assert "the clock of rates reads +0.03 s: take that off its times" in summary["notes"]


def test_a_found_term_s_fmu_in_the_coupling_does_what_the_parameters_do(zupp: CoSimulation, tmp_path: Path) -> None:
    parameters = {"normal_term": 900.0, "normal_term_rate": 2.0, "normal_term_phase": 1}
    fmu = build_term_fmu(tmp_path, zupp.addresses.folder / "RegolithContact.fmu", parameters, "SoilMomentum")
    as_they_were = read_table(SCENARIOS / "apollo11_zupp.toml")["units"]["soil{leg}"]["parameters"]
    changes = {"stop_time": 0.25, "units": {"soil{leg}": {"fmu": str(fmu), "parameters": as_they_were}}}
    replaced = run_scenario(SCENARIOS / "apollo11_zupp.toml", changes=changes)
    tree = overlay(zupp.addresses, {f"soil.{name}": float(value) for name, value in parameters.items()})
    told = run_scenario(SCENARIOS / "apollo11_zupp.toml", changes={"stop_time": 0.25, **tree})
    assert all((replaced.columns[name] == told.columns[name]).all() for name in told.columns)


def test_a_landing_beside_another_is_the_landing(zupp: CoSimulation) -> None:
    """The same within what the twin's tolerance leaves (LIMIT), itself to the last bit, and what cannot be flown is not."""
    watched, twin = observation(), twin_of(zupp)
    grid, nominal = watched.grid(STOP, {}), {"tolerance": 3e-4}
    asked = grid, watched.columns, watched.final
    alone, itself = twin.land(nominal, *asked), twin.land(nominal, *asked, nominal)
    assert twin.varies
    assert alone is not None
    assert itself is not None
    assert all(np.array_equal(alone.columns[name], itself.columns[name]) for name in alone.columns)
    for change in ({"mass": 7200.0}, {"soil.friction[1]": 0.4}, {"slosh.mass": 200.0}, {"sensor.time_constant": 0.02}):
        own = twin.land({**nominal, **change}, *asked)
        assert farthest(own, twin.land({**nominal, **change}, *asked, nominal)) < LIMIT
        assert farthest(own, alone) > LIMIT, "the change is not felt"
    assert twin.land({**nominal, "mass": -1.0}, *asked, nominal) is None
    assert farthest(twin.land(nominal, *asked, {"mass": -1.0}), alone) == 0.0, "on its own where the nominal cannot be flown"
    twin.close()


def test_samples_are_read_off_a_landing_whose_grid_meets_them_by_another_clock(zupp: CoSimulation) -> None:
    """As if it had been flown for them, as long as the clocks count as alike."""
    watched, twin = observation(), twin_of(zupp)
    for late in ({ORIGIN: 0.9 * NEAR}, {ORIGIN: -0.9 * NEAR}):
        assert watched.dated_alike(late, {})
        read, met = (twin.land({}, watched.grid(STOP, clock), watched.columns, watched.final) for clock in ({}, late))
        assert read is not None
        assert met is not None
        apart = in_sigmas(watched, watched.predicted(read, late) - watched.predicted(met, late))
        assert max(apart.values()) < READ_OFF, apart
    twin.close()


def test_a_nominal_that_cannot_be_flown_takes_no_other_s_place(zupp: CoSimulation) -> None:
    """All places taken, one given up for a nominal in vain: the next one must not be kept where another still is."""
    watched, twin = observation(), twin_of(zupp)
    asked = watched.grid(0.1, {}), watched.columns, watched.final
    for mass in (*(7000.0 + 10.0 * k for k in range(NOMINALS)), -1.0, 7100.0):
        twin.land({"mass": 7001.0}, *asked, {"mass": mass})
    assert sorted(one.place for one in twin.nominals.values()) == list(range(1, NOMINALS + 1))
    twin.close()


def test_more_nominal_landings_than_the_unit_keeps(zupp: CoSimulation) -> None:
    watched, twin = observation(), twin_of(zupp)
    asked = watched.grid(STOP, {}), watched.columns, watched.final
    first = None
    for mass in [7000.0 + 10.0 * k for k in range(NOMINALS + 2)] + [7000.0]:
        found = twin.land({"mass": mass + 1.0}, *asked, {"mass": mass})
        first = first or found
    assert first is not None
    assert found is not None
    assert all(np.array_equal(first.columns[name], found.columns[name]) for name in first.columns)
    twin.close()
