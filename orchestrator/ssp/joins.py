"""Which connections are whole ports joined: those the annotation lists, or, without one, those whose every link is there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from orchestrator.errors import SspError, WiringError
from orchestrator.master.slave import Interface
from orchestrator.scenario.conversion import Alteration
from orchestrator.scenario.expand import Connection
from orchestrator.scenario.wiring import Wiring
from orchestrator.ssp.ways import PLAIN, Way, way_of

Ends = tuple[str, str]
"""Source and target, each "unit.variable"."""
ALTERATION = {"frame", "scale", "offset"}
"""Keys of a scenario's connection that change the numbers."""


@dataclass(frozen=True)
class Joined:
    """A connection as a scenario says it, and the element links it stands for."""

    table: dict[str, Any]
    ends: list[Ends]


def joins(interfaces: Mapping[str, Interface], there: Mapping[Ends, Way], where: str, own: list[dict[str, Any]] | None) -> list[Joined]:
    """Our annotation is believed as far as the description's own connections bear it out: a connection changed there is changed here."""
    tables = list(_candidates(interfaces, there)) if own is None else own
    left, found = dict(there), []
    for table in tables:
        links = _links(interfaces, table, where)
        plain = not ALTERATION.intersection(table)          # where nothing is asked for, a unit conversion may go without saying
        if links and all(left.get(ends) == way or (plain and left.get(ends) == PLAIN) for ends, way in links.items()):
            for ends in links:
                del left[ends]
            found.append(Joined(table, list(links)))
    return found


def _links(interfaces: Mapping[str, Interface], table: dict[str, Any], where: str) -> dict[Ends, Way]:
    """What the connection comes to; nothing where these units cannot be connected so."""
    both_ways = "ports" in table
    first, second = table["ports"] if both_ways else (table["from"], table["to"])
    wiring = Wiring(interfaces, where)
    try:
        asked = Alteration.of(*(table.get(key) for key in ("frame", "scale", "offset")))
        wiring.connect(Connection(first, second, both_ways, True, alteration=asked))
        found = [(link, way_of(wiring.derived[link.source_unit], link, where)) for link in wiring.links]
    except (WiringError, SspError):
        return {}
    names = list(interfaces)
    return {
        (f"{names[link.source_unit]}.{source}", f"{names[link.target_unit]}.{link.target}"): way for link, (source, way) in found
    }


def _candidates(interfaces: Mapping[str, Interface], there: Iterable[Ends]) -> list[dict[str, Any]]:
    """Every pair of ports between which something is connected."""
    pairs: dict[frozenset[str], list[str]] = {}
    for ends in there:
        ports = [_port(end) for end in ends]
        if all(port.partition(".")[2] in interfaces[port.partition(".")[0]].ports for port in ports):
            pairs.setdefault(frozenset(ports), ports)
    return [{"ports": ports} for ports in pairs.values() if len(set(ports)) == 2]


def _port(end: str) -> str:
    return end.rpartition(".")[0]
