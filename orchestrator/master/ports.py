"""Kinds of port the master knows by their member names: one that offers a reduced interface model, and one that gives motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from orchestrator.master.slave import Interface
from orchestrator.master.system import System

MOTION = ("velocity", "angular_velocity")
EMPTY = ("", "", "")


@dataclass(frozen=True)
class ReducedPort:
    """The owner says how its port will answer a force (`model_*`); the partner, stepped first, says what it predicted from that.

    Names come in sixes: velocity[1..3], angular_velocity[1..3]; "" where the unit has none.
    """

    label: str
    owner: int
    partner: int
    reached: tuple[str, ...]
    predicted: tuple[str, ...]
    mismatch: tuple[str, ...]

    def outputs_of(self, unit: int) -> list[str]:
        names = (self.reached if unit == self.owner else ()) + (self.predicted if unit == self.partner else ())
        return [name for name in names if name]


@dataclass(frozen=True)
class MotionPort:
    """A port of a repeated unit that gives motion to another; the passes are compared there."""

    label: str
    unit: int
    names: tuple[str, ...]
    """Six, as in ReducedPort."""


def reduced_ports(system: System) -> list[ReducedPort]:
    """Every joined pair of ports in which one side offers a model and the other predicts."""
    found = []
    for pair in system.pairs:
        sides = ((pair.first_unit, pair.first_port), (pair.second_unit, pair.second_port))
        for (owner, owner_port), (partner, partner_port) in (sides, sides[::-1]):
            mine, other = system.slaves[owner].interface, system.slaves[partner].interface
            if _offers_model(mine, owner_port) and other.elements(f"{partner_port}.predicted_velocity", "output"):
                found.append(
                    ReducedPort(
                        system.label(partner, partner_port),
                        owner,
                        partner,
                        _six(mine, f"{owner_port}.", "output"),
                        _six(other, f"{partner_port}.predicted_", "output"),
                        _six(other, f"{partner_port}.mismatch_", "input"),
                    )
                )
    return found


def motion_ports(system: System, wanted: Callable[[int, int], bool]) -> list[MotionPort]:
    """Ports that feed motion from one unit to another, where that is wanted, and carry no reduced interface model of their own."""
    return [
        MotionPort(system.label(unit, port), unit, _six(system.slaves[unit].interface, f"{port}." if port else "", "output"))
        for unit in range(len(system.slaves))
        for port in _ports_giving_motion(system, unit, wanted)
    ]


def motion_stems(system: System, unit: int) -> list[str]:
    """Stems of the motion this unit gives, whether or not all of it is taken."""
    ports = _ports_giving_motion(system, unit, lambda source, target: True)
    return [f"{port}.{member}" if port else member for port in ports for member in MOTION]


def _ports_giving_motion(system: System, unit: int, wanted: Callable[[int, int], bool]) -> list[str]:
    interface = system.slaves[unit].interface
    ports: dict[str, None] = {}
    for link in system.links:
        if link.source_unit == unit and wanted(unit, link.target_unit):
            port, _, member = link.source.partition("[")[0].rpartition(".")
            port = port.partition("#")[0]  # what is converted for a connection is motion of the port it comes from
            if member in MOTION and not _offers_model(interface, port):
                ports[port] = None
    return list(ports)


def _offers_model(interface: Interface, port: str) -> bool:
    return any(s.startswith(f"{port}.model_") and interface.vectors[s][0].causality == "output" for s in interface.ports.get(port, ()))


def _six(interface: Interface, prefix: str, causality: str) -> tuple[str, ...]:
    names: tuple[str, ...] = ()
    for member in MOTION:
        elements = tuple(v.name for v in interface.elements(prefix + member, causality))[:3]
        names += elements + EMPTY[len(elements) :]
    return names
