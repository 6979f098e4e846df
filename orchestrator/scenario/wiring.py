"""Connections by name -> links between elements, checked: existence, direction, kind, unit of measure, one source per input."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from orchestrator.errors import WiringError, nearest
from orchestrator.master.slave import Interface, Variable
from orchestrator.master.system import Link, PortPair, Scheme
from orchestrator.scenario.expand import Connection

_COMPANIONS = {"output": ("_mean", "_slope"), "input": ("_slope", "_added")}
_BY_THE_MASTER = ("mismatch_velocity", "mismatch_angular_velocity")


class Manner(NamedTuple):
    """How a connection's links are to be coupled."""

    slope: bool
    scheme: Scheme | None


class Wiring:
    """Grows connection by connection; `where` opens its messages."""

    def __init__(self, interfaces: Mapping[str, Interface], where: str, slopes: bool = True) -> None:
        self._interfaces = interfaces
        self._places = {name: place for place, name in enumerate(interfaces)}
        self._where = where
        self._slopes = slopes
        self._fed: dict[tuple[int, str], str] = {}
        self.links: list[Link] = []
        self.pairs: list[PortPair] = []

    def connect(self, connection: Connection) -> None:
        if connection.both_ways:
            self._join(connection)
        else:
            self._link_by_name(connection)

    def _join(self, connection: Connection) -> None:
        (first, first_port), (second, second_port) = (self._port(text) for text in (connection.first, connection.second))
        manner = self._manner(connection)
        made = self._one_way(first, first_port, second, second_port, manner) + self._one_way(second, second_port, first, first_port, manner)
        if not made:
            gives = ", ".join(self._members(first, first_port, "output")) or "nothing"
            takes = ", ".join(self._members(second, second_port, "input")) or "nothing"
            label = f"{self._where}: {connection.first} <-> {connection.second}"
            raise WiringError(f"{label}: no member in common: one gives {gives}, the other takes {takes}; join other ports")
        self.pairs.append(PortPair(self._places[first], first_port, self._places[second], second_port))

    def _manner(self, connection: Connection) -> Manner:
        return Manner(connection.slope and self._slopes, Scheme(connection.scheme) if connection.scheme else None)

    def _one_way(self, source: str, source_port: str, target: str, target_port: str, manner: Manner) -> int:
        given = self._members(source, source_port, "output")
        taken = self._members(target, target_port, "input")
        common = [member for member in given if member in taken and member not in _BY_THE_MASTER]
        for member in common:
            self._link(source, given[member], target, taken[member], manner)
        return len(common)

    def _members(self, unit: str, port: str, causality: str) -> dict[str, list[Variable]]:
        """Member name -> elements, companions left out (they follow the member they belong to)."""
        interface = self._interfaces[unit]
        members = {}
        for name in interface.ports.get(port, ()):
            elements = interface.elements(name, causality)
            if elements and not _is_companion(interface, name, causality):
                members[name.rpartition(".")[2]] = elements
        return members

    def _link_by_name(self, connection: Connection) -> None:
        source, given = self._variable(connection.first, "output")
        target, taken = self._variable(connection.second, "input")
        self._link(source, given, target, taken, self._manner(connection))

    def _link(self, source: str, given: Sequence[Variable], target: str, taken: Sequence[Variable], manner: Manner) -> None:
        label = f"{self._where}: {source}.{given[0].name} -> {target}.{taken[0].name}"
        if len(given) != len(taken):
            raise WiringError(f"{label}: sends {len(given)} elements, expects {len(taken)}; connect vectors of one length")
        for one, other in zip(given, taken, strict=True):
            if one.kind is not other.kind:
                raise WiringError(f"{label}: sends {one.kind}, expects {other.kind}; connect variables of one kind")
            if not same_unit(one, other):
                raise WiringError(f"{label}: sends {one.unit}, expects {other.unit}; connect variables of one unit of measure")
            place = (self._places[target], other.name)
            if place in self._fed:
                raise WiringError(
                    f"{self._where}: {target}.{other.name}: fed by {self._fed[place]} and by {source}.{one.name}; remove one connection"
                )
            self._fed[place] = f"{source}.{one.name}"
            self.links.append(Link(self._places[source], one.name, self._places[target], other.name, *manner))

    def _port(self, text: str) -> tuple[str, str]:
        unit, name = self._unit(text)
        ports = self._interfaces[unit].ports
        if name not in ports:
            raise WiringError(f'{self._where}: {text}: unit {unit} has no port "{name}"; {nearest(name, ports)}')
        return unit, name

    def _variable(self, text: str, causality: str) -> tuple[str, list[Variable]]:
        unit, name = self._unit(text)
        interface = self._interfaces[unit]
        found = interface.elements(name, causality)
        if found:
            return unit, found
        other = interface.vectors.get(name) or ([interface.variables[name]] if name in interface.variables else None)
        if other:
            raise WiringError(f"{self._where}: {text}: is of causality {other[0].causality}, expects {causality}; exchange from and to?")
        stems = [s for s, elements in interface.vectors.items() if elements[0].causality == causality]
        raise WiringError(f'{self._where}: {text}: unit {unit} has no {causality} "{name}"; {nearest(name, stems)}')

    def _unit(self, text: str) -> tuple[str, str]:
        unit, dot, rest = text.partition(".")
        if unit not in self._interfaces:
            raise WiringError(f'{self._where}: {text}: no unit "{unit}"; {nearest(unit, self._interfaces)}')
        if not (dot and rest):
            raise WiringError(f"{self._where}: {text}: expects unit.port or unit.variable; {nearest('', self._interfaces[unit].ports)}")
        return unit, rest


def same_unit(one: Variable, other: Variable) -> bool:
    """By base-unit exponents, factor and offset where both define them, else by name; an undeclared unit fits anything."""
    if not one.unit or not other.unit or one.unit == other.unit:
        return True
    return one.dimension is not None and one.dimension == other.dimension


def _is_companion(interface: Interface, name: str, causality: str) -> bool:
    return any(
        name.endswith(suffix) and bool(interface.elements(name.removesuffix(suffix), causality)) for suffix in _COMPANIONS[causality]
    )
