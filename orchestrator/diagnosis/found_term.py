"""A term found outside the library, as a library's entry: next time it is a candidate like any other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import tomli_w

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.effects.effect import ConnectionTable, Effect, Insert
from orchestrator.diagnosis.effects.library import load_effect
from orchestrator.diagnosis.moves import Named
from orchestrator.diagnosis.outcome import Estimate
from orchestrator.master.slave import Value


@dataclass(frozen=True)
class FoundTerm:
    """coefficient × basis at a port. `name` becomes a file's name."""

    name: str
    title: str
    physics: str
    equation: str
    port: Literal["soil.normal", "soil.tangential", "soil.shape", "strut", "body", "engine", "sensor", "initial"]
    energy: Literal["dissipative", "conservative", "active", "none"]
    coefficient: str
    """Its address: soil.normal_term, soil.tangent_term, gear.strut_term, body_term.coefficient, ..."""
    estimate: Estimate
    fixed: Mapping[str, Value | list[Value]] = field(default_factory=dict)
    """Addresses of exponents, phase, axis, basis."""
    insert: Insert | None = None
    parameter: str = "coefficient"

    def table(self) -> dict[str, Any]:
        """The library's entry."""
        value, sigma = self.estimate.value, self.estimate.sigma
        one_sided = value > 0.0 and self.energy == "dissipative"
        prior = {"shape": "half-normal" if one_sided else "normal", "sigma": max(abs(value), sigma)}
        entry: dict[str, Any] = {
            "title": self.title,
            "physics": self.physics,
            "equation": self.equation,
            "port": self.port,
            "kind": "sensor" if self.port == "sensor" else "force",
            "energy": self.energy,
            "parameters": [
                {
                    "name": self.parameter,
                    "unit": self.estimate.unit,
                    "target": [self.coefficient],
                    "operation": "add",
                    "null": 0.0,
                    "prior": prior,
                    "starts": [0.5 * value, value],
                }
            ],
        }
        if self.fixed:
            entry["fixed"] = dict(self.fixed)
        if self.insert is not None:
            entry["insert"] = self.insert.model_dump(by_alias=True, exclude_none=True)
        return entry

    def effect(self) -> Effect:
        effect = Effect.model_validate(self.table())
        effect._name = self.name
        return effect

    def named(self) -> Named:
        """As `write_revision` takes it."""
        return Named(self.effect(), {self.parameter: self.estimate})


def write_effect(folder: Path, term: FoundTerm) -> Path:
    """NAME.toml, read back once to be sure that the library takes it."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{term.name}.toml"
    head = f"# Found by a diagnosis: {term.coefficient} = {term.estimate.value:.6g} ± {term.estimate.sigma:.3g} {term.estimate.unit}\n"
    path.write_text(head + tomli_w.dumps(term.table()), encoding="utf-8")
    load_effect(path)
    return path


def body_term_insert(addresses: Addresses) -> Insert:
    """The unit that a term on the body is: fed with the body's motion, and with the thrust where there is an engine."""
    connections = [ConnectionTable(ports=["body.body", "body_term.body"]), ConnectionTable(ports=["body_term.effect", "body.effect4"])]
    if addresses.units("guidance"):
        connections.append(ConnectionTable.model_validate({"from": "guidance.engine.thrust", "to": "body_term.engine.thrust"}))
    return Insert(unit="body_term", fmu="BodyTerm", connections=connections)
