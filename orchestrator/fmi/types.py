"""The types of FMI 2.0 and 3.0: which kind of variable each is to the master, how C holds it, and which calls move it."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from typing import Any, NamedTuple

from orchestrator.master.slave import Kind


class FmiType(NamedTuple):
    kind: Kind
    c_type: Any
    calls: str
    """What follows `fmi2Get`, `fmi3Set` ..."""


FMI2: Mapping[str, FmiType] = {
    "Real": FmiType(Kind.REAL, ctypes.c_double, "Real"),
    "Integer": FmiType(Kind.INTEGER, ctypes.c_int, "Integer"),
    "Enumeration": FmiType(Kind.INTEGER, ctypes.c_int, "Integer"),
    "Boolean": FmiType(Kind.BOOLEAN, ctypes.c_int, "Boolean"),
    "String": FmiType(Kind.STRING, ctypes.c_char_p, "String"),
}
FMI3: Mapping[str, FmiType] = {
    "Float64": FmiType(Kind.REAL, ctypes.c_double, "Float64"),
    "Float32": FmiType(Kind.REAL, ctypes.c_float, "Float32"),
    "Int8": FmiType(Kind.INTEGER, ctypes.c_int8, "Int8"),
    "UInt8": FmiType(Kind.INTEGER, ctypes.c_uint8, "UInt8"),
    "Int16": FmiType(Kind.INTEGER, ctypes.c_int16, "Int16"),
    "UInt16": FmiType(Kind.INTEGER, ctypes.c_uint16, "UInt16"),
    "Int32": FmiType(Kind.INTEGER, ctypes.c_int32, "Int32"),
    "UInt32": FmiType(Kind.INTEGER, ctypes.c_uint32, "UInt32"),
    "Int64": FmiType(Kind.INTEGER, ctypes.c_int64, "Int64"),
    "UInt64": FmiType(Kind.INTEGER, ctypes.c_uint64, "UInt64"),
    "Enumeration": FmiType(Kind.INTEGER, ctypes.c_int64, "Int64"),
    "Boolean": FmiType(Kind.BOOLEAN, ctypes.c_bool, "Boolean"),
    "String": FmiType(Kind.STRING, ctypes.c_char_p, "String"),
    "Binary": FmiType(Kind.BINARY, None, ""),
    "Clock": FmiType(Kind.CLOCK, None, ""),
}


def types_of(fmi_version: str) -> Mapping[str, FmiType]:
    return FMI3 if fmi_version.startswith("3") else FMI2


def integer_range(c_type: Any) -> tuple[int, int]:
    """Least and greatest value of a C integer."""
    bits = 8 * ctypes.sizeof(c_type)
    signed = c_type(-1).value < 0
    return (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
