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
        Bound(unit, name, limit, below=key == "below", alone=key == "beyond")
        for key, limits in (("below", table.below), ("above", table.above), ("beyond", table.beyond))
        for pattern, limit in limits.items()
        for unit, names in enumerate(matching_outputs([pattern], interfaces, f"{where}.{key}"))
        for name in names
    ] if table is not None else []
