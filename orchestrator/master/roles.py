"""Who is stepped how: repeated over an interval until it is accepted, or once per accepted step."""

from __future__ import annotations

from collections.abc import Sequence

from orchestrator.master.ports import ReducedPort
from orchestrator.master.system import Link


def repeated_units(count: int, links: Sequence[Link], eligible: Sequence[bool]) -> list[bool]:
    """A unit is repeated when it can be (`eligible`: rolls back, not declared once) and stands in a loop of such units."""
    reach = [set[int]() for _ in range(count)]
    for link in links:
        if eligible[link.source_unit] and eligible[link.target_unit]:
            reach[link.source_unit].add(link.target_unit)
    return [start in _reachable(reach, start) for start in range(count)]


def together(able: Sequence[bool], ports: Sequence[ReducedPort]) -> list[bool]:
    """Two units that share a reduced interface model are both repeated or both not: apart, the owner would step before its partner."""
    eligible = list(able)
    for _ in ports:
        for port in ports:
            eligible[port.owner] = eligible[port.partner] = eligible[port.owner] and eligible[port.partner]
    return eligible


def _reachable(reach: Sequence[set[int]], start: int) -> set[int]:
    seen: set[int] = set()
    front = list(reach[start])
    while front:
        unit = front.pop()
        if unit not in seen:
            seen.add(unit)
            front.extend(reach[unit])
    return seen


def strongly_connected(count: int, links: Sequence[Link]) -> list[set[int]]:
    """Groups of units of which each reaches every other."""
    reach = [set[int]() for _ in range(count)]
    for link in links:
        reach[link.source_unit].add(link.target_unit)
    reached = [_reachable(reach, start) for start in range(count)]
    groups: list[set[int]] = []
    for unit in range(count):
        group = {other for other in reached[unit] if unit in reached[other]} | {unit}
        if group not in groups:
            groups.append(group)
    return groups
