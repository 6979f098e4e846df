"""How a search flies a scenario: by the twin where it can stand in, else by the scenario's own units through the master."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.effects.effect import Effect
from orchestrator.diagnosis.landing import Course, Lander, TwinLander
from orchestrator.diagnosis.master_lander import MasterLanderMaker, unit_base, unit_slots
from orchestrator.diagnosis.places import CLOCK, TWIN
from orchestrator.diagnosis.starts import number_of
from orchestrator.diagnosis.twin_parameters import twin_parameters
from orchestrator.errors import UserError
from orchestrator.master.slave import Interface, Kind
from orchestrator.scenario.locate import find_fmu

Array = NDArray[np.float64]
TOLERANCE = 3e-4  # m/s, of the twin: φ jumps by 0.07 from a point to the one beside it, by 1 to 2 at 3e-3
LONGEST = 0.02  # s, its longest step


@dataclass(frozen=True)
class TwinMaker:
    """Makes the twin's landers, in whatever process."""

    lander: Path
    sensor: Path
    base: Mapping[str, float]

    def __call__(self) -> Lander:
        return TwinLander(self.lander, self.sensor, self.base)


@dataclass
class Vehicle:
    """How a search flies the scenario: the twin, or, where it cannot stand in, the scenario's own units through the master."""

    addresses: Addresses
    make: Callable[[], Lander]
    base: dict[str, float]
    """The scenario's values in the lander's names."""
    slots: Callable[[str], list[list[str]]]
    """The lander's variables of each component of an address; nothing where it has none."""
    why_slow: str = ""
    """Why the twin cannot stand in; empty where it does."""


def vehicle_of(addresses: Addresses, effects: Mapping[str, Effect], overrides: Sequence[str] = ()) -> Vehicle:
    """The twin where it can stand in for the scenario, else the units themselves."""
    if addresses.is_twin:
        raise UserError(f"{addresses.where}: is the {TWIN}, as a search flies it anyway; give a scenario of separate units")
    parameters, reason = twin_parameters(addresses)
    twin, sensor = addresses.library(TWIN), addresses.library("RateSensor")
    if parameters is None or twin is None or sensor is None:
        return _slow(addresses, effects, overrides, reason or f"{addresses.folder} has no {TWIN}.fmu or RateSensor.fmu")
    base = _starts(twin, "") | _starts(sensor, "sensor.")
    for name, values in parameters.items():
        prefix, interface = ("sensor.", sensor) if name.startswith("sensor.") else ("", twin)
        base |= {prefix + v.name: float(x) for v, x in zip(interface.vectors[name.removeprefix(prefix)], values, strict=True)}
    base |= {"tolerance": TOLERANCE, "longest_step": LONGEST}
    return Vehicle(addresses, maker(addresses, base), base, lambda address: slots_of(addresses, address))


def _slow(addresses: Addresses, effects: Mapping[str, Effect], overrides: Sequence[str], reason: str) -> Vehicle:
    path = addresses.blueprint.path
    if path is None:
        raise UserError(f"{addresses.where}: {reason}, and the scenario is no file; save it")
    inserts = tuple({e.insert.unit: e.insert for e in effects.values() if e.insert is not None}.values())
    base = unit_base(addresses, inserts)
    make = MasterLanderMaker(path, inserts, tuple(overrides))

    def slots(address: str) -> list[list[str]]:
        return [[address]] if address.startswith(f"{CLOCK}.") else unit_slots(addresses, address)

    return Vehicle(addresses, DifferingMaker(make, base), base, slots, reason)


@dataclass(frozen=True)
class DifferingMaker:
    """Landers that are told only what differs from the scenario: a unit to be added comes in with the first value it is given."""

    make: Callable[[], Lander]
    base: Mapping[str, float]

    def __call__(self) -> Lander:
        return DifferingLander(self.make(), self.base)


class DifferingLander:
    """See DifferingMaker."""

    def __init__(self, lander: Lander, base: Mapping[str, float]) -> None:
        self.lander, self.base = lander, base
        self.varies = lander.varies

    def land(
        self,
        values: Mapping[str, float],
        grid: Array,
        columns: Sequence[str],
        final: Sequence[str],
        beside: Mapping[str, float] | None = None,
    ) -> Course | None:
        nominal = None if beside is None else self._differing(beside)
        return self.lander.land(self._differing(values), grid, columns, final, nominal)

    def _differing(self, values: Mapping[str, float]) -> dict[str, float]:
        return {n: v for n, v in values.items() if self.base.get(n) != v}

    def close(self) -> None:
        self.lander.close()


def _starts(interface: Interface, prefix: str) -> dict[str, float]:
    """What the unit starts from by itself: effects add to it."""
    parameters = (v for v in interface.of("parameter") if v.kind is not Kind.STRING)
    return {prefix + v.name: number_of(v.start) for v in parameters}


def maker(addresses: Addresses, base: Mapping[str, float]) -> TwinMaker:
    """Landers of the twin, from the FMUs that the scenario's own stand beside."""
    where = f"{addresses.where}: twin"
    return TwinMaker(find_fmu(TWIN, addresses.folder, where), find_fmu("RateSensor", addresses.folder, where), dict(base))


def slots_of(addresses: Addresses, address: str) -> list[list[str]]:
    """The lander's variables of each component of an address. Nothing where it has none."""
    if address.startswith(f"{CLOCK}."):
        return [[address]]
    names = addresses.twin(address)
    if not names:
        return []
    groups = addresses.groups(address)
    if len(groups) == 1:
        return [names]
    whole = address if "." in address else ""
    parts = [addresses.twin(f"{whole}[{i + 1}]") for i in range(len(groups))] if whole else [[n] for n in names]
    return [list(part) for part in parts if part]
