"""Units of measure by their base-unit exponents, factor and offset, as SSP and FMI both state them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from lxml import etree

from orchestrator.master.slave import Variable
from orchestrator.ssp.names import tag

Dimension = tuple[float, ...]
"""Exponents of kg m s A K mol cd rad, then factor and offset to SI."""
_EXPONENTS = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


def units_of(root: Any) -> dict[str, Dimension]:
    """The units a document lists."""
    lists = [child for child in root if etree.QName(child).localname == "Units"]
    found = {}
    for unit in (unit for all_of in lists for unit in all_of.findall(tag("ssc:Unit"))):
        base = unit.find(tag("ssc:BaseUnit"))
        exponents = tuple(float(base.get(name, 0)) for name in _EXPONENTS)
        found[unit.get("name")] = (*exponents, float(base.get("factor", 1.0)), float(base.get("offset", 0.0)))
    return found


def write_units(parent: Any, variables: Iterable[Variable]) -> None:
    """ssd:Units with all that these variables are measured in and that is defined."""
    known = {v.unit: v.dimension for v in variables if stated(v)}
    if not known:
        return
    units = etree.SubElement(parent, tag("ssd:Units"))
    for name in sorted(known):
        dimension = known[name] or ()
        unit = etree.SubElement(units, tag("ssc:Unit"), name=name)
        attributes = {base: f"{exponent:g}" for base, exponent in zip(_EXPONENTS, dimension, strict=False) if exponent}
        factor, offset = dimension[8:]
        attributes |= ({"factor": repr(factor)} if factor != 1.0 else {}) | ({"offset": repr(offset)} if offset else {})
        etree.SubElement(unit, tag("ssc:BaseUnit"), attributes)


def stated(variable: Variable) -> bool:
    """Whether the variable's unit is one the file can define."""
    return bool(variable.unit) and variable.dimension is not None

