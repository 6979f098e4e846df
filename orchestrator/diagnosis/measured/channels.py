"""Names of columns and of scalars, and the SI unit each is in."""

from __future__ import annotations

import re

from orchestrator.errors import MeasuredError, nearest

AXES = ("yaw", "pitch", "roll")
COLUMNS = {f"{axis}_rate": f"rates.{axis}" for axis in AXES} | {axis: f"attitude.{axis}" for axis in AXES}
"""Column of the file -> channel."""
CANONICAL = tuple(COLUMNS.values())
COMPLETE = {"rates": tuple(f"{axis}_rate" for axis in AXES), "attitude": AXES}
"""Series of these names hold these columns, unless their `columns` says which."""
TIMES = ("time_s", "time")
STRUTS = ("primary", "right", "left")
_VARIABLE = re.compile(r"[A-Za-z0-9_+\-]+\.[A-Za-z0-9_.\[\]+\-]+")
_SCALARS = {"stroke": "stroke.LEG.STRUT", "penetration": "penetration.LEG", "skid": "skid.LEG", "contact_time": "contact_time.LEG"}


def channel(column: str, where: str) -> str:
    """The channel that a column holds."""
    if column in COLUMNS:
        return COLUMNS[column]
    if column in CANONICAL or _VARIABLE.fullmatch(column):
        return column
    raise MeasuredError(f'{where}: column "{column}" is no channel; {nearest(column, COLUMNS)} (or unit.variable of an output)')


def si_unit(name: str) -> str:
    """The SI unit of a channel or scalar of the format; empty for a variable of a unit, which declares its own."""
    place, _, rest = name.partition(".")
    if place == "peak":
        return si_unit(rest)
    known = {"rates": "rad/s", "attitude": "rad", "stroke": "m", "penetration": "m", "skid": "m", "contact_time": "s"}
    return known.get(place, "") if place not in ("rates", "attitude") or name in CANONICAL else ""


def check_scalar(name: str, where: str) -> None:
    """Refuse a scalar's name that is of no form the format has."""
    place, dot, rest = name.partition(".")
    if place == "stroke":
        leg, _, strut = rest.rpartition(".")
        if not leg or strut not in STRUTS:
            raise MeasuredError(f'{where}: expects stroke.LEG.STRUT with a strut of {", ".join(STRUTS)}, e.g. "stroke.+Z.left"')
    elif place == "peak":
        if rest not in CANONICAL and not _VARIABLE.fullmatch(rest):
            raise MeasuredError(f'{where}: peak of no channel; {nearest(rest, CANONICAL)}')
    elif place in _SCALARS:
        if not rest or "." in rest:
            raise MeasuredError(f"{where}: expects {_SCALARS[place]}, e.g. \"{place}.+Y\"")
    elif not (dot and _VARIABLE.fullmatch(name)):
        raise MeasuredError(f"{where}: is no scalar; {nearest(name, [*_SCALARS.values(), 'peak.CHANNEL', 'unit.variable'])}")
