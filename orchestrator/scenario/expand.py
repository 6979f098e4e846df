"""`[each]`: one line for four legs. Also `--set unit.parameter=value`."""

from __future__ import annotations

import fnmatch
import itertools
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from orchestrator.errors import ScenarioError, nearest
from orchestrator.scenario.conversion import AS_IT_IS, Alteration
from orchestrator.scenario.model import ConnectionTable, ScenarioTable, UnitTable

_PLACEHOLDER = re.compile(r"\{(\w+)(#?)\}")
_UNIT_NAME = re.compile(r"[A-Za-z0-9_+\-]+")
Each = Mapping[str, Sequence[str]]


@dataclass(frozen=True)
class UnitEntry:
    """One instance."""

    name: str
    fmu: str
    once: bool
    parameters: dict[str, Any]
    isolate: bool = False

    def as_run(self) -> dict[str, Any]:
        table = {"fmu": self.fmu, "once": self.once, "parameters": self.parameters}
        return table | ({"isolate": True} if self.isolate else {})


@dataclass(frozen=True)
class Connection:
    """Two ports, or a variable to a variable; `both_ways` tells which."""

    first: str
    second: str
    both_ways: bool
    slope: bool
    scheme: str | None = None
    alteration: Alteration = AS_IT_IS

    def as_run(self) -> dict[str, Any]:
        ends: dict[str, Any] = {"ports": [self.first, self.second]} if self.both_ways else {"from": self.first, "to": self.second}
        return ends | {"slope": self.slope} | ({"scheme": self.scheme} if self.scheme else {}) | self.alteration.as_run()


@dataclass(frozen=True)
class Scenario:
    """Everything said out in full."""

    where: str
    table: ScenarioTable
    units: list[UnitEntry]
    """In the order in which they are stepped."""
    connections: list[Connection]
    zero: list[str]
    record: list[str]

    def as_run(self) -> dict[str, Any]:
        """A scenario file's content that repeats this run without `extends`, `each` or `--set`."""
        tree = self.table.model_dump(by_alias=True, exclude_none=True, exclude={"each", "units", "connections"})
        tree["units"] = {u.name: u.as_run() for u in self.units}
        tree["connections"] = [c.as_run() for c in self.connections]
        tree["master"]["order"] = [u.name for u in self.units]
        tree["record"]["variables"] = self.record
        if self.zero:
            tree["start"]["zero"] = self.zero
        return tree


def expand(table: ScenarioTable, where: str, overrides: Sequence[str] = ()) -> Scenario:
    """All instances, in order, with overrides applied."""
    each = table.each
    covered = {name for template in table.units for name, chosen in instances(table, template, where) if chosen}
    units = [entry for template in table.units if template not in covered for entry in _unit_entries(table, template, where)]
    names = [unit.name for unit in units]
    for name in names:
        if not _UNIT_NAME.fullmatch(name):
            raise ScenarioError(f'{where}: units."{name}": a unit\'s name may hold letters, digits, + - and _; rename it')
        if names.count(name) > 1:
            raise ScenarioError(f"{where}: units.{name}: named twice after expansion; rename one")
    for override in overrides:
        _override(units, override)
    connections = [c for entry in table.connections for c in _connections(entry, each, where)]
    asked = table.start.zero if table.start else []
    zero = _all_filled([asked] if isinstance(asked, str) else asked, each, where)
    record = _all_filled(table.record.variables, each, where)
    order = _all_filled(table.master.order, each, where)
    return Scenario(where, table, _in_order(units, order, where), connections, zero, record)


def _unit_entries(table: ScenarioTable, template: str, where: str) -> list[UnitEntry]:
    """A table named like an instance of another takes that one's place, and with the same FMU its parameters."""
    unit = table.units[template]
    entries = []
    for name, chosen in instances(table, template, where):
        values = _values(unit, name, chosen, table.each, where)
        own = table.units.get(name, unit) if chosen else unit
        if own is not unit:
            values = (values if own.fmu == unit.fmu else {}) | _values(own, name, {}, table.each, where)
        entries.append(UnitEntry(name, own.fmu, own.once, values, own.isolate))
    return entries


def _values(unit: UnitTable, name: str, chosen: Mapping[str, tuple[str, int]], each: Each, where: str) -> dict[str, Any]:
    """Parameters of one instance."""
    return {
        key: _for_instance(value, chosen, each, f"{where}: {name}.{key}") if isinstance(value, dict) else value
        for key, value in unit.parameters.items()
    }


