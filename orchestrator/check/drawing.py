"""Draws the contracts from the built FMUs: `python -m orchestrator.check.drawing build/fmus`.

An FMU of ours says in its modelDescription which kind it is and which variables one in its place must have; all its other inputs and
outputs are optional. Its reference experiment gives the inputs that units of its kind are tried with.
"""

from __future__ import annotations

import csv
import json
import sys
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from orchestrator.check.contract import FOLDER, Contract, Member, frame_in
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.structure import read_structure
from orchestrator.master.slave import Interface, Kind, Variable, stem

Knots = list[tuple[float, float]]
_REFERENCE = "documentation/reference.csv"
_COMPANIONS = {"output": ("_mean", "_slope"), "input": ("_slope", "_added")}


def drawn(fmus: Sequence[Path]) -> dict[str, Contract]:
    """One contract a kind; units of one kind are united, the first one's words count."""
    found: dict[str, Contract] = {}
    for path in fmus:
        interface, structure = read_interface(path), read_structure(path)
        if not structure.kind:
            continue
        members = _members(interface, structure.required)
        contract = Contract(structure.kind, interface.description, members, structure.step or 1e-3, structure.stop or 0.1,
                            _courses(path, interface))
        found[structure.kind] = _united(found.get(structure.kind), contract)
    return found


def _members(interface: Interface, required: Sequence[str]) -> tuple[Member, ...]:
    names = [name for name, elements in interface.vectors.items() if elements[0].causality in ("input", "output")]
    return tuple(_member(interface, name, interface.vectors[name], name in required) for name in names)


def _member(interface: Interface, name: str, elements: Sequence[Variable], required: bool) -> Member:
    first = elements[0]
    companion = any(
        name.endswith(suffix) and bool(interface.elements(name.removesuffix(suffix), first.causality))
        for suffix in _COMPANIONS[first.causality]
    )
    size = 0 if stem(first.name) == first.name else len(elements)
    return Member(name, first.causality, first.kind, size, first.unit, first.dimension, first.nominal, frame_in(first.description),
                  required, companion, first.description)


def _courses(path: Path, interface: Interface) -> dict[str, Knots]:
    with zipfile.ZipFile(path) as archive:
        lines = archive.read(_REFERENCE).decode().splitlines() if _REFERENCE in archive.namelist() else []
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    inputs = [variable for variable in interface.of("input") if rows and variable.name in rows[0]]
    return {v.name: thinned([(float(row["time"]), float(row[v.name])) for row in rows], v.kind is Kind.REAL) for v in inputs}


def thinned(points: Knots, straight: bool) -> Knots:
    """Without the points that lie on the straight line between those kept, or that repeat the value held."""
    kept = points[:1]
    for before, point, after in zip(points, points[1:], points[2:], strict=False):
        expected = kept[-1][1]
        if straight:
            expected = before[1] + (after[1] - before[1]) * (point[0] - before[0]) / (after[0] - before[0])
        if abs(point[1] - expected) > 1e-9 * max(abs(before[1]), abs(after[1]), 1e-300):
            kept.append(point)
    last = points[-1]
    return [*kept, last] if straight and last[1] != kept[-1][1] else kept


def _united(first: Contract | None, second: Contract) -> Contract:
    if first is None:
        return second
    names = {member.name for member in first.members}
    more = tuple(member for member in second.members if member.name not in names)
    return Contract(first.kind, first.about, first.members + more, first.step, first.stop, {**second.inputs, **first.inputs})


def text_of(contract: Contract) -> str:
    """The file: a line a member."""
    units = {member.unit: member.dimension for member in contract.members if member.unit and member.dimension is not None}
    lines = [
        f"# What a unit must be to stand in for {contract.kind}. Drawn from the built FMU: python -m orchestrator.check.drawing build/fmus",
        f"kind = {json.dumps(contract.kind)}",
        f"about = {json.dumps(contract.about)}",
        "",
        "[units]   # exponents of kg m s A K mol cd rad, then factor and offset to SI",
        *(f"{json.dumps(name)} = {json.dumps(powers)}" for name, powers in sorted(units.items())),
        "",
        "[experiment]   # s; the inputs that units of this kind are tried with, others stay at their start values",
        f"step = {contract.step!r}",
        f"stop = {contract.stop!r}",
        "",
        "[experiment.inputs]   # knots [time, value]: reals run straight between them, others are held",
        *(f"{json.dumps(name)} = {json.dumps(knots)}" for name, knots in contract.inputs.items()),
        "",
        "[members]   # without `required`: optional; without `size`: a scalar",
        *(f"{json.dumps(member.name)} = {{ {', '.join(_attributes(member))} }}" for member in contract.members),
    ]
    return "\n".join(lines) + "\n"


def _attributes(member: Member) -> list[str]:
    stated: Mapping[str, object] = {
        "causality": member.causality,
        **({"kind": str(member.kind)} if member.kind is not Kind.REAL else {}),
        **({"size": member.size} if member.size else {}),
        **({"unit": member.unit} if member.unit else {}),
        **({"nominal": member.nominal} if member.nominal != 1.0 else {}),
        **({"frame": member.frame} if member.frame else {}),
        **({"required": True} if member.required else {}),
        **({"companion": True} if member.companion else {}),
        "description": member.description,
    }
    return [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in stated.items()]


def write(fmus: Path) -> None:
    """All contracts, anew."""
    for kind, contract in drawn(sorted(fmus.glob("*.fmu"))).items():
        (FOLDER / f"{kind}.toml").write_text(text_of(contract), "utf-8")
        print(f"{FOLDER / kind}.toml: {len(contract.members)} variables, {len(contract.required)} required")


if __name__ == "__main__":
    write(Path(sys.argv[1]))
