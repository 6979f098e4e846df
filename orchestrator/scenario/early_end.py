"""`[until]`: which outputs an early end waits for."""

from __future__ import annotations

from collections.abc import Mapping

from orchestrator.master.slave import Interface
from orchestrator.master.until import Bound
from orchestrator.scenario.model import UntilTable
from orchestrator.scenario.record import matching_outputs


def bounds_of(table: UntilTable | None, interfaces: Mapping[str, Interface], where: str) -> list[Bound]:
    """One for each output that a glob matches."""
    return [
        Bound(unit, name, limit, below)
        for below, limits in ((True, table.below), (False, table.above))
        for pattern, limit in limits.items()
        for unit, names in enumerate(matching_outputs([pattern], interfaces, f"{where}.{'below' if below else 'above'}"))
        for name in names
    ] if table is not None else []