def instances(table: ScenarioTable, template: str, where: str) -> list[tuple[str, dict[str, tuple[str, int]]]]:
    """The names a unit's template expands to, each with its instance and number for every key of [each] the template uses."""
    return [(_fill(template, chosen), chosen) for chosen in _choices((template,), table.each, where)]


def _for_instance(value: dict[str, Any], chosen: Mapping[str, tuple[str, int]], each: Each, where: str) -> Any:
    """The entry of a per-instance table."""
    if not chosen:
        raise ScenarioError(f"{where}: is a table of values by instance, but the unit is not expanded by [each]; give one value")
    instance = ""
    for key, (instance, _) in chosen.items():
        if set(value) <= set(each[key]) and instance in value:
            return value[instance]
    stray = [k for k in value if not any(k in each[key] for key in chosen)]
    if stray:
        known = [v for key in chosen for v in each[key]]
        raise ScenarioError(f'{where}: "{stray[0]}" is no instance; {nearest(stray[0], known)}')
    raise ScenarioError(f'{where}: has no value for instance "{instance}"; add it to the table')


def _connections(entry: ConnectionTable, each: Each, where: str) -> list[Connection]:
    first, second = entry.ports if entry.ports is not None else (entry.source or "", entry.target or "")
    altered = Alteration.of(entry.frame, entry.scale, entry.offset)
    ends = _instances((first, second), each, where)
    return [Connection(a, b, entry.ports is not None, entry.slope, entry.scheme, altered) for a, b in ends]


def _instances(templates: tuple[str, ...], each: Each, where: str) -> list[tuple[str, ...]]:
    """The templates filled together, once for every combination of the placeholders they use."""
    return [tuple(_fill(t, chosen) for t in templates) for chosen in _choices(templates, each, where)]


def _all_filled(templates: Sequence[str], each: Each, where: str) -> list[str]:
    return [text for template in templates for (text,) in _instances((template,), each, where)]


def _choices(templates: tuple[str, ...], each: Each, where: str) -> list[dict[str, tuple[str, int]]]:
    keys = dict.fromkeys(match[1] for template in templates for match in _PLACEHOLDER.finditer(template))
    for key in keys:
        if key not in each:
            raise ScenarioError(f'{where}: {templates[0]}: "{{{key}}}" is not in [each]; {nearest(key, each)}')
    numbered = [[(value, number + 1) for number, value in enumerate(each[key])] for key in keys]
    return [dict(zip(keys, combination, strict=True)) for combination in itertools.product(*numbered)]


def _fill(template: str, chosen: Mapping[str, tuple[str, int]]) -> str:
    return _PLACEHOLDER.sub(lambda m: str(chosen[m[1]][1]) if m[2] else chosen[m[1]][0], template)


def _override(units: list[UnitEntry], text: str) -> None:
    """`unit.parameter=value`; the unit may be a glob, the value is TOML, or a string when it is not."""
    path, equals, value = text.partition("=")
    pattern, dot, parameter = path.strip().partition(".")
    if not (equals and dot and parameter):
        raise ScenarioError(f"--set {text}: expects unit.parameter=value, e.g. --set body.mass=7000")
    chosen = [unit for unit in units if fnmatch.fnmatchcase(unit.name, pattern)]
    if not chosen:
        raise ScenarioError(f'--set {text}: no unit "{pattern}"; {nearest(pattern, [u.name for u in units])}')
    for unit in chosen:
        unit.parameters.pop(parameter, None)  # to the end: a vector or element of it that was set before must not come after
        unit.parameters[parameter] = toml_value(value)


def toml_value(text: str) -> Any:
    """What a person wrote behind `=`: TOML, or a string when it is not."""
    try:
        return tomllib.loads(f"v = {text.strip()}")["v"]
    except tomllib.TOMLDecodeError:
        return text.strip()


def _in_order(units: list[UnitEntry], order: list[str], where: str) -> list[UnitEntry]:
    """Units named in `master.order` first, then the others as the scenario lists them."""
    names = [unit.name for unit in units]
    for name in order:
        if name not in names:
            raise ScenarioError(f'{where}: master.order: no unit "{name}"; {nearest(name, names)}')
        if order.count(name) > 1:
            raise ScenarioError(f'{where}: master.order: "{name}" stands there twice; remove one')
    ranked = [*order, *(name for name in names if name not in order)]
    return sorted(units, key=lambda unit: ranked.index(unit.name))
