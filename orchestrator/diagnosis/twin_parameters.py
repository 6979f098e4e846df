"""The twin that equals a scenario of separate units: LunarLander's parameters, and those of the RateSensor run behind it."""

from __future__ import annotations

import re

from orchestrator.diagnosis.addresses import Addresses, Slot
from orchestrator.diagnosis.places import LEGS, PLACES, TWIN
from orchestrator.master.slave import Interface, Kind
from orchestrator.scenario.expand import Connection

Parameters = dict[str, list[float]]
_NOT_IN_TWIN = ("longest_substep", "vehicle_mass", "gravity", "footpad_radius", "footpad_height", "azimuth")
"""Parameters of legs and soils that the twin has once, or steers otherwise; `_shared` compares what must agree."""
_NUMBER = re.compile(r"(\.(?:leg|contact|effect))\d+$")
_ADDED = ("plume", "slosh", "rcs", "body_term")


def twin_parameters(addresses: Addresses) -> tuple[Parameters | None, str]:
    """Vector -> its elements, for the LunarLander FMU; a RateSensor's as "sensor.NAME". Or None and why the twin cannot stand in."""
    reason = why_not(addresses)
    twin = addresses.library(TWIN)
    if reason or twin is None:
        return None, reason or f"{addresses.folder} has no {TWIN}.fmu"
    found: Parameters = {}
    for place in ("body", "gear"):
        found |= _of(addresses, addresses.units(place)[0], "", twin, _NOT_IN_TWIN if place == "gear" else ())
    found["azimuth"] = [addresses.number(Slot(leg, "azimuth")) for leg in _in_order(addresses, "gear")]
    soils = [_of(addresses, soil, "soil.", twin, _NOT_IN_TWIN) for soil in _in_order(addresses, "soil")]
    found |= {name: [number for soil in soils for number in soil[name]] for name in soils[0]}
    for place in ("guidance", *_ADDED):
        for unit in addresses.units(place):
            found |= _of(addresses, unit, f"{place}.", twin, ())
    for unit in addresses.units("sensor"):
        interface = addresses.blueprint.interfaces[unit]
        found |= {f"sensor.{name}": value for name, value in _of(addresses, unit, "", interface, ()).items()}
    return found, ""


def why_not(addresses: Addresses) -> str:
    """Why the twin cannot stand in for the scenario; empty where it can."""
    if any(isinstance(value, str) and value for values in addresses.blueprint.values for value in values.values()):
        return "a unit is given a text, as a height map's file is, and the twin is flown with numbers alone"
    if addresses.is_twin:
        return ""
    for check in (_begun_elsewhere, _foreign, _wired_otherwise, _shared, _constant_inputs, _unheard):
        reason = check(addresses)
        if reason:
            return reason
    return ""


def _begun_elsewhere(addresses: Addresses) -> str:
    """The search's landings begin with the lowest pad at the ground."""
    start = addresses.blueprint.scenario.table.start
    if start is None:
        return "the scenario has no [start] that puts the lowest pad at the ground, where the twin's landings begin"
    return f"the scenario begins {start.value:g} m above the ground, the twin's landings at it" if start.value != 0.0 else ""


def _foreign(addresses: Addresses) -> str:
    if set(addresses.results.legs) != set(LEGS):
        return f"[results.legs] names {', '.join(addresses.results.legs) or 'none'}, the twin has {', '.join(LEGS)}"
    expected = {unit: model for place, model in PLACES.items() for unit in addresses.units(place)}
    for unit, interface in addresses.blueprint.interfaces.items():
        if unit not in expected:
            return f"unit {unit} ({interface.model_name}) has no part in the twin"
        if interface.model_name != expected[unit]:
            return f"unit {unit} is a {interface.model_name}, the twin holds a {expected[unit]}"
    for place in ("body", "soil", "gear"):
        if len(addresses.units(place)) != (1 if place == "body" else len(LEGS)):
            return f"the scenario has {len(addresses.units(place))} units at {place}"
    several = [place for place in ("guidance", "sensor", *_ADDED) if len(addresses.units(place)) > 1]
    return f"the scenario has two units at {several[0]}" if several else ""


def _wired_otherwise(addresses: Addresses) -> str:
    """Whether the connections are those that the twin has inside; which number a leg has at the body and at guidance does not matter."""
    standard = _standard(addresses)
    missing = set(standard)
    for connection in addresses.blueprint.scenario.connections:
        ends = _ends(connection)
        if ends in missing:
            missing.remove(ends)
        elif not _feeds_an_added_unit(addresses, connection):
            return f"the connection of {connection.first} and {connection.second} is not in the twin"
    return f"the twin has a connection of {' and '.join(sorted(min(missing, key=sorted)))}, the scenario does not" if missing else ""


