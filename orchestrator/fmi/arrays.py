"""C arrays laid over the master's vectors once, so that a step moves numbers without building anything.

Doubles that stand in the vector as FMI moves them are moved in place. Everything else (other types, arrays of which only some elements
are connected) goes through a `Block` with an array of its own.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from orchestrator.errors import StepError
from orchestrator.fmi.texts import number_of, text_of
from orchestrator.fmi.types import FmiType, integer_range
from orchestrator.master.slave import Kind, Value, Variable, Vector

_DOUBLES = ctypes.POINTER(ctypes.c_double)
_SHOWN = 3
Entry = tuple[int, Variable]
"""A variable and its place in the master's vector."""


class Call(NamedTuple):
    """A C function, its arguments, and what to call it in a message."""

    what: str
    function: Callable[..., int]
    arguments: tuple[Any, ...]


class Access(NamedTuple):
    """One get or set function of one instance."""

    unit: str
    what: str
    function: Callable[..., int]
    component: Any
    counted: bool
    """Whether it is also told the number of values, as in FMI 3.0."""

    def call(self, variables: Iterable[Variable], values: Any, count: int) -> Call:
        unique = list({v.reference: v for v in variables}.values())
        shown = ", ".join(v.name for v in unique[:_SHOWN]) + (", ..." if len(unique) > _SHOWN else "")
        arguments = (self.component, references(unique), len(unique), values)
        return Call(f"{self.what} of {shown}", self.function, (*arguments, count) if self.counted else arguments)


def references(variables: Sequence[Variable]) -> Any:
    return (ctypes.c_uint * len(variables))(*[v.reference for v in variables])


def pointer(vector: Vector, offset: int) -> Any:
    return ctypes.cast(vector.ctypes.data + 8 * offset, _DOUBLES)


def in_place(entries: Sequence[Entry], fmi_type: FmiType) -> bool:
    """Whether these stand in the vector as FMI moves them: doubles side by side, arrays whole and in order, no variable twice."""
    expected = 0
    if len({(v.reference, v.element) for _, v in entries}) < len(entries):
        return False
    for (place, variable), (before, _) in zip(entries, [(entries[0][0] - 1, None), *entries], strict=False):
        if place != before + 1 or variable.element != expected:
            return False
        expected = (expected + 1) % variable.size
    return expected == 0 and fmi_type.c_type is ctypes.c_double


class Block:
    """Variables of one type moved through an array of that type. `arrays`: reference -> all elements it stands for."""

    def __init__(
        self, access: Access, fmi_type: FmiType, entries: Sequence[Entry], arrays: Mapping[int, Sequence[Variable]], vector: Vector
    ) -> None:
        variables = [variable for _, variable in entries]
        self._all = [element for reference in dict.fromkeys(v.reference for v in variables) for element in arrays[reference]]
        at = {(v.reference, v.element): place for place, v in enumerate(self._all)}
        self._values = (fmi_type.c_type * len(self._all))()
        self._vector, self._type = vector, fmi_type
        self._places = np.array([place for place, _ in entries], dtype=np.intp)
        self._inside = np.array([at[v.reference, v.element] for v in variables], dtype=np.intp)
        self._variables, self._unit = variables, access.unit
        self._text = fmi_type.kind is Kind.STRING
        self._range = integer_range(fmi_type.c_type) if fmi_type.kind is Kind.INTEGER else None
        if not self._text:
            self._view = np.frombuffer(self._values, dtype=np.dtype(fmi_type.c_type))
        self.call = access.call(variables, self._values, len(self._all))

    def start(self, given: Mapping[str, Value]) -> None:
        """Elements that nothing feeds keep their start value."""
        fill(self._values, self._all, self._type, given)

    def load(self) -> None:
        """Master's vector -> C array."""
        sent = self._vector[self._places]
        if self._text:
            for inside, number in zip(self._inside.tolist(), sent.tolist(), strict=True):
                self._values[inside] = text_of(number).encode()
            return
        if self._range is not None and not (self._range[0] <= sent.min() and sent.max() <= self._range[1]):
            worst = int(np.abs(sent).argmax())
            variable = self._variables[worst]
            takes = f"{variable.type} takes {self._range[0]} to {self._range[1]}"
            raise StepError(f"{self._unit}: {variable.name} is sent {sent[worst]:.0f}, {takes}; connect a variable that stays within")
        self._view[self._inside] = sent

    def unload(self) -> None:
        """C array -> master's vector."""
        if self._text:
            texts = [(self._values[inside] or b"").decode("utf-8", "replace") for inside in self._inside.tolist()]
            self._vector[self._places] = [number_of(text) for text in texts]
        else:
            self._vector[self._places] = self._view[self._inside]


def fill(values: Any, variables: Sequence[Variable], fmi_type: FmiType, given: Mapping[str, Value]) -> None:
    """A C array of these variables: the value given, else the start value, else zero."""
    for at, variable in enumerate(variables):
        value = given.get(variable.name, variable.start)
        if fmi_type.kind is Kind.STRING:
            values[at] = str(value or "").encode()
        elif isinstance(value, str) and fmi_type.kind is Kind.BOOLEAN:
            values[at] = value in ("true", "1")
        else:
            values[at] = (float if fmi_type.kind is Kind.REAL else int)(value or 0)
