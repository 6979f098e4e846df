"""What the master asks of a unit. An FMU behind its wrapper keeps this protocol, and so does a handful of Python functions in a test."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from functools import cached_property
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Value = float | int | bool | str
_INDEX = re.compile(r"\[\d+(?:, ?\d+)*\]$")


class Kind(StrEnum):
    REAL = "Real"
    INTEGER = "Integer"
    BOOLEAN = "Boolean"
    STRING = "String"
    BINARY = "Binary"
    """Bytes and clocks of FMI 3.0: seen, neither set nor connected nor recorded."""
    CLOCK = "Clock"


class Status(IntEnum):
    """As FMI 2.0 numbers them."""

    OK = 0
    WARNING = 1
    DISCARD = 2
    ERROR = 3
    FATAL = 4


@dataclass(frozen=True)
class Variable:
    name: str
    kind: Kind = Kind.REAL
    causality: str = "local"
    unit: str = ""
    dimension: tuple[float, ...] | None = None
    """Exponents of kg m s A K mol cd rad, then factor and offset to SI; None where the unit is not defined."""
    start: str | None = None
    minimum: float | None = None
    maximum: float | None = None
    nominal: float = 1.0
    description: str = ""
    reference: int = 0
    type: str = "Real"
    """As the FMU's version of FMI calls it: "Real", "Float32", "Enumeration" ..."""
    element: int = 0
    """An array of FMI 3.0 appears as its elements name[1], name[2] ... by rows; this one's place in it, from 0."""
    size: int = 1
    """How many elements the array has."""
    items: Mapping[str, int] = field(default_factory=dict)
    """Of an enumeration: name -> value."""


@dataclass(frozen=True)
class Interface:
    """What a unit says of itself."""

    model_name: str
    variables: Mapping[str, Variable]
    capabilities: Mapping[str, bool] = field(default_factory=dict)
    guid: str = ""
    fmi_version: str = ""
    generation_tool: str = ""
    description: str = ""
    path: Path | None = None
    sha256: str = ""

    def of(self, causality: str) -> list[Variable]:
        return [v for v in self.variables.values() if v.causality == causality]

    @cached_property
    def vectors(self) -> dict[str, list[Variable]]:
        """Stem ("body.position") -> its elements in order; a scalar is a vector of one."""
        grouped: dict[str, list[Variable]] = {}
        for variable in self.variables.values():
            grouped.setdefault(stem(variable.name), []).append(variable)
        return grouped

    @cached_property
    def ports(self) -> dict[str, list[str]]:
        """Port -> stems of its coupled members (inputs and outputs)."""
        found: dict[str, list[str]] = {}
        for name, elements in self.vectors.items():
            port, dot, _ = name.rpartition(".")
            if dot and elements[0].causality in ("input", "output"):
                found.setdefault(port, []).append(name)
        return found

    def elements(self, name: str, causality: str) -> list[Variable]:
        """The elements of a vector, or the single variable, if it has this causality; else nothing."""
        found = self.vectors.get(name) or ([self.variables[name]] if name in self.variables else [])
        return [v for v in found if v.causality == causality]

    def claims(self, capability: str) -> bool:
        return bool(self.capabilities.get(capability, False))


def stem(name: str) -> str:
    """Name of the vector an element belongs to: "pad.force[3]" -> "pad.force"."""
    return _INDEX.sub("", name)


@dataclass(frozen=True)
class Binding:
    """Which variables travel, where. Real variables stand first in `inputs` and in `outputs`."""

    inputs: Sequence[str]
    rates: Sequence[str]
    """Inputs whose time derivative is set by the standard FMI call; their values follow the inputs in `u`."""
    outputs: Sequence[str]
    coupled: int
    """The first `coupled` real outputs are fetched after every step, the other reals only by `observe`."""
    u: Vector
    """Inputs then rates; the master writes it before a step."""
    y: Vector
    """Outputs; the unit writes it."""


class Slave(Protocol):
    """A unit under a master. Times in s. Only `step` moves its time."""

    @property
    def name(self) -> str: ...
    @property
    def interface(self) -> Interface: ...

    steps: int
    """Calls of `step` so far."""
    seconds: float
    """Wall time spent inside so far, s."""
    reached: float | None
    """After a refused step: the time up to which the unit says it did step, s; None where it does not say."""

    @property
    def messages(self) -> list[str]:
        """What the unit logged, oldest first."""

    def bind(self, binding: Binding) -> None: ...

    def set_up(self, start: float, stop: float, values: Mapping[str, Value]) -> None:
        """(Again) new, with these start values, in initialisation mode."""

    def exchange(self) -> None:
        """In initialisation mode: take `u`, give `y`."""

    def begin(self) -> None:
        """Leave initialisation mode, having taken `u`; give all of `y`."""

    def step(self, time: float, interval: float) -> Status:
        """Take `u`, step, give the coupled part of `y`."""

    def observe(self) -> None:
        """Give the part of `y` that is only recorded."""

    def save(self) -> None:
        """Keep the present state in the one slot."""

    def restore(self) -> None:
        """Return to the kept state, as often as wished."""

    def close(self) -> None: ...
