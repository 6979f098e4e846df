"""A scenario as a job for any master: its units, start values and connections by name, value reference and type."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from orchestrator.master.slave import Kind, Value
from orchestrator.simulation import Blueprint


def task_of(blueprint: Blueprint, values: Sequence[dict[str, Value]], watch: Sequence[str]) -> dict[str, Any]:
    """`values` are the start values by unit; `watch` names outputs as "unit.variable"."""
    names = list(blueprint.interfaces)
    faces = list(blueprint.interfaces.values())

    def end(unit: int, name: str) -> list[Any]:
        variable = faces[unit].variables[name]
        return [names[unit], name, variable.reference, variable.kind.value]

    start = [
        [*end(unit, name), value if faces[unit].variables[name].kind is not Kind.STRING else str(value)]
        for unit, given in enumerate(values)
        for name, value in given.items()
    ]
    watched = [next((u, w.removeprefix(f"{n}.")) for u, n in enumerate(names) if w.startswith(f"{n}.")) for w in watch]
    return {
        "units": [{"name": name, "fmu": str(face.path)} for name, face in zip(names, faces, strict=True)],
        "start": start,
        "links": [[*end(link.source_unit, link.source), *end(link.target_unit, link.target)] for link in blueprint.links],
        "bonds": [],
        "watch": [end(unit, name)[:3] for unit, name in watched],
        "stop": blueprint.scenario.table.stop_time,
        "step": 1e-4,
        "tolerance": 0.0,
        "method": "fixed",
    }
