"""What happens to a number between two connectors: nothing, the standard's linear transformation, or that instead of a unit conversion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from orchestrator.errors import SspError
from orchestrator.master.converter import Derived
from orchestrator.master.slave import Variable
from orchestrator.master.system import Link
from orchestrator.scenario.conversion import unit_conversion


class Way(NamedTuple):
    """target = factor·source + offset; `as_is`: with no unit conversion besides."""

    factor: float = 1.0
    offset: float = 0.0
    as_is: bool = False

    def then(self, other: Way) -> Way:
        return Way(self.factor * other.factor, self.offset * other.factor + other.offset, self.as_is or other.as_is)


PLAIN = Way()


def way_of(derived: Sequence[Derived], link: Link, label: str) -> tuple[str, Way]:
    """The source variable of a link and its way; unit conversions are in the factor, since few hosts do any themselves."""
    it = next((it for it in derived if it.variable.name == link.source), None)
    if it is None:
        return link.source, PLAIN
    if len(it.sources) != 1:
        raise SspError(f"{label}: adds up {', '.join(it.sources)} (a frame), which SSP has no words for; turn it in a unit")
    return it.sources[0], Way(it.weights[0], it.offset, True)


def alteration(way: Way, one: Variable, other: Variable) -> dict[str, Any]:
    """The same as keys of a scenario's connection, whose scale and offset come after the unit conversion."""
    factor, offset, as_is = way
    if as_is:
        unit_factor, unit_offset = unit_conversion(one, other) or (1.0, 0.0)
        factor /= unit_factor
        offset -= factor * unit_offset
    return ({"scale": factor} if factor != 1.0 else {}) | ({"offset": offset} if offset else {})
