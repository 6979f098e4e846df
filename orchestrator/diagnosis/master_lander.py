"""Landings for the search through the master: for scenarios in which the twin cannot stand in.

Values are those of the units, "unit.variable[i]". The master is held as the scenario holds it: ten times its tolerance would save a
tenth of the time and move the rates by 0.3 to 0.5 sigma (1.7 mrad/s), more than a fit can bear.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from orchestrator.blueprint import Blueprint, draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses, Slot
from orchestrator.diagnosis.effects.effect import Insert
from orchestrator.diagnosis.flight import course_of, needed_columns, with_values
from orchestrator.diagnosis.landing import Course
from orchestrator.diagnosis.overlay import overlay
from orchestrator.errors import OrchestratorError, UnitError
from orchestrator.loaded_units import LoadedUnits
from orchestrator.master.slave import Kind
from orchestrator.scenario.read import Tree, merge
from orchestrator.scenario.record import matching_outputs

Array = NDArray[np.float64]


class MasterLander:
    """A `Lander` that flies the scenario's own units. Added units come in as soon as a value is given to one of them."""

    def __init__(
        self, scenario: Path, inserts: Sequence[Insert] = (), overrides: Sequence[str] = (), settings: Mapping[str, float] | None = None
    ) -> None:
        """settings: of the master, instead of the scenario's."""
        self.settings = dict(settings or {})
        self.scenario, self.overrides = scenario, tuple(overrides)
        self.inserts = {insert.unit: insert for insert in inserts}
        self.drawn: dict[tuple[str, ...], tuple[Blueprint, Addresses]] = {}
        self.units = LoadedUnits()
        self.base = self._drawn(())

    varies = False

    def land(
        self,
        values: Mapping[str, float],
        grid: Array,
        columns: Sequence[str],
        final: Sequence[str],
        beside: Mapping[str, float] | None = None,
    ) -> Course | None:
        """The landing at the master's own instants up to the grid's end; None where it cannot be flown."""
        try:
            return self._landed(values, float(grid[-1]), columns, final)
        except OrchestratorError:
            return None

    def close(self) -> None:
        self.units.close()

    def _landed(self, values: Mapping[str, float], stop: float, columns: Sequence[str], final: Sequence[str]) -> Course | None:
        there = self.base[0].interfaces
        asked = dict.fromkeys(name.partition(".")[0] for name in values)
        drawn, addresses = self._drawn(tuple(unit for unit in asked if unit not in there))
        blueprint = with_values(drawn, values)
        self._until(blueprint, stop)
        wanted = [f for f in needed_columns(addresses, [*columns, *final]) + _contact_times(addresses) if f]
        blueprint.recorded = matching_outputs(list(dict.fromkeys(wanted)), blueprint.interfaces, "diagnosis")
        result = self.units.run(blueprint)
        return course_of(addresses, result, columns, final) if result.complete else None

    def _until(self, blueprint: Blueprint, stop: float) -> None:
        """Stop times count from first contact, which is the run's start where the start is solved; else the scenario's own end stands."""
        table = blueprint.scenario.table
        if table.start is not None:
            changed = table.model_copy(update={"stop_time": table.start_time + stop})
            blueprint.scenario = replace(blueprint.scenario, table=changed)

    def _drawn(self, added: tuple[str, ...]) -> tuple[Blueprint, Addresses]:
        if added not in self.drawn:
            unknown = [unit for unit in added if unit not in self.inserts]
            if unknown:
                raise UnitError(f'{self.scenario.name}: no unit "{unknown[0]}", and no effect adds one')
            tree: Tree = {"master": self.settings, "record": {"interval": 0.0}}
            if added:
                tree = merge(tree, overlay(self.base[1], {}, [self.inserts[unit] for unit in added]))
            blueprint = draw_up(read_scenario(self.scenario, self.overrides, tree), self.scenario)
            self.drawn[added] = (blueprint, Addresses(blueprint))
        return self.drawn[added]


@dataclass(frozen=True)
class MasterLanderMaker:
    """Makes them in a worker's process."""

    scenario: Path
    inserts: tuple[Insert, ...] = ()
    overrides: tuple[str, ...] = ()

    def __call__(self) -> MasterLander:
        return MasterLander(self.scenario, self.inserts, self.overrides)


def unit_base(addresses: Addresses, inserts: Sequence[Insert] = ()) -> dict[str, float]:
    """Every numerical parameter of every unit, as `MasterLander.land` takes it: what a search starts from. Of units to be added, too."""
    interfaces = dict(addresses.blueprint.interfaces)
    for insert in inserts:
        added = None if insert.unit in interfaces else addresses.library(insert.fmu)
        if added is not None:
            interfaces[insert.unit] = added
    parameters = [Slot(unit, it.name) for unit, i in interfaces.items() for it in i.of("parameter") if it.kind is not Kind.STRING]
    return {f"{slot.unit}.{slot.variable}": addresses.number(slot) for slot in parameters}


def unit_slots(addresses: Addresses, address: str) -> list[list[str]]:
    """The units' variables of each component of an address: all in a group get the same number."""
    return [[f"{slot.unit}.{slot.variable}" for slot in group] for group in addresses.groups(address)]


def _contact_times(addresses: Addresses) -> list[str]:
    """Only where first contact is not the start."""
    blueprint = addresses.blueprint
    if blueprint.scenario.table.start is not None:
        return []
    units = ((legs.soil.partition(".")[0], f"{legs.soil}.contact_time") for legs in addresses.results.legs.values())
    return [name for unit, name in units if name.partition(".")[2] in blueprint.interfaces[unit].variables]
