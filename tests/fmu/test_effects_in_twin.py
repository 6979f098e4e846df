"""Effects in the twin FMU through FMI: null is nothing, and energy is as the effect's file declares it.

Setup      the Zupp-like landing, 0.6 s from first contact, 10 ms steps, the twin alone
Tolerance  null: none, bit for bit. Energy: 0.1 J of 2.7 kJ kinetic; the twin's steps leave 0.01 J,
           and the least work of an active effect is 0.4 J
"""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.effects import Effect, load_library
from orchestrator.diagnosis.twin_parameters import Parameters, twin_parameters
from orchestrator.fmi.slave2 import Fmi2Unit
from orchestrator.master.slave import Binding, Kind, Status, Value
from orchestrator.simulation import run_scenario

Array = NDArray[np.float64]
ROOT = Path(__file__).resolve().parents[2]
ZUPP = ROOT / "scenarios" / "apollo11_zupp.toml"
EFFECTS = load_library([ROOT / "scenarios" / "candidates"])
IN_FLIGHT = [name for name, effect in EFFECTS.items() if effect.kind != "sensor"]
STEPS, STEP = 60, 0.01
LEGS = (1, 2, 3, 4)
OUTPUTS = (
    *(f"body.{what}[{i}]" for what in ("position", "velocity", "angular_velocity") for i in (1, 2, 3)),
    *("energy.kinetic", "energy.potential", "engine.work", "effects.work"),
    *(f"leg{k}.{what}" for k in LEGS for what in ("energy.dissipated", "pad.work", "primary.stroke", "left.stroke", "right.stroke")),
    *(f"soil{k}.{what}" for k in LEGS for what in ("penetration", "skid", "gap")),
)


class Flight(NamedTuple):
    """Rows of OUTPUTS, the first at the start."""

    rows: Array

    def __getitem__(self, name: str) -> Array:
        return self.rows[:, OUTPUTS.index(name)]

    def legs(self, what: str) -> Array:
        """Sum over the legs."""
        return np.asarray(sum(self[f"leg{k}.{what}"] for k in LEGS))


class Twin:
    """One instance, started anew for each landing."""

    def __init__(self, fmu: Path) -> None:
        self.unit = Fmi2Unit("lander", fmu)
        self.y = np.zeros(len(OUTPUTS))
        self.unit.bind(Binding((), (), OUTPUTS, len(OUTPUTS), np.zeros(0), self.y))

    def land(self, parameters: Parameters) -> Flight:
        values = flat(parameters)
        values["position_start[1]"] = 4.0
        self.start(values)
        values["position_start[1]"] = 4.0 - min(self.y[OUTPUTS.index(f"soil{k}.gap")] for k in LEGS)
        self.start(values)
        rows = [self.y.copy()]
        for n in range(STEPS):
            assert self.unit.step(n * STEP, STEP) is Status.OK
            rows.append(self.y.copy())
        return Flight(np.array(rows))

    def start(self, values: Mapping[str, Value]) -> None:
        self.unit.set_up(0.0, 10.0, values)
        self.unit.exchange()
        self.unit.begin()


def flat(parameters: Parameters) -> dict[str, Value]:
    return {f"{key}[{i}]" if len(values) > 1 else key: value for key, values in parameters.items() for i, value in enumerate(values, 1)}


Land = Callable[[Effect | None, Mapping[str, float]], Flight]


@pytest.fixture(scope="module")
def land(fmus: dict[str, Path]) -> Iterator[Land]:
    """A landing with an effect's parameters at the given values."""
    folder = str(fmus["LunarLander"].parent)
    addresses = Addresses(draw_up(read_scenario(ZUPP, changes={"fmus": folder}), ZUPP))
    twin = Twin(fmus["LunarLander"])
    interface = twin.unit.interface
    parameters, reason = twin_parameters(addresses)
    assert parameters is not None, reason
    base = {name: value for name, value in flat(parameters).items() if not name.startswith("sensor.")}
    whole = {name for name in base if interface.variables[name].kind is not Kind.REAL}
    known: dict[str, Flight] = {}

    def run(effect: Effect | None, chosen: Mapping[str, float]) -> Flight:
        values = {name: [float(value)] for name, value in base.items()}
        for parameter in effect.parameters if effect else ():
            for sign, address in parameter.signed_targets():
                for name in addresses.twin(address) or ():
                    p = sign * chosen.get(parameter.name, parameter.null)
                    old = values[name][0] if name in values else float(str(interface.variables[name].start))
                    values[name] = [old * np.exp(p) if parameter.operation == "scale" else old + p]
        key = str(sorted(values.items()))
        if key not in known:
            settled = {name: [int(it[0])] if name in whole else it for name, it in values.items()}
            known[key] = twin.land(settled)
        return known[key]

    yield run
    twin.unit.close()


@pytest.fixture(scope="module")
def base(land: Land) -> Flight:
    return land(None, {})


def unexplained(flight: Flight) -> Array:
    """Energy that came from nowhere, J."""
    mechanical = flight["energy.kinetic"] + flight["energy.potential"]
    came_in = flight["engine.work"] + flight["effects.work"] + flight.legs("pad.work")
    return mechanical - mechanical[0] - came_in + flight.legs("energy.dissipated")


