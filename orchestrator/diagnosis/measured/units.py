"""Units of measure of the data format, and what they are in SI. Few enough for a table."""

from __future__ import annotations

import math
from typing import NamedTuple

from orchestrator.errors import MeasuredError, nearest

_POUND_FORCE = 4.4482216152605  # N, exact
_POUND = 0.45359237  # kg, exact
_FOOT = 0.3048  # m, exact
_DEGREE = math.pi / 180.0


class Measure(NamedTuple):
    """A unit of measure: `factor` of them make one `si`."""

    si: str
    factor: float


UNITS = {
    "1": Measure("1", 1.0), "": Measure("1", 1.0), "%": Measure("1", 0.01),
    "s": Measure("s", 1.0), "ms": Measure("s", 1e-3),
    "rad": Measure("rad", 1.0), "mrad": Measure("rad", 1e-3), "deg": Measure("rad", _DEGREE),
    "rad/s": Measure("rad/s", 1.0), "deg/s": Measure("rad/s", _DEGREE),
    "rad/s2": Measure("rad/s2", 1.0), "deg/s2": Measure("rad/s2", _DEGREE),
    "m": Measure("m", 1.0), "cm": Measure("m", 0.01), "mm": Measure("m", 1e-3), "in": Measure("m", _FOOT / 12.0), "ft": Measure("m", _FOOT),
    "m/s": Measure("m/s", 1.0), "cm/s": Measure("m/s", 0.01), "in/s": Measure("m/s", _FOOT / 12.0), "ft/s": Measure("m/s", _FOOT),
    "m/s2": Measure("m/s2", 1.0), "ft/s2": Measure("m/s2", _FOOT),
    "N": Measure("N", 1.0), "kN": Measure("N", 1e3), "lbf": Measure("N", _POUND_FORCE),
    "N.m": Measure("N.m", 1.0), "lbf.ft": Measure("N.m", _POUND_FORCE * _FOOT),
    "N/m": Measure("N/m", 1.0), "lbf/in": Measure("N/m", 12.0 * _POUND_FORCE / _FOOT), "lbf/ft": Measure("N/m", _POUND_FORCE / _FOOT),
    "N.s/m": Measure("N.s/m", 1.0), "N.s2/m2": Measure("N.s2/m2", 1.0), "s/m": Measure("s/m", 1.0),
    "kg": Measure("kg", 1.0), "lb": Measure("kg", _POUND), "slug": Measure("kg", _POUND_FORCE / _FOOT),
    "kg.m2": Measure("kg.m2", 1.0), "slug.ft2": Measure("kg.m2", _POUND_FORCE * _FOOT),
    "J": Measure("J", 1.0),
}  # fmt: skip


def measure(unit: str, where: str, expects: str = "") -> Measure:
    """The unit of that name; `expects` is the SI unit that it must be a multiple of, empty for any."""
    found = UNITS.get(unit)
    if found is None:
        raise MeasuredError(f'{where}: unit "{unit}" is not known; {nearest(unit, _shown(expects))}')
    if expects and found.si != expects:
        raise MeasuredError(f"{where}: is in {unit}, expects {expects} or a multiple of it; give one of {', '.join(_shown(expects))}")
    return found


def _shown(expects: str) -> list[str]:
    return [name for name, it in UNITS.items() if name and (not expects or it.si == expects)]
