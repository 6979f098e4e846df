"""The scenario of separate units flown through the master for given values: what a diagnosis reports is computed here."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from orchestrator.blueprint import Blueprint, draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.effects.effect import Insert
from orchestrator.diagnosis.landing import RATES, SPIN, TELEMETRY, Course
from orchestrator.diagnosis.observation import of_units
from orchestrator.diagnosis.overlay import overlay, slot_of_unit
from orchestrator.diagnosis.recorded import contact_columns, cosimulation_column
from orchestrator.errors import OrchestratorError, UnitError
from orchestrator.loaded_units import LoadedUnits
from orchestrator.master.result import RunResult
from orchestrator.master.slave import Kind, Value
from orchestrator.scenario.parameters import checked
from orchestrator.scenario.read import Tree, merge

PEAK = "peak."


@dataclass(frozen=True)
class Flight:
    """A landing through the master. `course` is None where it could not be flown to the end; `reason` says why, or why not to trust it."""

    course: Course | None
    reason: str = ""
    result: RunResult | None = None


class CoSimulation:
    """One scenario, flown as often as asked with other values and other units added."""

    def __init__(self, scenario: Path, overrides: Sequence[str] = ()) -> None:
        self.path, self.overrides = scenario, tuple(overrides)
        self.addresses = Addresses(draw_up(read_scenario(scenario, self.overrides), scenario))
        self.units = LoadedUnits()
        self.flown = 0

    def fly(
        self,
        values: Mapping[str, ArrayLike],
        inserts: Sequence[Insert] = (),
        stop: float | None = None,
        columns: Sequence[str] = (),
        final: Sequence[str] = (),
        settings: Tree | None = None,
    ) -> Flight:
        """values: by address, or "unit.variable"; `clock.` and `time.` are passed over.

        stop      s since first contact; without it, or where the scenario does not solve its start, its own end stands
        columns   as the search has them, or "unit.variable"; `final` likewise, "peak." before it for the largest magnitude
        settings  merged over the scenario, e.g. {"master": {...}}
        """
        self.flown += 1
        try:
            result, addresses = self._flown(values, inserts, stop, (*columns, *final), settings or {})
            if not result.complete:
                return Flight(None, result.message, result)
            return Flight(course_of(addresses, result, columns, final), result.message, result)
        except OrchestratorError as error:
            return Flight(None, str(error))

    def blueprint(
        self, values: Mapping[str, ArrayLike], inserts: Sequence[Insert] = (), stop: float | None = None, settings: Tree | None = None
    ) -> Blueprint:
        """The scenario with these values, checked again."""
        own = of_units(values)
        slots = {name: float(np.asarray(value).ravel()[0]) for name, value in own.items() if slot_of_unit(self.addresses, name) is not None}
        by_address = {name: value for name, value in own.items() if name not in slots}
        tree = merge(overlay(self.addresses, by_address, inserts), settings or {})
        table = self.addresses.blueprint.scenario.table
        if stop is not None and table.start is not None:
            tree = merge(tree, {"stop_time": table.start_time + stop})
        return with_values(draw_up(read_scenario(self.path, self.overrides, tree), self.path), slots)

    def close(self) -> None:
        self.units.close()

    def _flown(
        self, values: Mapping[str, ArrayLike], inserts: Sequence[Insert], stop: float | None, names: Sequence[str], settings: Tree
    ) -> tuple[RunResult, Addresses]:
        blueprint = self.blueprint(values, inserts, stop, settings)
        addresses = Addresses(blueprint)
        also_record(blueprint, needed_columns(addresses, names))
        return self.units.run(blueprint), addresses


def with_values(drawn: Blueprint, values: Mapping[str, float]) -> Blueprint:
    """A copy with other start values ("unit.variable"), each checked against its variable's bounds."""
    blueprint = copy.copy(drawn)
    blueprint.values = [dict(given) for given in drawn.values]
    places = {name: place for place, name in enumerate(drawn.interfaces)}
    for name, number in values.items():
        unit, _, variable = name.partition(".")
        declared = drawn.interfaces[unit].variables.get(variable)
        if declared is None:
            raise UnitError(f"{drawn.scenario.where}: unit {unit} has no {variable}")
        value: Value = number if declared.kind is Kind.REAL else round(number) if declared.kind is Kind.INTEGER else bool(number)
        blueprint.values[places[unit]][variable] = checked(unit, declared, value)
    return blueprint


def needed_columns(addresses: Addresses, names: Sequence[str]) -> list[str]:
    """What must be recorded for a course with these columns and final values."""
    wanted = [*RATES, *SPIN, *TELEMETRY, *(name.removeprefix(PEAK) for name in names)]
    dated = [] if begins_at_contact(addresses) else contact_columns(addresses).values()
    return list(dict.fromkeys(cosimulation_column(addresses, name) for name in (*wanted, *dated)))


def also_record(blueprint: Blueprint, columns: Sequence[str]) -> None:
    """Add "unit.variable"s to what a run keeps."""
    places = {name: place for place, name in enumerate(blueprint.interfaces)}
    blueprint.recorded = [list(names) for names in blueprint.recorded] or [[] for _ in places]
    for column in columns:
        unit, _, variable = column.partition(".")
        kept = blueprint.recorded[places[unit]]
        if variable not in kept:
            kept.append(variable)


def course_of(addresses: Addresses, result: RunResult, columns: Sequence[str], final: Sequence[str]) -> Course:
    """A run as the search's landings look: by the search's names, over s since first contact."""
    wanted = dict.fromkeys([*RATES, *SPIN, *TELEMETRY, *columns])
    rows = {name: result.columns[cosimulation_column(addresses, name)] for name in wanted}
    contact = first_contact(addresses, result)
    return Course(result.times - contact, rows, {name: _final(addresses, result, name, contact) for name in final})


def begins_at_contact(addresses: Addresses) -> bool:
    """Whether the start condition puts the lowest pad at the ground."""
    start = addresses.blueprint.scenario.table.start
    return start is not None and start.value == 0.0


def first_contact(addresses: Addresses, result: RunResult) -> float:
    """s. A scenario that solves its start for contact begins there; else the soils tell."""
    if begins_at_contact(addresses):
        return result.start_time
    columns = [cosimulation_column(addresses, name) for name in contact_columns(addresses).values()]
    times = [result.columns.get(column, np.array([-1.0]))[-1] for column in columns]
    return float(min((time for time in times if time >= 0.0), default=result.start_time))


def _final(addresses: Addresses, result: RunResult, name: str, contact: float) -> float:
    """The last value; of a peak the one of largest magnitude, with its sign; an instant counts from first contact, -1 means never."""
    column = result.columns[cosimulation_column(addresses, name.removeprefix(PEAK))]
    value = float(column[np.abs(column).argmax()] if name.startswith(PEAK) else column[-1])
    return value - contact if name.endswith(".contact_time") and value >= 0.0 else value
