"""`unit.variable`, `unit.vector`, `unit.vector[3]`, `unit.vector[1:3]`, `unit.vector[3,1,2]`, several with commas between -> variables."""

from __future__ import annotations

import re
from collections.abc import Mapping

from orchestrator.errors import WiringError, nearest
from orchestrator.master.slave import Interface, Variable

_BETWEEN = re.compile(r",(?![^\[]*\])")
_CHOSEN = re.compile(r"(.+)\[([\d:, ]+)\]")


class Selection:
    """`where` opens its messages."""

    def __init__(self, interfaces: Mapping[str, Interface], where: str) -> None:
        self._interfaces = interfaces
        self._where = where

    def port(self, text: str) -> tuple[str, str]:
        unit, name = self._unit(text)
        ports = self._interfaces[unit].ports
        if name not in ports:
            raise WiringError(f'{self._where}: {text}: unit {unit} has no port "{name}"; {nearest(name, ports)}')
        return unit, name

    def variables(self, text: str, causality: str) -> tuple[str, list[Variable]]:
        """One unit, and its variables in the order asked for."""
        found: list[Variable] = []
        units: dict[str, None] = {}
        for part in _BETWEEN.split(text):
            unit, some = self._variables(part.strip(), causality)
            units[unit] = None
            found += some
        if len(units) > 1:
            raise WiringError(f"{self._where}: {text}: names variables of {' and '.join(units)}; make a connection for each unit")
        return next(iter(units)), found

    def _variables(self, text: str, causality: str) -> tuple[str, list[Variable]]:
        unit, name = self._unit(text)
        interface = self._interfaces[unit]
        chosen = None if name in interface.variables else _CHOSEN.fullmatch(name)
        if chosen is not None and chosen[1] in interface.vectors:
            elements = self._whole(text, unit, chosen[1], causality)
            return unit, [self._element(text, elements, number) for number in self._numbers(text, chosen[2])]
        return unit, self._whole(text, unit, name, causality)

    def _numbers(self, text: str, chosen: str) -> list[int]:
        """"1:3" or "3,1,2" -> the places, from 1."""
        places: list[int] = []
        for part in chosen.replace(" ", "").split(","):
            first, colon, last = part.partition(":")
            if not first or (colon and (not last or ":" in last or int(last) < int(first))):
                raise WiringError(f"{self._where}: {text}: [{chosen}] names no elements; give e.g. [2], [1:3] or [3,1,2]")
            places += range(int(first), int(last or first) + 1)
        return places

    def _element(self, text: str, elements: list[Variable], number: int) -> Variable:
        if not 1 <= number <= len(elements):
            raise WiringError(f"{self._where}: {text}: asks for element {number} of {len(elements)}; give 1 to {len(elements)}")
        return elements[number - 1]

    def _whole(self, text: str, unit: str, name: str, causality: str) -> list[Variable]:
        interface = self._interfaces[unit]
        found = interface.elements(name, causality)
        if found:
            return found
        other = interface.vectors.get(name) or ([interface.variables[name]] if name in interface.variables else None)
        if other:
            raise WiringError(f"{self._where}: {text}: is of causality {other[0].causality}, expects {causality}; exchange from and to?")
        stems = [s for s, elements in interface.vectors.items() if elements[0].causality == causality]
        raise WiringError(f'{self._where}: {text}: unit {unit} has no {causality} "{name}"; {nearest(name, stems)}')

    def _unit(self, text: str) -> tuple[str, str]:
        unit, dot, rest = text.partition(".")
        if unit not in self._interfaces:
            raise WiringError(f'{self._where}: {text}: no unit "{unit}"; {nearest(unit, self._interfaces)}')
        if not (dot and rest):
            raise WiringError(f"{self._where}: {text}: expects unit.port or unit.variable; {nearest('', self._interfaces[unit].ports)}")
        return unit, rest
