"""How each connection is coupled, chosen by what its two units can do (docs/decisions/0005-quasi-newton.md).

    a side cannot be repeated, or it was asked for           explicit
    one side offers a reduced interface model                 reduced interface model
    nothing travels that a second pass would find changed     quasi-newton: a loop of links whose sources give no mean
    passes were seen not to contract, or it was asked for     quasi-newton
    otherwise                                                 fixed-point (passes)
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from orchestrator.errors import UnitError
from orchestrator.master.plan import Plan, companion
from orchestrator.master.result import ConnectionRecord
from orchestrator.master.roles import repeated_units, strongly_connected
from orchestrator.master.slave import Kind
from orchestrator.master.system import Link, Scheme, System

UnitPair = frozenset[int]
MODEL = ".model_"


@dataclass(frozen=True)
class Coupling:
    """Who is repeated, which links run linearly to an assumed end, and which blocks they make."""

    repeated: list[bool]
    in_loop: list[bool]
    """Units that stand in a loop, whether or not it can be repeated."""
    held: frozenset[Link]
    """Links that carry their value at the start: explicit ones, and the lines (whose slopes a block adds)."""
    lines: frozenset[Link]
    blocks: list[list[int]]
    """Units solved together, in the order that leaves the fewest values to assume."""
    explicit: frozenset[UnitPair]
    needs_passes: bool
    """Whether a loop is left that the blocks do not solve."""


def couple(plan: Plan, able: Sequence[bool], switched: Collection[UnitPair] = ()) -> Coupling:
    """`able`: may be repeated. `switched`: pairs of units whose passes do not contract."""
    system = plan.system
    count = len(system.slaves)
    asked_explicit = {link for link in system.links if link.scheme is Scheme.EXPLICIT}
    repeated = repeated_units(count, [link for link in system.links if link not in asked_explicit], able)
    candidates = [link for link in system.links if _may_be_line(plan, link, repeated, switched)]
    groups = [group for group in strongly_connected(count, candidates) if len(group) > 1]
    lines = [link for link in candidates if any(link.source_unit in g and link.target_unit in g for g in groups)]
    blocks = [_ordered(sorted(group), lines) for group in groups]
    block_of = {unit: -1 - number for number, block in enumerate(blocks) for unit in block}
    in_loop = repeated_units(count, system.links, [True] * count)
    explicit = {pair_of(link) for link in asked_explicit}
    explicit |= {pair_of(k) for k in system.links if in_loop[k.source_unit] and in_loop[k.target_unit] and not _both(k, repeated)}
    return Coupling(
        repeated,
        in_loop,
        frozenset([*asked_explicit, *lines]),
        frozenset(lines),
        blocks,
        frozenset(pair for pair in explicit if _goes_both_ways(system, pair)),
        _loop_left(count, [k for k in system.links if k not in asked_explicit and _both(k, repeated)], block_of),
    )


def pair_of(link: Link) -> UnitPair:
    return frozenset((link.source_unit, link.target_unit))


def check_asked(plan: Plan) -> None:
    """A scheme asked for where a reduced interface model is spoken cannot be given."""
    system = plan.system
    modelled = {frozenset((port.owner, port.partner)): port.label for port in plan.reduced}
    for link in system.links:
        label = modelled.get(pair_of(link))
        if link.scheme is not None and label is not None:
            raise UnitError(f'{label}: scheme "{link.scheme}" cannot replace the reduced interface model spoken there; leave scheme out')


def connection_records(plan: Plan, coupling: Coupling, passes: int) -> list[ConnectionRecord]:
    """One row a joined pair of ports, one for each other pair of linked units."""
    system = plan.system
    named = {
        frozenset((p.first_unit, p.second_unit)): (system.label(p.first_unit, p.first_port), system.label(p.second_unit, p.second_port))
        for p in system.pairs
    }
    rows: dict[UnitPair, ConnectionRecord] = {}
    for units in [*named, *(pair_of(link) for link in system.links)]:
        if units not in rows and len(units) == 2:
            first, second = named.get(units) or tuple(system.slaves[unit].name for unit in sorted(units))
            scheme = scheme_of(plan, coupling, units)
            rows[units] = ConnectionRecord(first, second, scheme, _detail(plan, coupling, units, scheme, passes))
    return list(rows.values())


def _detail(plan: Plan, coupling: Coupling, units: UnitPair, scheme: Scheme, passes: int) -> str:
    """What else there is to know of it."""
    names = [plan.system.slaves[unit].name for unit in sorted(units) if not coupling.repeated[unit]]
    asked = {link.scheme for link in plan.system.links if pair_of(link) == units} - {None, scheme}
    if asked:
        return f"{asked.pop()} was asked for, but {' and '.join(names) or 'no loop'} is stepped once per accepted step"
    if scheme in (Scheme.PASSES, Scheme.MODEL):
        return f"{passes} passes" if passes > 1 and not names else "1 pass"
    return "values held at the start of the interval" if scheme is Scheme.EXPLICIT else ""


def scheme_of(plan: Plan, coupling: Coupling, units: UnitPair) -> Scheme:
    lines = [link for link in coupling.lines if pair_of(link) == units]
    if lines:
        return Scheme.PASSES if all(link.scheme is Scheme.PASSES for link in lines) else Scheme.NEWTON
    if any(frozenset((port.owner, port.partner)) == units for port in plan.reduced):
        return Scheme.MODEL
    if units in coupling.explicit:
        return Scheme.EXPLICIT
    if all(coupling.repeated[unit] for unit in units):
        return Scheme.PASSES
    return Scheme.ONE_WAY


def _may_be_line(plan: Plan, link: Link, repeated: Sequence[bool], switched: Collection[UnitPair]) -> bool:
    system = plan.system
    variable = system.slaves[link.source_unit].interface.variables[link.source]
    if not _both(link, repeated) or variable.kind is not Kind.REAL or link.scheme is Scheme.EXPLICIT:
        return False
    if any(pair_of(link) == {port.owner, port.partner} for port in plan.reduced) or _speaks_model(plan, link):
        return False
    return _gives_no_mean(plan, link) or link.scheme is Scheme.NEWTON or (link.scheme is None and pair_of(link) in switched)


def _speaks_model(plan: Plan, link: Link) -> bool:
    """Whether one of the two tells the other how its effort answers (`model_*`): Newton's step is then taken inside that unit."""
    return any(MODEL in other.target for other in plan.system.links if pair_of(other) == pair_of(link))


