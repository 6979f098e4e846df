"""Where every input comes from, worked out once: index arrays into one board of numbers.

    board = [ outputs at the start of the interval | outputs now | 0 | mismatches, six per port with a reduced interface model
            | outputs at the end as a quasi-Newton assumes them | 1 ]

An input vector is u = board[first] − H/2·board[second] (second only where a slope is subtracted), so a step costs two
array operations per unit whatever is connected. The naming rule is in docs/decisions/0001-architecture.md:
a fresh mean m with slope k is sent as m − k·H/2 and k; everything else as its value at the start, with slope 0.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from orchestrator.master.ports import ReducedPort, motion_stems, reduced_ports
from orchestrator.master.slave import Binding, Interface, Kind, Slave, Vector, stem
from orchestrator.master.system import Link, System

Places = NDArray[np.intp]
REFERENCE, VALID = "reference_", "reference_valid"
SCHEDULED = "next_event_time"
"""Last part of the name of a Real output: a time a communication point must fall on, s."""


class Phase(Enum):
    FIRST = 0
    """First pass over an interval."""
    AGAIN = 1
    """Later passes: every repeated unit was stepped over this interval before."""
    AFTER = 2
    """Units stepped once, after acceptance."""


@dataclass
class Job:
    """One unit in one phase."""

    unit: int
    slave: Slave
    u: Vector
    first: Places
    second: Places
    """Empty where no slope is subtracted."""
    half_rise: Vector
    """Room for H/2 times the slopes."""


@dataclass
class Board:
    """The numbers all units share. `start`, `now` and `mismatch` are views."""

    values: Vector
    start: Vector
    now: Vector
    mismatch: Vector
    MEMORY = ("values",)
    offset: list[int]
    """Per unit, where its outputs begin within `start` and `now`."""
    names: list[tuple[int, str]]
    """(unit, variable) of each output."""
    place: dict[tuple[int, str], int] = field(default_factory=dict)

    @property
    def zero(self) -> int:
        return 2 * len(self.names)

    @property
    def one(self) -> int:
        return len(self.values) - 1

    def now_at(self, unit: int, name: str) -> int:
        return len(self.names) + self.place[unit, name]

    def start_at(self, unit: int, name: str) -> int:
        return self.place[unit, name]

    def end_at(self, unit: int, name: str) -> int:
        return len(self.values) - 1 - len(self.names) + self.place[unit, name]


def companion(name: str, suffix: str) -> str:
    """"pad.force[3]", "_mean" -> "pad.force_mean[3]"."""
    base = stem(name)
    return base + suffix + name[len(base) :]


@dataclass
class Plan:
    system: System
    board: Board
    MEMORY = ("board",)
    reduced: list[ReducedPort]
    inputs: list[list[str]]
    rates: list[list[str]]
    vectors: list[Vector]
    coupled: list[int]
    """Per unit, how many of its outputs are fetched after every step; they stand first."""

    @property
    def scheduled(self) -> list[tuple[int, str]]:
        """(unit, output) of the times units announce."""
        slaves = enumerate(self.system.slaves)
        return [(unit, name) for unit, slave in slaves for name in _scheduled(slave.interface)]

    def jobs(self, phase: Phase, units: list[int], repeated: list[bool], held: Collection[Link] = ()) -> list[Job]:
        """The units of a phase in order, each with the sources of its inputs; links that are `held` carry values at the start."""
        rank = {unit: at for at, unit in enumerate(units)}
        return [self._job(unit, phase, repeated, rank, held) for unit in units]

    def input_places(self, unit: int) -> dict[str, int]:
        """Where in its vector each input stands, and each derivative by the standard call as `der(name)`."""
        return {name: at for at, name in enumerate([*self.inputs[unit], *(f"der({r})" for r in self.rates[unit])])}

    def _job(self, unit: int, phase: Phase, repeated: list[bool], rank: dict[int, int], held: Collection[Link]) -> Job:
        u = self.vectors[unit]
        places = self.input_places(unit)
        first = np.full(len(u), self.board.zero, dtype=np.intp)
        second = first.copy()
        for link in self.system.links:
            if link.target_unit == unit:
                fresh = link not in held and _is_fresh(link.source_unit, unit, phase, repeated, rank)
                self._route(link, fresh, places, first, second)
        if phase is Phase.AGAIN:
            for number, port in enumerate(self.reduced):
                if port.partner == unit:
                    base = self.board.zero + 1 + 6 * number
                    for at, name in enumerate(port.mismatch):
                        if name in places:
                            first[places[name]] = base + at
            for name, own in _references(self.system.slaves[unit].interface).items():
                first[places[name]] = self.board.now_at(unit, own) if own else self.board.one
        if (second == self.board.zero).all():
            second = second[:0]
        return Job(unit, self.system.slaves[unit], u, first, second, np.zeros(len(second)))

    def _route(self, link: Link, fresh: bool, places: dict[str, int], first: Places, second: Places) -> None:
        board, source = self.board, link.source_unit
        target = places[link.target]
        mean, slope = companion(link.source, "_mean"), companion(link.source, "_slope")
        if not fresh or (source, mean) not in board.place:
            first[target] = board.start_at(source, link.source)
            return
        first[target] = board.now_at(source, mean)
        sloped = places.get(companion(link.target, "_slope"), places.get(f"der({link.target})"))
        if link.slope and sloped is not None and (source, slope) in board.place:
            first[sloped] = board.now_at(source, slope)
            second[target] = board.now_at(source, slope)


def make_plan(system: System) -> Plan:
    """Bind every unit's vectors to the board and remember what stands where."""
    reduced = reduced_ports(system)
    inputs = [_inputs(system, unit, reduced) for unit in range(len(system.slaves))]
    rates = [_rates(system, unit) for unit in range(len(system.slaves))]
    outputs = [_outputs(system, unit, reduced) for unit in range(len(system.slaves))]
    total = sum(len(names) for names, _ in outputs)
    values = np.zeros(3 * total + 2 + 6 * len(reduced))
    values[-1] = 1.0
    board = Board(values, values[:total], values[total : 2 * total], values[2 * total + 1 : -1 - total], [], [])
    vectors: list[Vector] = []
    for unit, (names, coupled) in enumerate(outputs):
        begin = len(board.names)
        board.offset.append(begin)
        board.place.update({(unit, name): begin + at for at, name in enumerate(names)})
        board.names.extend((unit, name) for name in names)
        vectors.append(np.zeros(len(inputs[unit]) + len(rates[unit])))
        y = board.now[begin : begin + len(names)]
        system.slaves[unit].bind(Binding(inputs[unit], rates[unit], names, coupled, vectors[unit], y))
    return Plan(system, board, reduced, inputs, rates, vectors, [coupled for _, coupled in outputs])