def _ends(connection: Connection) -> frozenset[str]:
    """Both ends, without the number of a leg, contact or effect."""
    return frozenset(_NUMBER.sub(r"\1#", end) for end in (connection.first, connection.second))


def _standard(addresses: Addresses) -> set[frozenset[str]]:
    body = addresses.results.body
    pairs = set()
    for names in addresses.results.legs.values():
        pairs |= {(f"{body}.body", f"{names.leg}.body"), (f"{names.leg}.mount", f"{body}.leg#"), (f"{names.leg}.pad", f"{names.soil}.pad")}
    for unit in addresses.units("guidance"):
        pairs |= {(f"{unit}.engine", f"{body}.engine")}
        pairs |= {(f"{names.soil}.contact", f"{unit}.contact#") for names in addresses.results.legs.values()}
    pairs |= {(f"{body}.rates", f"{unit}.rates") for unit in addresses.units("sensor")}
    pairs |= {(f"{unit}.effect", f"{body}.effect#") for place in _ADDED for unit in addresses.units(place)}
    return {frozenset(pair) for pair in pairs}


def _feeds_an_added_unit(addresses: Addresses, connection: Connection) -> bool:
    """What body and guidance tell a plume, a pendulum, a term: inside the twin they know it."""
    added = {unit for place in _ADDED for unit in addresses.units(place)}
    sources = {addresses.results.body, *addresses.units("guidance")}
    units = {end.partition(".")[0] for end in (connection.first, connection.second)}
    return len(units & added) == 1 and len(units & sources) == 1 and not any("effect" in it for it in (connection.first, connection.second))


def _shared(addresses: Addresses) -> str:
    """What the twin has once must agree among the units that have it each."""
    legs, soils, body = addresses.units("gear"), addresses.units("soil"), addresses.units("body")
    groups = [(("mass", body), ("vehicle_mass", legs)), (("gravity", body), ("gravity", [*legs, *addresses.units("slosh")]))]
    groups += [((name, legs), (name, soils)) for name in ("footpad_radius", "footpad_height")]
    own = addresses.blueprint.interfaces[legs[0]].of("parameter")
    groups += [((it.name, legs[:1]), (it.name, legs[1:])) for it in own if it.name not in _NOT_IN_TWIN]
    for group in groups:
        values = {f"{unit}.{name}": addresses.number(Slot(unit, name)) for name, units in group for unit in units}
        first, value = next(iter(values.items()))
        for other, number in values.items():
            if number != value:
                return f"{first} is {value:g} and {other} {number:g}, the twin has one for both"
    return ""


def _constant_inputs(addresses: Addresses) -> str:
    """An input that the scenario sets to a constant: the twin has none of them."""
    for (unit, interface), values in zip(addresses.blueprint.interfaces.items(), addresses.blueprint.values, strict=True):
        for name in values:
            if interface.variables[name].causality == "input":
                return f"{unit}.{name} is set to a constant, the twin has no such input"
    return ""


def _unheard(addresses: Addresses) -> str:
    """A parameter that the twin does not have, set to another value than its unit's own."""
    twin = addresses.library(TWIN)
    if twin is None:
        return f"{addresses.folder} has no {TWIN}.fmu"
    prefixes = {"body": "", "gear": "", "soil": "soil."} | {place: f"{place}." for place in ("guidance", *_ADDED)}
    for place, prefix in prefixes.items():
        for unit in addresses.units(place):
            values = addresses.blueprint.values[list(addresses.blueprint.interfaces).index(unit)]
            for name, elements in addresses.blueprint.interfaces[unit].vectors.items():
                if name in _NOT_IN_TWIN or prefix + name in twin.vectors or elements[0].causality != "parameter":
                    continue
                if elements[0].kind is Kind.STRING:
                    continue
                if any(it.name in values and values[it.name] != addresses.start(unit, it.name) for it in elements):
                    return f"{unit}.{name} is set, the twin has no such parameter"
    return ""


def _in_order(addresses: Addresses, place: str) -> list[str]:
    return [unit for leg in LEGS for unit in addresses.units(place, leg)]


def _of(addresses: Addresses, unit: str, prefix: str, target: Interface, without: tuple[str, ...]) -> Parameters:
    """The unit's parameters under their names in the target; one that the target does not have changes nothing there (`_unheard`)."""
    found: Parameters = {}
    for name, elements in addresses.blueprint.interfaces[unit].vectors.items():
        if elements[0].causality != "parameter" or name in without or prefix + name not in target.vectors:
            continue
        found[prefix + name] = [addresses.number(Slot(unit, it.name)) for it in elements]
    return found
