"""Which variables of which units an address means in a scenario, and in the twin."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from orchestrator.blueprint import Blueprint
from orchestrator.diagnosis.places import CLOCK, LEGS, ONE_FOR_EACH, PLACES, SHORT, TWIN, Address, parse, spelt_out
from orchestrator.diagnosis.starts import number_of
from orchestrator.errors import AddressError, nearest
from orchestrator.fmi.description import read_interface
from orchestrator.master.slave import Interface, Kind, Variable
from orchestrator.results.schema import ResultsTable
from orchestrator.results.schema import read as read_results_table
from orchestrator.scenario.locate import fmu_folder
from orchestrator.scenario.parameters import SETTABLE, settable_stems

Array = NDArray[np.float64]
_IN_TWIN = {"gear.vehicle_mass": "mass", "gear.gravity": "gravity", "soil.footpad_radius": "footpad_radius",
            "soil.footpad_height": "footpad_height"}  # fmt: skip


class Slot(NamedTuple):
    """One number of one unit of the co-simulation."""

    unit: str
    variable: str


class Addresses:
    """The addresses of one scenario. Every error is one line that names what there is instead."""

    def __init__(self, blueprint: Blueprint) -> None:
        self.blueprint = blueprint
        self.where = blueprint.scenario.where
        self.results: ResultsTable = read_results_table(blueprint.scenario.table.results, f"{self.where}: results")
        self.folder = fmu_folder(blueprint.scenario.table.fmus, blueprint.path)
        self._read: dict[str, Interface | None] = {}

    @cached_property
    def legs(self) -> tuple[str, ...]:
        """Names in [results.legs], those of the twin in its order first."""
        named = self.results.legs
        return (*(leg for leg in LEGS if leg in named), *(leg for leg in named if leg not in LEGS))

    @cached_property
    def is_twin(self) -> bool:
        """Whether the scenario's vehicle is the twin itself."""
        body = self.blueprint.interfaces.get(self.results.body)
        return body is not None and body.model_name == TWIN

    def units(self, place: str, leg: str | None = None) -> list[str]:
        """The units of the scenario that stand at a place; none where the scenario has no such unit."""
        interfaces = self.blueprint.interfaces
        if place in ("soil", "gear"):
            if leg is not None and leg not in self.results.legs:
                raise AddressError(f'{self.where}: {place}[{leg}]: no leg "{leg}" in [results.legs]; {nearest(leg, self.results.legs)}')
            chosen = [self.results.legs[it] for it in (self.legs if leg is None else (leg,))]
            return [unit for it in chosen if (unit := it.soil if place == "soil" else it.leg) in interfaces]
        if place == "body":
            return [self.results.body] if self.results.body in interfaces else []
        return [name for name, it in interfaces.items() if it.model_name == PLACES.get(place)]

    def has(self, place: str) -> bool:
        """Whether the scenario has a unit at this place, or a twin that holds it."""
        return place == CLOCK or bool(self.units(place)) or (self.is_twin and place != "sensor" and self._twin_holds(place))

    def resolve(self, address: str) -> list[Slot]:
        """The numbers an address means: leg by leg, for each leg its elements in order. A place that the scenario does not have is
        resolved as if its unit were added under the place's name. `clock` is no unit's: nothing.
        """
        return [slot for part in spelt_out(address) for slot in self._slots(parse(part), part)]

    def groups(self, address: str) -> list[list[Slot]]:
        """The same by component: the slots of each group get the same number. As many groups as `base_value` has numbers."""
        parts = [self._by_component(parse(part), part) for part in spelt_out(address)]
        if address in ONE_FOR_EACH:
            return [group for part in parts for group in part]
        return [[slot for part in parts for slot in part[i]] for i in range(len(parts[0]))] if parts else []

    def base_value(self, address: str) -> Array:
        """One number a component, in the base scenario: what it sets, or the unit's own start value. Where the legs of one address
        differ, one number a slot, in the order of `resolve`.
        """
        groups = self.groups(address)
        if not groups:
            return np.zeros(1)
        values = [[self.number(slot) for slot in group] for group in groups]
        if all(len(set(group)) == 1 for group in values):
            return np.array([group[0] for group in values])
        return np.array([self.number(slot) for slot in self.resolve(address)])

    def unit_of_measure(self, address: str) -> str:
        """As the unit that holds it declares."""
        part = spelt_out(address)[0]
        place = parse(part)
        return "s" if place.place == CLOCK else self._elements(place, part)[0].unit

    def twin(self, address: str) -> list[str] | None:
        """The twin's variables in the order of `groups`, legs within; a RateSensor's as "sensor.NAME": it runs behind the twin. None
        where the twin has no such variable; nothing for `clock`.
        """
        names: list[str] = []
        for part in spelt_out(address):
            found = self._in_twin(parse(part))
            if found is None:
                return None
            names += [name for name in found if name not in names]
        return names

    def _slots(self, address: Address, text: str) -> list[Slot]:
        if address.place == CLOCK:
            self._check_clock(address, text)
            return []
        if self.is_twin and address.place != "sensor":
            variables = self._in_twin(address)
            if variables is None:
                raise AddressError(f"{self.where}: {text}: the twin has no such parameter; {self._near(address)}")
            return [Slot(self.results.body, name) for name in variables]
        names = [variable.name for variable in self._elements(address, text)]
        return [Slot(unit, name) for unit in self.units(address.place, address.leg) or [address.place] for name in names]

    def _by_component(self, address: Address, text: str) -> list[list[Slot]]:
        slots = self._slots(address, text)
        if address.place == CLOCK:
            return []
        width = len(self._elements(address, text))
        return [slots[i::width] for i in range(width)]

    def _check_clock(self, address: Address, text: str) -> None:
        if address.element is not None:
            raise AddressError(f"{text}: a clock's offset is one number; write clock.{address.name}")

    def _elements(self, address: Address, text: str) -> list[Variable]:
        """The variables an address means in the unit of its place."""
        interface = self.interface(address.place, address.leg, text)
        found = interface.vectors.get(address.name, [])
        if address.element is not None:
            found = [it for it in found if it.name == address.variable]
        if not found or found[0].causality not in SETTABLE:
            raise AddressError(f'{self.where}: {text}: {interface.model_name} has no parameter "{address.variable}"; {self._near(address)}')
        return found

    def _near(self, address: Address) -> str:
        interface = self.interface(address.place, None, address.name)
        stems = [it for it in settable_stems(interface) if interface.vectors[it][0].causality == "parameter"]
        lengths = {stem: len(interface.vectors[stem]) for stem in stems}
        if address.element is not None and lengths.get(address.name):
            return f"{address.name} has {lengths[address.name]} elements"
        return nearest(address.name, stems)

    def interface(self, place: str, leg: str | None, text: str) -> Interface:
        """Of the unit at a place: the scenario's, or that of the FMU which would be added."""
        there = self.units(place, leg)
        if there:
            return self.blueprint.interfaces[there[0]]
        found = self.library(PLACES[place])
        if found is None:
            raise AddressError(f"{self.where}: {text}: the scenario has no {PLACES[place]}, and {self.folder} has none; build the FMUs")
        return found

    def library(self, model: str) -> Interface | None:
        """An FMU of the scenario's folder, by its model's name."""
        if model not in self._read:
            path = self.folder / f"{model}.fmu"
            self._read[model] = read_interface(path) if path.is_file() else None
        return self._read[model]

    @property
    def twin_interface(self) -> Interface | None:
        return self.blueprint.interfaces[self.results.body] if self.is_twin else self.library(TWIN)

    def _twin_holds(self, place: str) -> bool:
        twin = self.twin_interface
        return twin is not None and (place in ("body", "gear") or any(name.startswith(f"{place}.") for name in twin.vectors))

    def _in_twin(self, address: Address) -> list[str] | None:
        twin = self.twin_interface
        if address.place == CLOCK:
            return []
        if address.place == "sensor":
            return [f"sensor.{it.name}" for it in self._elements(address, f"sensor.{address.name}")]
        if twin is None:
            return None
        name = _IN_TWIN.get(f"{address.place}.{address.name}")
        if name is not None or address.place in ("body", "gear"):
            return None if address.leg else _settable(twin, name or address.name, address.element)
        if address.place == "soil":
            return self._soil_in_twin(twin, address)
        return _settable(twin, f"{address.place}.{address.name}", address.element)

    def _soil_in_twin(self, twin: Interface, address: Address) -> list[str] | None:
        """`soil.NAME[1..4]`; of a vector the elements of leg 1 stand first, then those of leg 2."""
        every = _settable(twin, f"soil.{address.name}", None)
        if every is None or (address.leg is not None and address.leg not in LEGS):
            return None
        width = len(every) // len(LEGS)
        legs = range(len(LEGS)) if address.leg is None else [LEGS.index(address.leg)]
        elements = range(width) if address.element is None else [address.element - 1]
        if address.element is not None and not 1 <= address.element <= width:
            return None
        return [every[leg * width + i] for leg in legs for i in elements]

    def number(self, slot: Slot) -> float:
        """What a slot has in the base scenario."""
        names = list(self.blueprint.interfaces)
        if slot.unit in names:
            given = self.blueprint.values[names.index(slot.unit)].get(slot.variable)
            return number_of(given) if given is not None else self.start(slot.unit, slot.variable)
        interface = self.library(PLACES[slot.unit])
        return number_of(interface.variables[slot.variable].start if interface else None)

    def start(self, unit: str, variable: str) -> float:
        """The unit's own start value of a variable."""
        return number_of(self.blueprint.interfaces[unit].variables[variable].start)


def known_addresses(addresses: Addresses) -> list[str]:
    """Every address of a parameter that is a number, without legs and elements: what a message may offer."""
    return [
        f"{place}.{stem}"
        for place in PLACES
        if addresses.units(place) or addresses.library(PLACES[place])
        for stem in settable_stems(addresses.interface(place, None, place))
        if addresses.interface(place, None, place).vectors[stem][0].kind in (Kind.REAL, Kind.INTEGER)
    ] + list(SHORT)


def _settable(interface: Interface, name: str, element: int | None) -> list[str] | None:
    found: Sequence[Variable] = interface.vectors.get(name, ())
    chosen = [it.name for it in found if it.causality in SETTABLE and (element is None or it.name == f"{name}[{element}]")]
    return chosen or None
