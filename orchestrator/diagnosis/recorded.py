"""Which recorded column holds a channel or a scalar of the measured data."""

from __future__ import annotations

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.places import LEGS, PLACES
from orchestrator.errors import AddressError, nearest
from orchestrator.results.schema import LegChannels

_OF_SOIL = ("penetration", "skid", "contact_time")


def column(addresses: Addresses, name: str) -> str:
    """"unit.variable" of the co-simulation. Rates are the telemetry where a RateSensor is fed by the body, else the body's own."""
    place, _, rest = name.partition(".")
    if place == "peak":
        return column(addresses, rest)
    if place in ("rates", "attitude") and place not in addresses.blueprint.interfaces:
        return _checked(addresses, _of_body(addresses, place, rest), name)
    if place == "stroke":
        leg, _, strut = rest.rpartition(".")
        return _checked(addresses, f"{_leg(addresses, leg, name).leg}.{strut}.stroke", name)
    if place in _OF_SOIL:
        return _checked(addresses, f"{_leg(addresses, rest, name).soil}.{place}", name)
    return _checked(addresses, name, name)


def recorded_unit(addresses: Addresses, name: str) -> str:
    """The unit of measure that the output of a channel or scalar is declared in."""
    unit, _, variable = column(addresses, name).partition(".")
    return addresses.blueprint.interfaces[unit].variables[variable].unit


def twin_column(addresses: Addresses, name: str) -> str | None:
    """The twin's output that equals it, "sensor.telemetry.AXIS" for telemetry behind the twin; None where the twin has none."""
    found = column(addresses, name)
    unit, _, variable = found.partition(".")
    if unit in addresses.units("sensor"):
        return f"sensor.{variable}"
    names = {channels.leg: f"leg{i}." for i, channels in _numbered(addresses)}
    names |= {channels.soil: f"soil{i}." for i, channels in _numbered(addresses)}
    names |= {addresses.results.body: ""}
    twin = addresses.twin_interface
    if twin is None or unit not in names:
        return None
    inside = names[unit] + variable
    return inside if inside in twin.variables and twin.variables[inside].causality == "output" else None


def _numbered(addresses: Addresses) -> list[tuple[int, LegChannels]]:
    return [(i, addresses.results.legs[leg]) for i, leg in enumerate(LEGS, 1) if leg in addresses.results.legs]


def _of_body(addresses: Addresses, place: str, axis: str) -> str:
    body = addresses.results.body
    if place == "rates":
        for sensor in addresses.units("sensor"):
            if _feeds(addresses, f"{body}.rates", f"{sensor}.rates"):
                return f"{sensor}.telemetry.{axis}"
    return f"{body}.{place}.{axis}"


def _feeds(addresses: Addresses, first: str, second: str) -> bool:
    return any({first, second} == {it.first, it.second} for it in addresses.blueprint.scenario.connections)


def _leg(addresses: Addresses, leg: str, name: str) -> LegChannels:
    legs = addresses.results.legs
    if leg not in legs:
        raise AddressError(f'{addresses.where}: {name}: no leg "{leg}" in [results.legs]; {nearest(leg, legs)}')
    return legs[leg]


def _checked(addresses: Addresses, found: str, name: str) -> str:
    """The column, if the unit has such an output."""
    interfaces = addresses.blueprint.interfaces
    unit, _, variable = found.partition(".")
    if unit not in interfaces:
        raise AddressError(f'{addresses.where}: {name}: no unit "{unit}"; {nearest(unit, [*interfaces, *PLACES])}')
    outputs = [it.name for it in interfaces[unit].of("output")]
    if variable not in outputs:
        raise AddressError(f'{addresses.where}: {name}: unit {unit} has no output "{variable}"; {nearest(variable, outputs)}')
    return found


def contact_columns(addresses: Addresses) -> dict[str, str]:
    """Leg → the search's name of the instant at which its pad first touches; legs whose soil does not tell are left out."""
    places, found = {leg: f"soil{i}" for i, leg in enumerate(LEGS, 1)}, {}
    for leg, channels in addresses.results.legs.items():
        try:
            own = _checked(addresses, f"{channels.soil}.contact_time", leg)
        except AddressError:
            continue
        found[leg] = f"{places[leg]}.contact_time" if leg in places else own
    return found


def cosimulation_column(addresses: Addresses, name: str) -> str:
    """"unit.variable" of a column that the search calls by its twin's name; what is no twin's name is "unit.variable" already.

    Telemetry without a RateSensor is the body's rates.
    """
    heard = name.removeprefix("sensor.")
    if heard.startswith("telemetry."):
        sensors = addresses.units("sensor")
        return f"{sensors[0]}.{heard}" if sensors else f"{addresses.results.body}.rates.{heard.rpartition('.')[2]}"
    return _of_leg(addresses, name) or _of_vehicle(addresses, name)


def _of_leg(addresses: Addresses, name: str) -> str:
    """legN.* and soilN.* of the twin; nothing for another name."""
    place, _, rest = name.partition(".")
    for i, channels in _numbered(addresses):
        if place in (f"leg{i}", f"soil{i}"):
            return f"{channels.leg if place.startswith('leg') else channels.soil}.{rest}"
    return ""


def _of_vehicle(addresses: Addresses, name: str) -> str:
    body, interfaces = addresses.results.body, addresses.blueprint.interfaces
    if body in interfaces and name in interfaces[body].variables and interfaces[body].variables[name].causality == "output":
        return f"{body}.{name}"
    return _checked(addresses, name, name)
