"""Changed parameters and added units -> an overlay that runs with `orchestrator run`."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
import tomli_w
from numpy.typing import ArrayLike

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses, Slot
from orchestrator.diagnosis.effects.effect import Insert
from orchestrator.diagnosis.places import PLACES
from orchestrator.diagnosis.starts import number_of
from orchestrator.errors import AddressError
from orchestrator.master.slave import Kind, Value, stem
from orchestrator.scenario.expand import instances
from orchestrator.scenario.read import Tree, merge

NO_SLOTS: Mapping[Slot, float] = MappingProxyType({})
Instance = tuple[str, str] | None
"""Which key of [each] a unit is expanded by, and which instance it is."""


@dataclass(frozen=True)
class Change:
    """A parameter's new value: a number, or one a component."""

    address: str
    value: ArrayLike
    sigma: ArrayLike | None = None
    unit: str = ""
    why: str = ""


def slot_of_unit(addresses: Addresses, name: str) -> Slot | None:
    """Of a "unit.variable", as a search through the master has them; None for an address, as of a unit that is called as its place."""
    unit, _, variable = name.partition(".")
    return Slot(unit, variable) if unit in addresses.blueprint.interfaces and unit not in PLACES else None


def overridden(addresses: Addresses) -> dict[Slot, float]:
    """The numbers that the command line has changed in the scenario's file."""
    path = addresses.blueprint.path
    if path is None:
        return {}
    plain = draw_up(read_scenario(path), path)
    pairs = zip(addresses.blueprint.interfaces, addresses.blueprint.values, plain.values, strict=True)
    return {
        Slot(unit, name): number_of(value)
        for unit, now, before in pairs
        for name, value in now.items()
        if value != before.get(name) and not isinstance(value, str)
    }


def overlay(
    addresses: Addresses, values: Mapping[str, ArrayLike], inserts: Sequence[Insert] = (), besides: Mapping[Slot, float] = NO_SLOTS
) -> Tree:
    """What to merge over the base scenario (`extends`, or `read_scenario`'s changes). `clock` is no unit's and is passed over.

    besides: numbers to be set where no value says otherwise
    """
    numbers = dict(besides)
    for address, value in values.items():
        numbers |= _numbers(addresses, address, value)
    added = [insert for insert in inserts if not _is_there(addresses, insert)]
    units: dict[str, Tree] = {insert.unit: {"fmu": insert.fmu, "parameters": dict(insert.parameters)} for insert in added}
    for (unit, name), elements in _by_vector(numbers).items():
        if unit in addresses.blueprint.interfaces:
            template, instance = _template(addresses, unit)
            parameters = units.setdefault(template, {"parameters": {}})["parameters"]
            _put(addresses, parameters, template, instance, Slot(unit, name), elements)
        elif unit in units:
            units[unit]["parameters"][name] = _full(addresses, unit, name, elements)
        else:
            raise AddressError(f"{addresses.where}: {unit}.{name}: the scenario has no unit {unit}; insert a {PLACES.get(unit, unit)}")
    tree: Tree = {"units": units} if units else {}
    connections = _connections(addresses, added)
    return tree | ({"connections": connections} if connections else {})


def write_overlay(
    path: Path,
    addresses: Addresses,
    changes: Sequence[Change],
    inserts: Sequence[Insert] = (),
    title: str = "",
    remarks: Iterable[str] = (),
    tables: Tree | None = None,
    besides: Mapping[Slot, float] = NO_SLOTS,
) -> Path:
    """The overlay as a TOML file beside any folder: `extends` the base scenario, and says of every change what, how sure and why.

    tables: what else it sets, by table: `results`, `master`;  besides: numbers without a word of their own
    """
    base = addresses.blueprint.path
    if base is None:
        raise AddressError(f"{addresses.where}: has no file that an overlay could extend; save the scenario first")
    tree = overlay(addresses, {change.address: change.value for change in changes}, inserts, besides)
    folder = path.parent.resolve()
    head: Tree = {"title": title or f"{addresses.blueprint.scenario.table.title}, revised", "extends": _relative(base, folder)}
    head["fmus"] = _relative(addresses.folder, folder)
    references = addresses.results.references
    if references and (base.parent / references).is_file():
        tree["results"] = {"references": _relative(base.parent / references, folder)}
    tree = merge(tree, tables or {})
    lines = [f"# {_one_line(remark)}" for remark in remarks] + [_remark(change) for change in changes]
    text = tomli_w.dumps(head) + "\n" + "\n".join(lines) + "\n\n" + tomli_w.dumps(tree)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def _remark(change: Change) -> str:
    value = ", ".join(f"{it:.6g}" for it in np.atleast_1d(np.asarray(change.value, dtype=np.float64)))
    sigma = "" if change.sigma is None else " ± " + ", ".join(f"{it:.3g}" for it in np.atleast_1d(np.asarray(change.sigma)))
    return _one_line(f"# {change.address} = {value}{sigma} {change.unit}".rstrip() + (f": {change.why}" if change.why else ""))


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _relative(path: Path, folder: Path) -> str:
    try:
        return Path(os.path.relpath(path.resolve(), folder)).as_posix()
    except ValueError:  # another drive
        return path.resolve().as_posix()


