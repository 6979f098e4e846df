"""Connections by name -> links between elements, checked: existence, direction, kind, unit of measure, one source per input."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from orchestrator.errors import WiringError
from orchestrator.master.converter import Derived
from orchestrator.master.plan import companion
from orchestrator.master.slave import Interface, Kind, Variable, stem
from orchestrator.master.system import Link, PortPair, Scheme
from orchestrator.scenario.conversion import Alteration, LinearMap, linear_map
from orchestrator.scenario.expand import Connection
from orchestrator.scenario.record import NUMBERS
from orchestrator.scenario.selection import Selection

_COMPANIONS = {"output": ("_mean", "_slope"), "input": ("_slope", "_added")}
_BY_THE_MASTER = ("mismatch_velocity", "mismatch_angular_velocity")
_MODEL = "model_"


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
        self._select = Selection(interfaces, where)
        self._fed: dict[tuple[int, str], str] = {}
        self.links: list[Link] = []
        self.pairs: list[PortPair] = []
        self.derived: list[list[Derived]] = [[] for _ in interfaces]
        """Per unit, outputs worked out for its connections."""
        self.made: list[int] = []
        """Per connection, how many links it came to."""
        self._conversions = 0

    def connect(self, connection: Connection) -> None:
        before = len(self.links)
        if connection.both_ways:
            self._join(connection)
        else:
            self._link_by_name(connection)
        self.made.append(len(self.links) - before)

    def _join(self, connection: Connection) -> None:
        (first, first_port), (second, second_port) = (self._select.port(text) for text in (connection.first, connection.second))
        manner, frame, converted = self._manner(connection), connection.alteration, self._conversions
        label = f"{self._where}: {connection.first} <-> {connection.second}"
        if frame.mirrors:
            raise WiringError(f"{label}: frame mirrors (its determinant is -1), which torques and rates do not follow; give a rotation")
        there = self._one_way(first, first_port, second, second_port, manner, frame)
        back = self._one_way(second, second_port, first, first_port, manner, frame.back())
        if not there + back:
            gives = ", ".join(self._members(first, first_port, "output")) or "nothing"
            takes = ", ".join(self._members(second, second_port, "input")) or "nothing"
            raise WiringError(f"{label}: no member in common: one gives {gives}, the other takes {takes}; join other ports")
        modelled = [member for member in there + back if member.startswith(_MODEL)]
        if modelled and self._conversions > converted:
            raise WiringError(
                f"{label}: {modelled[0]} is a reduced interface model, which goes between equal units of measure and frames only;"
                " give both units the same, or join the ports without a frame"
            )
        self.pairs.append(PortPair(self._places[first], first_port, self._places[second], second_port))

    def _manner(self, connection: Connection) -> Manner:
        return Manner(connection.slope and self._slopes, Scheme(connection.scheme) if connection.scheme else None)

    def _one_way(self, source: str, source_port: str, target: str, target_port: str, manner: Manner, frame: Alteration) -> list[str]:
        given = self._members(source, source_port, "output")
        taken = self._members(target, target_port, "input")
        common = [member for member in given if member in taken and member not in _BY_THE_MASTER]
        for member in common:
            turned = frame if given[member][0].kind is Kind.REAL else Alteration()
            self._link(source, given[member], target, taken[member], manner, turned)
        return common

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
        source, given = self._select.variables(connection.first, "output")
        target, taken = self._select.variables(connection.second, "input")
        self._link(source, given, target, taken, self._manner(connection), connection.alteration)

    def _link(
        self, source: str, given: Sequence[Variable], target: str, taken: Sequence[Variable], manner: Manner, asked: Alteration
    ) -> None:
        label = f"{self._where}: {source}.{given[0].name} -> {target}.{taken[0].name}"
        if len(given) != len(taken):
            raise WiringError(f"{label}: sends {len(given)} elements, expects {len(taken)}; connect vectors of one length")
        for one, other in zip(given, taken, strict=True):
            _require_kinds(one, other, asked, label)
        change = linear_map(given, taken, asked, label)
        names = [v.name for v in given] if change.identical else self._derive(source, given, taken, change)
        for one, name, other in zip(given, names, taken, strict=True):
            place = (self._places[target], other.name)
            if place in self._fed:
                raise WiringError(
                    f"{self._where}: {target}.{other.name}: fed by {self._fed[place]} and by {source}.{one.name}; remove one connection"
                )
            self._fed[place] = f"{source}.{one.name}"
            self.links.append(Link(self._places[source], name, self._places[target], other.name, *manner))

    def _derive(self, source: str, given: Sequence[Variable], taken: Sequence[Variable], change: LinearMap) -> list[str]:
        """Further outputs of the source, converted; with mean and slope where the given ones have them."""
        self._conversions += 1
        port, dot, member = stem(given[0].name).rpartition(".")
        base = f"{port}#{self._conversions}{dot or '.'}{member}"
        names = [f"{base}[{row + 1}]" for row in range(len(taken))]
        known = self._interfaces[source].variables
        for suffix, shift in (("", change.offset), ("_mean", change.offset), ("_slope", 0.0 * change.offset)):
            sources = [companion(v.name, suffix) if suffix else v.name for v in given]
            for row, (name, other) in enumerate(zip(names, taken, strict=True)):
                used = np.flatnonzero(change.weights[row])
                used = used if used.size else np.arange(len(sources))  # scaled by zero: sent all the same
                parts = [sources[k] for k in used]
                if parts and all(part in known and known[part].causality == "output" for part in parts):
                    weights = tuple(float(change.weights[row, k]) for k in used)
                    nominal = sum(abs(w) * known[part].nominal for w, part in zip(weights, parts, strict=True)) or 1.0
                    variable = replace(
                        other, name=companion(name, suffix) if suffix else name, kind=Kind.REAL, causality="output", nominal=nominal
                    )
                    self.derived[self._places[source]].append(Derived(variable, tuple(parts), weights, float(shift[row])))
        return names


def _require_kinds(one: Variable, other: Variable, asked: Alteration, label: str) -> None:
    """Equal kinds; a whole number may be sent as a real one, and anything numeric where the scenario says how."""
    if one.kind not in (*NUMBERS, Kind.STRING):
        raise WiringError(f"{label}: sends {one.kind}, which this master does not exchange; leave it unconnected")
    numeric = one.kind in NUMBERS and other.kind is Kind.REAL
    if one.kind is not other.kind and not (numeric and (one.kind is Kind.INTEGER or not asked.nothing)):
        raise WiringError(f"{label}: sends {one.kind}, expects {other.kind}; connect variables of one kind")
    if not asked.nothing and other.kind is not Kind.REAL:
        raise WiringError(f"{label}: expects {other.kind}, which takes no frame, scale or offset; leave those out")


def _is_companion(interface: Interface, name: str, causality: str) -> bool:
    return any(
        name.endswith(suffix) and bool(interface.elements(name.removesuffix(suffix), causality)) for suffix in _COMPANIONS[causality]
    )
