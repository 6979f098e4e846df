"""What is coupled to what, by name: the master's input. Checked links only; reading and checking a scenario happens elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from orchestrator.master.slave import Slave


class Scheme(StrEnum):
    """How a connection is coupled. The first three may be asked for; else the master chooses by what the units can do."""

    PASSES = "fixed-point"
    """Both units repeated over the interval, the later passes with what the earlier ones gave."""
    NEWTON = "quasi-newton"
    """Both repeated until what they exchange at the end of the interval agrees; inputs run linearly over it."""
    EXPLICIT = "explicit"
    """Both ways with values held at the start of the interval."""
    MODEL = "reduced interface model"
    ONE_WAY = "one way"


@dataclass(frozen=True)
class Link:
    """One output element to one input element. Units by their place in the system's list."""

    source_unit: int
    source: str
    target_unit: int
    target: str
    slope: bool = True
    """Whether a slope travels with a mean."""
    scheme: Scheme | None = None
    """As asked for."""


@dataclass(frozen=True)
class PortPair:
    """Two joined ports, e.g. leg+Z.pad with soil+Z.pad."""

    first_unit: int
    first_port: str
    second_unit: int
    second_port: str


@dataclass(frozen=True)
class System:
    """Units in the order in which they are stepped, and their connections."""

    slaves: Sequence[Slave]
    links: Sequence[Link]
    pairs: Sequence[PortPair] = ()
    once: frozenset[str] = frozenset()
    """Units stepped once per accepted step by request."""
    recorded: Sequence[Sequence[str]] = field(default_factory=list)
    """Per unit, the outputs to record."""
    watched: Sequence[Sequence[str]] = field(default_factory=list)
    """Per unit, further outputs to fetch, e.g. those a start condition needs."""
    located: Sequence[Sequence[str]] = field(default_factory=list)
    """Per unit, the Boolean and Integer outputs just after whose changes a step must end."""

    def label(self, unit: int, port: str) -> str:
        return f"{self.slaves[unit].name}.{port}" if port else self.slaves[unit].name