def _is_fresh(source: int, target: int, phase: Phase, repeated: list[bool], rank: dict[int, int]) -> bool:
    """Whether the source was already computed over this interval when the target steps."""
    earlier = source in rank and rank[source] < rank[target]
    if phase is Phase.FIRST:
        return repeated[source] and earlier
    if phase is Phase.AGAIN:
        return repeated[source]
    return repeated[source] or earlier


def _inputs(system: System, unit: int, reduced: list[ReducedPort]) -> list[str]:
    """Linked inputs, their slopes, and mismatches; real ones first."""
    variables = system.slaves[unit].interface.variables
    names: dict[str, None] = {}
    for link in system.links:
        if link.target_unit == unit:
            names[link.target] = None
            slope = companion(link.target, "_slope")
            if slope in variables and variables[slope].causality == "input":
                names[slope] = None
    for port in reduced:
        if port.partner == unit:
            names.update(dict.fromkeys(name for name in port.mismatch if name in variables))
    names.update(dict.fromkeys(_references(system.slaves[unit].interface)))
    return _real_first(names, system.slaves[unit].interface)


def _references(interface: Interface) -> dict[str, str]:
    """Inputs `p.reference_x` -> the unit's own output `p.x`, whose value of the pass before they take; `p.reference_valid` -> ""."""
    found = {}
    for name, variable in interface.variables.items():
        port, _, member = stem(name).rpartition(".")
        if variable.causality == "input" and member.startswith(REFERENCE):
            own = f"{port}.{member.removeprefix(REFERENCE)}{name[len(stem(name)) :]}"
            if member == VALID:
                found[name] = ""
            elif own in interface.variables and interface.variables[own].causality == "output":
                found[name] = own
    return found


def _rates(system: System, unit: int) -> list[str]:
    """Inputs whose derivative is set by the standard call: the unit interpolates and has no slope input of its own."""
    interface = system.slaves[unit].interface
    if not interface.claims("canInterpolateInputs"):
        return []
    targets = [link.target for link in system.links if link.target_unit == unit]
    return [t for t in targets if interface.variables[t].kind is Kind.REAL and companion(t, "_slope") not in interface.variables]


def _outputs(system: System, unit: int, reduced: list[ReducedPort]) -> tuple[list[str], int]:
    """Outputs in the order of the board, and how many leading reals are fetched after every step."""
    interface = system.slaves[unit].interface
    coupled: dict[str, None] = {}
    for link in system.links:
        if link.source_unit == unit:
            wanted = (link.source, companion(link.source, "_mean"), companion(link.source, "_slope"))
            coupled.update(dict.fromkeys(name for name in wanted if name in interface.variables))
    for port in reduced:
        coupled.update(dict.fromkeys(port.outputs_of(unit)))
    for pair in system.pairs:
        for owner, name in ((pair.first_unit, pair.first_port), (pair.second_unit, pair.second_port)):
            if owner == unit:
                coupled.update(dict.fromkeys(v.name for v in interface.elements(f"{name}.work", "output")))
    coupled.update(dict.fromkeys(own for own in _references(interface).values() if own))
    coupled.update(dict.fromkeys(v.name for s in motion_stems(system, unit) for v in interface.elements(s, "output")))
    coupled.update(dict.fromkeys(_scheduled(interface)))
    others = [name for lists in (system.recorded, system.watched, system.located) if lists for name in lists[unit]]
    real = [name for name in coupled if interface.variables[name].kind is Kind.REAL]
    rest = dict.fromkeys(name for name in [*coupled, *others] if name not in set(real))
    return real + _real_first(rest, interface), len(real)


def _scheduled(interface: Interface) -> list[str]:
    return [v.name for v in interface.of("output") if v.kind is Kind.REAL and v.name.rpartition(".")[2] == SCHEDULED]


def _real_first(names: dict[str, None], interface: Interface) -> list[str]:
    return sorted(names, key=lambda name: interface.variables[name].kind is not Kind.REAL)