def _gives_no_mean(plan: Plan, link: Link) -> bool:
    """Whether nothing goes from this source to this target that a second pass would find changed."""
    ends = link.source_unit, link.target_unit
    alongside = [other for other in plan.system.links if (other.source_unit, other.target_unit) == ends]
    return not any((other.source_unit, companion(other.source, "_mean")) in plan.board.place for other in alongside)


def _both(link: Link, repeated: Sequence[bool]) -> bool:
    return repeated[link.source_unit] and repeated[link.target_unit]


def _goes_both_ways(system: System, pair: UnitPair) -> bool:
    return len({link.source_unit for link in system.links if pair_of(link) == pair}) == 2


def _ordered(group: list[int], lines: Sequence[Link]) -> list[int]:
    """As given or reversed, whichever leaves fewer sources to assume."""

    def assumed(order: list[int]) -> int:
        rank = {unit: at for at, unit in enumerate(order)}
        inner = [k for k in lines if k.source_unit in rank and k.target_unit in rank]
        return len({(k.source_unit, k.source) for k in inner if rank[k.source_unit] >= rank[k.target_unit]})

    return min((group, group[::-1]), key=assumed)


def _loop_left(count: int, links: Sequence[Link], block_of: dict[int, int]) -> bool:
    """Whether units, each block counted as one, still stand in a loop."""
    number = {unit: count + block for unit, block in ((u, -b - 1) for u, b in block_of.items())}
    merged = [(number.get(k.source_unit, k.source_unit), number.get(k.target_unit, k.target_unit)) for k in links]
    joined = [Link(a, "", b, "") for a, b in merged if a != b]
    size = count + len(set(block_of.values()))
    return any(repeated_units(size, joined, [True] * size))
