"""A scenario as a job for any master: an .ssp, and its units, start values and connections by name, value reference and type."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from packs import ROOT

from orchestrator.master.slave import Kind
from orchestrator.simulation import Blueprint
from orchestrator.ssp.export import export_blueprint, solved_values

FOLDER = ROOT / "build" / "benchmarks" / "ssp"


def task_of(blueprint: Blueprint, watch: Sequence[str]) -> dict[str, Any]:
    """`watch` names outputs as "unit.variable"."""
    values = solved_values(blueprint)
    ssp = FOLDER / f"{blueprint.scenario.where}.ssp"
    export_blueprint(blueprint, ssp, watch)
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
        "ssp": str(ssp),
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
