"""What a unit is driven with: an input for every instant, from the contract or, without one, small waves round the start values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, sin

from orchestrator.check.contract import Contract
from orchestrator.fmi.structure import Structure
from orchestrator.master.slave import Interface, Kind, Variable

MOST_STEPS = 50
_WAVE = 0.01
"""Of an input's nominal value."""
_LIMIT = 1e12
"""Nobody means a larger step or stop time."""


@dataclass(frozen=True)
class Course:
    step: float
    """s; at most this long."""
    stop: float
    knots: Mapping[str, Sequence[tuple[float, float]]]
    """Element → (time, value); a wave where it is empty."""

    @property
    def count(self) -> int:
        return max(1, round(self.stop / self.step))


def course_of(interface: Interface, structure: Structure, contract: Contract | None) -> Course:
    """The contract's experiment; its length in steps that the unit itself names, at most MOST_STEPS of them."""
    stop = contract.stop if contract else _sensible(structure.stop, 1.0)
    step = _sensible(structure.step, contract.step if contract else min(1e-2, stop / 20))
    step = min(step, stop / 4)
    knots = {v.name: list(contract.inputs.get(v.name, [])) if contract else [] for v in interface.of("input") if v.kind is not Kind.STRING}
    if contract:
        knots = {name: course for name, course in knots.items() if course}
    return Course(step, step * min(MOST_STEPS, max(4, round(stop / step))), knots)


def _sensible(value: float | None, otherwise: float) -> float:
    return value if value is not None and isfinite(value) and 0.0 < value < _LIMIT else otherwise


def start_of(variable: Variable) -> float:
    """The start value as a number; 0 where none is stated."""
    text = (variable.start or "0").strip().lower()
    try:
        return {"true": 1.0, "false": 0.0}.get(text, float("nan")) if text in ("true", "false") else float(text.split()[0])
    except (ValueError, IndexError):
        return 0.0


def value_at(course: Course, variable: Variable, time: float) -> float:
    """An input's value; a real one runs straight between knots, any other is held."""
    knots = course.knots.get(variable.name)
    if knots is None:
        return start_of(variable)
    if not knots:
        return start_of(variable) + (_WAVE * abs(variable.nominal) * sin(7.0 * time) if variable.kind is Kind.REAL else 0.0)
    return _between(knots, time, variable.kind is Kind.REAL)


def _between(knots: Sequence[tuple[float, float]], time: float, straight: bool) -> float:
    before = knots[0]
    for knot in knots:
        if knot[0] > time + 1e-12:
            if not straight or time <= before[0]:
                return before[1]
            return before[1] + (knot[1] - before[1]) * (time - before[0]) / (knot[0] - before[0])
        before = knot
    return before[1]