def _numbers(addresses: Addresses, address: str, value: ArrayLike) -> dict[Slot, float]:
    """A number for each slot: from one for all, one a component, or one a slot."""
    given = np.atleast_1d(np.asarray(value, dtype=np.float64)).ravel()
    own = slot_of_unit(addresses, address)
    if own is not None:
        return {own: float(given[0])}
    groups, slots = addresses.groups(address), addresses.resolve(address)
    if len(given) == 1 and len(groups) <= 1:
        return dict.fromkeys(slots, float(given[0]))
    if len(given) == len(groups):
        return {slot: float(number) for group, number in zip(groups, given, strict=True) for slot in group}
    if len(given) == len(slots):
        return dict(zip(slots, given.tolist(), strict=True))
    raise AddressError(f"{addresses.where}: {address}: is given {len(given)} numbers, expects {len(groups)}; give one a component")


def _by_vector(numbers: Mapping[Slot, float]) -> dict[tuple[str, str], dict[str, float]]:
    """(unit, vector) -> its changed elements by their names."""
    grouped: dict[tuple[str, str], dict[str, float]] = {}
    for slot, number in numbers.items():
        grouped.setdefault((slot.unit, stem(slot.variable)), {})[slot.variable] = number
    return grouped


def _full(addresses: Addresses, unit: str, name: str, elements: Mapping[str, float]) -> Value | list[Value]:
    """The whole vector, its unchanged elements as they are in the base scenario."""
    interface = addresses.blueprint.interfaces.get(unit) or addresses.interface(unit, None, unit)
    variables = interface.vectors[name]
    values: list[Value] = []
    for variable in variables:
        number = elements[variable.name] if variable.name in elements else addresses.number(Slot(unit, variable.name))
        values.append({Kind.INTEGER: round(number), Kind.BOOLEAN: bool(number)}.get(variable.kind, number))
    return values[0] if len(values) == 1 else values


def _template(addresses: Addresses, unit: str) -> tuple[str, Instance]:
    """The key of the scenario's [units] that gives this unit, and the instance of [each] it is, with that key."""
    table = addresses.blueprint.scenario.table
    for template in table.units:
        for name, chosen in instances(table, template, addresses.where):
            if name == unit:
                each = next(iter(chosen), None)
                return template, None if each is None else (each, chosen[each][0])
    raise AddressError(f"{addresses.where}: {unit}: is not in [units]; this is a fault of the scenario's expansion")


def _put(addresses: Addresses, parameters: Tree, template: str, instance: Instance, slot: Slot, elements: Tree) -> None:
    """Set a vector; in a template as a table by instance, where the other instances keep what they have."""
    value = _full(addresses, slot.unit, slot.variable, elements)
    if instance is None:
        parameters[slot.variable] = value
    else:
        table = parameters.setdefault(slot.variable, _as_they_are(addresses, template, slot.variable))
        table[instance[1]] = value
    given = addresses.blueprint.scenario.table.units[template].parameters
    for key in given:
        if stem(key) == slot.variable != key:  # the base sets single elements: they would be set after the vector
            _put_element(addresses, parameters, template, instance, Slot(slot.unit, key), elements)


def _put_element(addresses: Addresses, parameters: Tree, template: str, instance: Instance, slot: Slot, elements: Tree) -> None:
    value = elements.get(slot.variable, addresses.number(slot))
    if instance is None:
        parameters[slot.variable] = value
    else:
        parameters.setdefault(slot.variable, _as_they_are(addresses, template, slot.variable))[instance[1]] = value


def _as_they_are(addresses: Addresses, template: str, name: str) -> dict[str, Value | list[Value]]:
    """Instance -> the vector (or single element) it has in the base scenario."""
    table = addresses.blueprint.scenario.table
    found: dict[str, Value | list[Value]] = {}
    for unit, chosen in instances(table, template, addresses.where):
        value = addresses.number(Slot(unit, name)) if name != stem(name) else _full(addresses, unit, name, {})
        found[next(iter(chosen.values()))[0]] = value
    return found


def _is_there(addresses: Addresses, insert: Insert) -> bool:
    return insert.unit in addresses.blueprint.interfaces or (insert.unit in PLACES and addresses.has(insert.unit))


def _connections(addresses: Addresses, added: Sequence[Insert]) -> list[Tree]:
    """Places replaced by the scenario's units; a body's effect port that is taken by the next free one."""
    taken = {it.second for it in addresses.blueprint.scenario.connections} | {it.first for it in addresses.blueprint.scenario.connections}
    made: list[Tree] = []
    for insert in added:
        for entry in insert.connections:
            ends = entry.ports or [entry.source or "", entry.target or ""]
            named = [_end(addresses, end, insert.unit, taken) for end in ends]
            taken |= set(named)
            made.append({"ports": named} if entry.ports else {"from": named[0], "to": named[1]})
    return made


def _end(addresses: Addresses, end: str, unit: str, taken: set[str]) -> str:
    place, _, port = end.partition(".")
    there = addresses.units(place) if place in PLACES and place != unit else []
    name = f"{there[0] if there else place}.{port}"
    if port.startswith("effect") and name in taken:
        free = [f"{name.partition('.')[0]}.effect{k}" for k in range(1, 5)]
        name = next((it for it in free if it not in taken), name)
    return name
