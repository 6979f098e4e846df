"""Values of a scenario -> start values of a unit's variables, each checked against what the unit declares."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from orchestrator.errors import UnitError, nearest
from orchestrator.master.slave import Interface, Kind, Value, Variable
from orchestrator.scenario.record import NUMBERS

SETTABLE = ("parameter", "structuralParameter", "input")
_EXPECTED = {Kind.REAL: "a number", Kind.INTEGER: "a whole number", Kind.BOOLEAN: "true or false", Kind.STRING: "a string"}


def start_values(unit: str, interface: Interface, parameters: Mapping[str, Any]) -> dict[str, Value]:
    """Variable name -> value. An input that nothing feeds may be given a constant the same way."""
    values: dict[str, Value] = {}
    for name, given in parameters.items():
        elements = _elements(unit, interface, name)
        flat = _flatten(given) if isinstance(given, list) else [given]
        if len(flat) != len(elements):
            raise UnitError(f"{unit}.{name}: gives {_count(flat)}, expects {len(elements)}; give one for each of {elements[0].name} ...")
        for variable, value in zip(elements, flat, strict=True):
            values[variable.name] = checked(unit, variable, value)
    return values


def numbers(unit: str, interface: Interface, given: Mapping[str, Value]) -> dict[str, float]:
    """`unit.parameter` -> the number it runs with: as given, else the unit's start value. Of a text, whether there is any; no bytes."""
    known: dict[str, float] = {}
    for variable in interface.of("parameter"):
        value = given.get(variable.name, variable.start)
        if variable.kind is Kind.STRING:
            known[f"{unit}.{variable.name}"] = float(bool(value))
        elif variable.kind in NUMBERS and value is not None:
            known[f"{unit}.{variable.name}"] = float(value == "true") if value in ("true", "false") else float(value)
    return known


def settable_stems(interface: Interface) -> list[str]:
    return [name for name, elements in interface.vectors.items() if elements[0].causality in SETTABLE]


def checked(unit: str, variable: Variable, value: Any) -> Value:
    """The value, if the variable can hold it."""
    what = f"{unit}.{variable.name} = {value!r}"
    if variable.kind not in _EXPECTED:
        raise UnitError(f"{what}: is of type {variable.kind}, which this master does not set; leave it out")
    if variable.items and isinstance(value, str):
        if value not in variable.items:
            raise UnitError(f"{what}: is none of its values; {nearest(value, variable.items)}")
        value = variable.items[value]
    if variable.causality == "structuralParameter" and str(value) != variable.start:
        raise UnitError(f"{what}: a structural parameter stays at its start value {variable.start}; leave it out")
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    fits = {
        Kind.REAL: number,
        Kind.INTEGER: number and float(value).is_integer() if number and math.isfinite(value) else False,
        Kind.BOOLEAN: isinstance(value, bool),
        Kind.STRING: isinstance(value, str),
    }[variable.kind]
    if not fits:
        raise UnitError(f"{what}: expects {_EXPECTED[variable.kind]}{_in_unit(variable)}")
    if number:
        if math.isnan(value):
            raise UnitError(f"{what}: is not a number, expects a value{_in_unit(variable)}; correct it")
        if variable.minimum is not None and value < variable.minimum:
            raise UnitError(f"{what}: is below its minimum {variable.minimum:g}{_unit(variable)}; give {_range(variable)}")
        if variable.maximum is not None and value > variable.maximum:
            raise UnitError(f"{what}: is above its maximum {variable.maximum:g}{_unit(variable)}; give {_range(variable)}")
    return float(value) if variable.kind is Kind.REAL else value


def _elements(unit: str, interface: Interface, name: str) -> list[Variable]:
    found = [v for causality in SETTABLE for v in interface.elements(name, causality)]
    if found:
        return found
    other = interface.vectors.get(name)
    if other:
        raise UnitError(f"{unit}.{name}: is {_article(other[0].causality)}, expects a parameter or an input; set one of those")
    raise UnitError(f"{unit}.{name}: unknown parameter; {nearest(name, settable_stems(interface))}")


def _flatten(given: list[Any]) -> list[Any]:
    """Matrices by rows."""
    return [x for row in given for x in (_flatten(row) if isinstance(row, list) else [row])]


def _count(flat: list[Any]) -> str:
    return "1 value" if len(flat) == 1 else f"{len(flat)} values"


def _article(causality: str) -> str:
    return f"an {causality}" if causality[0] in "aeiou" else f"a {causality}"


def _unit(variable: Variable) -> str:
    return f" {variable.unit}" if variable.unit and variable.unit != "1" else ""


def _in_unit(variable: Variable) -> str:
    return f" in {variable.unit}" if variable.unit and variable.unit != "1" else ""


def _range(variable: Variable) -> str:
    low = "" if variable.minimum is None else f" from {variable.minimum:g}"
    high = "" if variable.maximum is None else f" up to {variable.maximum:g}"
    return f"a value{low}{high}"
