"""A scenario as a set of coordinates: what is known before a landing, what is known to a few per cent only, and each effect."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import log
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.coordinates import Coordinate, applied
from orchestrator.diagnosis.effects import Effect, load_library
from orchestrator.diagnosis.landing import TwinLander
from orchestrator.diagnosis.observation import ORIGIN
from orchestrator.diagnosis.places import LEGS
from orchestrator.diagnosis.starts import number_of
from orchestrator.diagnosis.twin_parameters import twin_parameters
from orchestrator.simulation import draw_up, read_scenario

Array = NDArray[np.float64]
ROOT = Path(__file__).resolve().parents[2]
ZUPP = ROOT / "scenarios" / "apollo11_zupp.toml"
TOLERANCES = ROOT / "scenarios" / "tolerances.toml"
LIBRARY = ROOT / "scenarios" / "candidates"
CLOCKS_APART = 0.1  # s: how well the data's clock is known against first contact
JITTER = 0.02  # of everything below: the reality gap
JITTERED = (
    "mass", "body.inertia[1]", "body.inertia[2]", "body.inertia[3]", "gear.primary_load", "gear.compression_load", "gear.tension_load",
    "gear.bearing_friction", "gear.joint_damping", "gear.damping_ratio", "gear.origin_height", "gear.primary_strut_mass",
    "gear.footpad_mass", "soil.plowing", "guidance.thrust_start", "guidance.decay_time",
)  # fmt: skip
_SOIL = re.compile(r"soil\.(?P<name>[\w.]+)\[(?P<index>\d+)\]")
_ELSEWHERE = ("guidance.", "sensor.", "plume.", "slosh.", "rcs.", "body_term.")


@dataclass(frozen=True)
class Known:
    """What was known of a parameter before the landing; `spread` is of the logarithm where `of_log`."""

    name: str
    mean: tuple[float, ...]
    spread: float
    unit: str
    of_log: bool = False


class Vehicle:
    """The scenario under test, its library of effects, and its twin."""

    def __init__(self, scenario: Path = ZUPP, effects: Path = LIBRARY) -> None:
        self.scenario = scenario
        self.addresses = Addresses(draw_up(read_scenario(scenario), scenario))
        self.effects = load_library([effects])
        self.folder = self.addresses.folder

    @cached_property
    def base(self) -> dict[str, float]:
        """Twin's variable → value of the scenario; with it the variables of effects that the scenario has no unit for."""
        vectors, why = twin_parameters(self.addresses)
        if vectors is None:
            raise ValueError(f"{self.scenario}: {why}; sealed cases need a scenario that the twin can fly")
        flat = {f"{name}[{i}]" if len(values) > 1 else name: v for name, values in vectors.items() for i, v in enumerate(values, 1)}
        for effect in self.effects.values():
            names = [name for c in self.coordinates(effect) for name, _ in c.slots if not name.startswith("clock.")]
            flat = {name: self._start(name) for name in names} | flat
        return flat

    def lander(self, settings: Mapping[str, float] | None = None) -> TwinLander:
        """The twin; settings: its `tolerance` and `longest_step`."""
        return TwinLander(self.folder / "LunarLander.fmu", self.folder / "RateSensor.fmu", {**self.base, **(settings or {})})

    def nuisances(self, known: Sequence[Known]) -> list[Coordinate]:
        """A coordinate for each number of what was known, then the clock's origin."""
        found = [c for one in known for c in self._known(one)]
        return [*found, Coordinate("origin", ((ORIGIN, 1.0),), CLOCKS_APART, unit="s")]

    def gap(self) -> list[Coordinate]:
        """The reality gap: what a vehicle has that its model has not, 2 per cent of each."""
        slots = {address: tuple((name, 1.0) for name in self.addresses.twin(address) or ()) for address in JITTERED}
        return [Coordinate(address, names, JITTER, operation="scale") for address, names in slots.items()]

    def tolerances(self) -> list[Coordinate]:
        """The part of the gap that a diagnosis looks for, too."""
        return [it for it in self.gap() if it.name in self.looked_for]

    @cached_property
    def looked_for(self) -> frozenset[str]:
        """Addresses that a diagnosis lets vary inside a band."""
        return frozenset(tomllib.loads(TOLERANCES.read_text("utf-8"))["tolerances"])

    def coordinates(self, effect: Effect) -> list[Coordinate]:
        """Those of an effect's parameters, with their priors."""
        found = []
        for it in effect.parameters:
            slots = tuple((name, sign) for sign, address in it.signed_targets() for name in self.addresses.twin(address) or [address])
            low, high = it.limits
            found.append(Coordinate(f"{effect.name}.{it.name}", slots, it.prior.sigma, it.null, it.operation, low, high,
                                    it.prior.shape == "half-normal", it.unit))  # fmt: skip
        return found

    def fixed(self, effect: Effect) -> dict[str, float]:
        """Twin's variable → value that goes with the effect."""
        return {name: float(np.ravel(value)[0]) for address, value in effect.fixed.items() for name in self.addresses.twin(address) or ()}

    def values(self, coordinates: Sequence[Coordinate], z: Array, effect: Effect | None = None) -> dict[str, float]:
        """Changed values at a point; those of an effect may stand among the coordinates."""
        base = {**self.base, **(self.fixed(effect) if effect else {})}
        return {**(self.fixed(effect) if effect else {}), **applied(base, coordinates, z, 0)}

    def address(self, variable: str) -> str:
        """The address of one number of the twin in the co-simulation."""
        soil = _SOIL.fullmatch(variable)
        if soil:
            elements = len(self.addresses.interface("soil", None, variable).vectors[soil["name"]])
            leg, element = divmod(int(soil["index"]) - 1, elements)
            return f"soil[{LEGS[leg]}].{soil['name']}" + (f"[{element + 1}]" if elements > 1 else "")
        if variable == "mass" or variable.startswith(_ELSEWHERE):
            return variable
        return ("body." if variable in self.addresses.interface("body", None, variable).variables else "gear.") + variable

    def _known(self, one: Known) -> list[Coordinate]:
        names = self.addresses.twin(one.name) or []
        width = len(names) // len(one.mean)
        found = []
        for i, mean in enumerate(one.mean):
            part = names[i * width : (i + 1) * width]
            slots, name = tuple((it, 1.0) for it in part), f"{one.name}[{i + 1}]" if len(one.mean) > 1 else one.name
            if one.of_log:
                found.append(Coordinate(name, slots, one.spread, log(mean / self.base[part[0]]), "scale", unit="1"))
            else:
                found.append(Coordinate(name, slots, one.spread, mean, "set", unit=one.unit))
        return found

    def _start(self, name: str) -> float:
        interface = self.addresses.library("RateSensor" if name.startswith("sensor.") else "LunarLander")
        if interface is None:
            raise ValueError(f"{self.folder}: holds no LunarLander and RateSensor; run build_fmus.py")
        return number_of(interface.variables[name.removeprefix("sensor.")].start)
