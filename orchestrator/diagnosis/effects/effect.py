"""An effect's file, key by key."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, model_validator

from orchestrator.master.slave import Value

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Text = Annotated[str, Field(min_length=1)]
Shape = Literal["normal", "half-normal"]


class Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)


class PriorTable(Table):
    shape: Shape
    """half-normal: p ≥ null."""
    sigma: Positive
    """In the parameter's unit; about the null value."""


class Parameter(Table):
    name: Text
    unit: str
    """Of p itself; "1" for a scale, whose p is the logarithm of the factor."""
    target: Annotated[list[Text], Field(min_length=1)]
    """Addresses; several move together. A minus in front takes p away: "-guidance.thrust_offset[1]"."""
    operation: Literal["add", "scale", "set"] = "add"
    """add: base + p; scale: base exp(p); set: p, for what the base scenario does not have."""
    null: Finite = 0.0
    prior: PriorTable
    starts: Annotated[list[Finite], Field(min_length=1)]
    limits: Annotated[list[float], Field(min_length=2, max_length=2)] = [-math.inf, math.inf]

    @model_validator(mode="after")
    def _inside(self) -> Parameter:
        low, high = self.limits
        if not low < high:
            raise ValueError(f"limits {low:g} and {high:g} leave nothing; give the lower one first")
        if not low <= self.null <= high:
            raise ValueError(f"null {self.null:g} is beyond the limits {low:g} to {high:g}; widen them")
        for start in self.starts:
            if not low <= start <= high:
                raise ValueError(f"start {start:g} is beyond the limits {low:g} to {high:g}; move it inside")
            if self.prior.shape == "half-normal" and start < self.null:
                raise ValueError(f"start {start:g} is below the null {self.null:g}, where a half-normal prior has nothing; move it")
        if self.operation == "scale" and self.null != 0.0:
            raise ValueError(f"null {self.null:g} of a scale is the logarithm of a factor, expects 0; correct it")
        return self

    def signed_targets(self) -> list[tuple[float, str]]:
        """(+1 or -1, address) of each target."""
        return [(-1.0 if text.startswith("-") else 1.0, text.removeprefix("-")) for text in self.target]


class ConnectionTable(Table):
    """Either two `ports`, or `from` one variable `to` another; units by place (guidance, body, ...) or name."""

    ports: Annotated[list[Text], Field(min_length=2, max_length=2)] | None = None
    source: Text | None = Field(default=None, alias="from")
    target: Text | None = Field(default=None, alias="to")

    @model_validator(mode="after")
    def _one_of_two_forms(self) -> ConnectionTable:
        by_variable = self.source is not None and self.target is not None
        if (self.ports is None) == (not by_variable) or (self.ports is not None and (self.source or self.target)):
            raise ValueError("give either ports = [a, b] or both from and to")
        return self


class Insert(Table):
    unit: Text
    """Its name in the co-simulation, a place of decision 9 or any other."""
    fmu: Text
    parameters: dict[str, Any] = {}
    """Fixed: what kind of term it is, when a pulse begins."""
    connections: list[ConnectionTable] = []


class Effect(Table):
    title: Text
    physics: Text
    """One sentence."""
    equation: Text
    port: Literal["soil.normal", "soil.tangential", "soil.shape", "strut", "body", "engine", "sensor", "initial"]
    kind: Literal["force", "parameter", "initial", "sensor"]
    energy: Literal["dissipative", "conservative", "active", "none"]
    twins: list[str] = []
    """Effects known to look alike; never used in a verdict, only in words."""
    parameters: Annotated[list[Parameter], Field(min_length=1)]
    fixed: dict[str, Value | list[Value]] = {}
    """Address -> value that goes with the effect and is not fitted: which term, when a pulse begins."""
    insert: Insert | None = None
    _name: str = PrivateAttr(default="")

    @model_validator(mode="after")
    def _named_once(self) -> Effect:
        names = [it.name for it in self.parameters]
        twice = [name for name in names if names.count(name) > 1]
        if twice:
            raise ValueError(f'parameter "{twice[0]}" is there {names.count(twice[0])} times; rename one')
        lengths = {it.name: len(it.starts) for it in self.parameters}
        if len(set(lengths.values())) > 1:
            counts = ", ".join(f"{name} {count}" for name, count in lengths.items())
            raise ValueError(f"starts are taken together, one of each parameter, but there are {counts}; give as many of each")
        return self

    @property
    def name(self) -> str:
        """That of its file."""
        return self._name

    @property
    def starts(self) -> list[dict[str, float]]:
        """The k-th start of every parameter together."""
        return [{it.name: it.starts[k] for it in self.parameters} for k in range(len(self.parameters[0].starts))]


def known_keys(path: tuple[int | str, ...]) -> list[str]:
    """Keys allowed in the table at this path of an effect's file."""
    match path:
        case ():
            return list(Effect.model_fields)
        case ("parameters", _):
            return list(Parameter.model_fields)
        case ("parameters", _, "prior"):
            return list(PriorTable.model_fields)
        case ("insert",):
            return list(Insert.model_fields)
        case ("insert", "connections", _):
            return ["ports", "from", "to"]
    return []
