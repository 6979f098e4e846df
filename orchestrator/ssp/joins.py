"""Which connections are whole ports joined: those the annotation lists, or, without one, those whose every link is there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from orchestrator.errors import WiringError
from orchestrator.master.slave import Interface
from orchestrator.scenario.expand import Connection
from orchestrator.scenario.wiring import Wiring

Ends = tuple[str, str]
"""Source and target, each "unit.variable"."""


@dataclass(frozen=True)
class Joined:
    """A connection as a scenario says it, and the element links it stands for."""

    table: dict[str, Any]
    ends: list[Ends]


def joins(interfaces: Mapping[str, Interface], there: Sequence[Ends], where: str, own: list[dict[str, Any]] | None) -> list[Joined]:
    """Our annotation is believed as far as the description's own connections bear it out: a connection changed there is changed here."""
    tables = list(_candidates(interfaces, there)) if own is None else own
    left, found = set(there), []
    for table in tables:
        ends = _links(interfaces, table, where)
        if ends and left.issuperset(ends):
            left.difference_update(ends)
            found.append(Joined(table, ends))
    return found


def _links(interfaces: Mapping[str, Interface], table: dict[str, Any], where: str) -> list[Ends]:
    """What the connection comes to; nothing where these units cannot be connected so."""
    both_ways = "ports" in table
    first, second = table["ports"] if both_ways else (table["from"], table["to"])
    wiring = Wiring(interfaces, where)
    try:
        wiring.connect(Connection(first, second, both_ways, True))
    except WiringError:
        return []
    names = list(interfaces)
    return [(f"{names[k.source_unit]}.{k.source}", f"{names[k.target_unit]}.{k.target}") for k in wiring.links]


def _candidates(interfaces: Mapping[str, Interface], there: Sequence[Ends]) -> list[dict[str, Any]]:
    """Every pair of ports between which something is connected."""
    pairs: dict[frozenset[str], list[str]] = {}
    for ends in there:
        ports = [_port(end) for end in ends]
        if all(port.partition(".")[2] in interfaces[port.partition(".")[0]].ports for port in ports):
            pairs.setdefault(frozenset(ports), ports)
    return [{"ports": ports} for ports in pairs.values() if len(set(ports)) == 2]


def _port(end: str) -> str:
    return end.rpartition(".")[0]