@pytest.mark.slow
def test_the_twin_with_a_scenario_s_parameters_lands_as_its_units_do(base: Flight, fmus: dict[str, Path]) -> None:
    """Within 0.2 sigma of the rates of Apollo 11's telemetry, 0.0017 rad/s, RMS."""
    result = run_scenario(ZUPP, changes={"stop_time": STEPS * STEP, "fmus": str(fmus["LunarLander"].parent)})
    times = STEP * np.arange(STEPS + 1)
    for i in (1, 2, 3):
        units = np.interp(times, result.times, result.columns[f"body.body.angular_velocity[{i}]"])
        assert np.sqrt(np.mean((units - base[f"body.angular_velocity[{i}]"]) ** 2)) < 0.2 * 0.0017


@pytest.mark.parametrize("name", IN_FLIGHT)
def test_an_effect_at_null_leaves_the_landing_as_it_was_to_the_last_bit(name: str, land: Land, base: Flight) -> None:
    """Whatever its other parameters are, where the first one is its strength."""
    effect = EFFECTS[name]
    np.testing.assert_array_equal(land(effect, {}).rows, base.rows)
    if effect.name in ("layering", "rebound", "stribeck", "ground_effect", "slosh"):
        others = {it.name: it.starts[-1] for it in effect.parameters[1:]}
        np.testing.assert_array_equal(land(effect, others).rows, base.rows)


@pytest.mark.parametrize("start", [20_000.0, 369_939.9])
def test_a_run_on_another_clock_is_the_same(fmus: dict[str, Path], start: float) -> None:
    """Corners of a firing are met, and no interval is lost, where instants are known to 6e-11 s only: Apollo's own clock.

    0.6 s from 10 m up, a firing of 1 kN m from 0.1037 s on. Tolerance 1e-10 rad/s: 6e-11 s of its 0.06 rad/s2 is 4e-12; 1e-9 m.
    """
    twin, ends = Twin(fmus["LunarLander"]), []
    values: dict[str, Value] = {"position_start[1]": 10.0, "rcs.torque[2]": 1000.0, "rcs.start": 0.1037, "tolerance": 1e-7}
    for begin in (0.0, start):
        twin.unit.set_up(begin, begin + 10.0, values)
        twin.unit.exchange()
        twin.unit.begin()
        rows = []
        for n in range(30):
            assert twin.unit.step(begin + 0.02 * n, 0.02) is Status.OK
            rows.append(twin.y[:9].copy())  # an interval that was lost would show what the one before left
        ends.append(np.array(rows))
    twin.unit.close()
    np.testing.assert_allclose(ends[1][:, :6], ends[0][:, :6], atol=1e-9, rtol=0.0)
    np.testing.assert_allclose(ends[1][:, 6:], ends[0][:, 6:], atol=1e-10, rtol=0.0)
    assert ends[0][-1, 7] == pytest.approx(0.4963 * 1000.0 / 17409.0, rel=0.02)


def test_a_firing_without_torque_may_begin_at_any_time(land: Land, base: Flight) -> None:
    np.testing.assert_array_equal(land(EFFECTS["rcs_pulse"], {"start": 0.1037}).rows, base.rows)


@pytest.mark.parametrize("name", IN_FLIGHT)
def test_an_effect_at_a_start_changes_the_landing_and_its_energy_is_accounted_for(name: str, land: Land, base: Flight) -> None:
    flight = land(EFFECTS[name], EFFECTS[name].starts[0])
    assert not np.array_equal(flight.rows, base.rows)
    assert np.abs(unexplained(flight)).max() < 0.1


@pytest.mark.parametrize("name", [name for name in IN_FLIGHT if EFFECTS[name].port.startswith("soil")])
def test_soil_never_gives_more_than_it_took(name: str, land: Land) -> None:
    for start in EFFECTS[name].starts:
        assert land(EFFECTS[name], start).legs("pad.work").max() < 1e-6


@pytest.mark.parametrize("name", [name for name in IN_FLIGHT if EFFECTS[name].energy == "dissipative" and EFFECTS[name].port == "strut"])
def test_a_dissipative_strut_effect_takes_energy_at_all_times(name: str, land: Land, base: Flight) -> None:
    taken = land(EFFECTS[name], EFFECTS[name].starts[0]).legs("energy.dissipated")
    assert np.diff(taken).min() > -1.0  # J: elastic energy of the cores, given back
    assert taken[-1] > 0.0


@pytest.mark.parametrize("name", [name for name in IN_FLIGHT if EFFECTS[name].energy == "active"])
def test_an_active_effect_does_work_of_its_own(name: str, land: Land, base: Flight) -> None:
    flight = land(EFFECTS[name], EFFECTS[name].starts[0])
    assert abs(flight["effects.work"][-1] - base["effects.work"][-1]) > 1e-3


@pytest.mark.parametrize("name", [name for name, effect in EFFECTS.items() if effect.kind == "sensor"])
def test_a_sensor_effect_acts_behind_the_vehicle(name: str) -> None:
    places = {address.partition(".")[0] for it in EFFECTS[name].parameters for _, address in it.signed_targets()}
    assert places <= {"sensor", "clock"}
    assert EFFECTS[name].energy == "none"
