"""The port contract of one kind of unit, as data: contracts/KIND.toml, drawn from our own built FMU (drawing.py)."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from orchestrator.errors import UserError, nearest
from orchestrator.master.slave import Kind

FOLDER = Path(__file__).with_name("contracts")
_FRAME = re.compile(r"\bframe ([A-Z])\b|\b(\w+ to [A-Z])\b")


@dataclass(frozen=True)
class Member:
    """A variable of the contract, scalar or vector."""

    name: str
    causality: str
    kind: Kind = Kind.REAL
    size: int = 0
    """Elements of a vector, name[1] ...; 0: a scalar, without index."""
    unit: str = ""
    dimension: tuple[float, ...] | None = None
    nominal: float = 1.0
    frame: str = ""
    required: bool = False
    companion: bool = False
    """A mean, a slope or an added socket of another member."""
    description: str = ""

    @property
    def elements(self) -> list[str]:
        return [f"{self.name}[{i}]" for i in range(1, self.size + 1)] if self.size else [self.name]

    @property
    def is_model(self) -> bool:
        """Whether it belongs to a reduced interface model, which a unit may offer or leave."""
        last = self.name.rpartition(".")[2]
        return last.startswith(("model_", "predicted_", "mismatch_", "reference_", "contact_stiffness", "contact_damping"))


@dataclass(frozen=True)
class Contract:
    kind: str
    about: str
    members: tuple[Member, ...]
    step: float = 1e-3
    """s; of the experiment a unit of this kind is tried with."""
    stop: float = 0.1
    inputs: Mapping[str, list[tuple[float, float]]] = field(default_factory=dict)
    """Element → knots (time, value) of its course; reals run straight between them, others are held."""

    @property
    def required(self) -> list[Member]:
        return [member for member in self.members if member.required]


def kinds() -> list[str]:
    return sorted(file.stem for file in FOLDER.glob("*.toml"))


def contract_of(kind: str) -> Contract:
    """The contract of a kind, or a UserError that names those there are."""
    known = {name.lower(): name for name in kinds()}
    if kind.lower() not in known:
        raise UserError(f"--as {kind}: no such kind of unit; {nearest(kind, known.values())}")
    return contract_in(tomllib.loads((FOLDER / f"{known[kind.lower()]}.toml").read_text("utf-8")))


def contract_in(tree: Mapping[str, Any]) -> Contract:
    """From the file's tree."""
    dimensions = {name: tuple(float(x) for x in powers) for name, powers in tree["units"].items()}
    members = [_member(name, about, dimensions) for name, about in tree["members"].items()]
    experiment = tree["experiment"]
    courses = {name: [(float(t), float(x)) for t, x in knots] for name, knots in experiment["inputs"].items()}
    return Contract(tree["kind"], tree["about"], tuple(members), experiment["step"], experiment["stop"], courses)


def _member(name: str, about: Mapping[str, Any], dimensions: Mapping[str, tuple[float, ...]]) -> Member:
    unit = about.get("unit", "")
    rest = {key: value for key, value in about.items() if key not in ("kind", "unit")}
    return Member(name=name, kind=Kind(about.get("kind", "Real")), unit=unit, dimension=dimensions.get(unit), **rest)


def frame_in(description: str) -> str:
    """The frame a description states: "of the origin of B, frame L" → "L"; "pad to L" → "pad to L"."""
    found = _FRAME.search(description)
    return (found[1] or found[2]) if found else ""
