"""C arrays laid over the master's vectors once, so that a step moves numbers without building anything."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from orchestrator.master.slave import Kind, Value, Variable, Vector

_DOUBLES = ctypes.POINTER(ctypes.c_double)


class Call(NamedTuple):
    """A C function, its arguments, and what to call it in a message."""

    what: str
    function: Callable[..., int]
    arguments: tuple[Any, ...]


def references(variables: Sequence[Variable]) -> Any:
    return (ctypes.c_uint * len(variables))(*[v.reference for v in variables])


def pointer(vector: Vector, offset: int) -> Any:
    return ctypes.cast(vector.ctypes.data + 8 * offset, _DOUBLES)


def real_call(what: str, function: Any, component: Any, variables: Sequence[Variable], vector: Vector, offset: int) -> list[Call]:
    """One call that moves consecutive reals; none where there are none."""
    if not variables:
        return []
    return [Call(what, function, (component, references(variables), len(variables), pointer(vector, offset)))]


class DiscreteBlock:
    """Integer or Boolean variables of a vector, which FMI moves as C ints."""

    def __init__(self, kind: Kind, function: Any, component: Any, variables: Sequence[Variable], vector: Vector) -> None:
        chosen = [(place, v) for place, v in enumerate(variables) if v.kind is kind]
        self._vector = vector
        self._places = [place for place, _ in chosen]
        self._values = (ctypes.c_int * len(chosen))()
        block = references([v for _, v in chosen])
        self.call = Call(f"exchange of {kind} variables", function, (component, block, len(chosen), self._values))
        self.empty = not chosen

    def load(self) -> None:
        """Master's vector -> C ints."""
        for i, place in enumerate(self._places):
            self._values[i] = int(self._vector[place])

    def unload(self) -> None:
        """C ints -> master's vector."""
        for place, value in zip(self._places, self._values, strict=True):
            self._vector[place] = value


def single_value(dll: Any, component: Any, variable: Variable, value: Value) -> Call:
    """Sets one start value."""
    functions: dict[Kind, tuple[Any, Any, Callable[[Value], Any]]] = {
        Kind.REAL: (dll.fmi2SetReal, ctypes.c_double, float),
        Kind.INTEGER: (dll.fmi2SetInteger, ctypes.c_int, int),
        Kind.BOOLEAN: (dll.fmi2SetBoolean, ctypes.c_int, int),
        Kind.STRING: (dll.fmi2SetString, ctypes.c_char_p, lambda text: str(text).encode()),
    }
    function, c_type, convert = functions[variable.kind]
    return Call(f"set {variable.name} = {value}", function, (component, references([variable]), 1, (c_type * 1)(convert(value))))
