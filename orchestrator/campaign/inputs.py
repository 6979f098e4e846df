"""A row of inputs -> what `--set` takes."""

from __future__ import annotations

import fnmatch
from collections.abc import Mapping, Sequence

import tomli_w

from orchestrator.blueprint import Blueprint
from orchestrator.errors import ScenarioError, UnitError, nearest
from orchestrator.master.slave import Interface
from orchestrator.scenario.model import Scalar
from orchestrator.scenario.parameters import SETTABLE, settable_stems

EVERY = "[*]"


def overrides(addresses: Mapping[str, Sequence[str]], row: Mapping[str, Scalar]) -> list[str]:
    """unit.parameter=value for every address of every input; a number is written so that it is read back to the bit."""
    return [f"{address}={_as_toml(row[name])}" for name, its in addresses.items() for address in its]


def _as_toml(value: Scalar) -> str:
    return tomli_w.dumps({"v": value}).partition("=")[2].strip()


def resolved(address: str, drawn: Blueprint, where: str) -> list[str]:
    """The address, checked against the units; `[*]` said out element by element."""
    pattern, dot, parameter = address.partition(".")
    if not (dot and parameter):
        raise ScenarioError(f'{where}: "{address}": expects unit.parameter, e.g. "soil*.friction"')
    names = [name for name in drawn.interfaces if fnmatch.fnmatchcase(name, pattern)]
    if not names:
        raise ScenarioError(f'{where}: "{address}": no unit "{pattern}"; {nearest(pattern, drawn.interfaces)}')
    stem = parameter.removesuffix(EVERY)
    counts = {_elements(drawn.interfaces[name], stem) for name in names}
    if 0 in counts:
        raise UnitError(f'{where}: "{address}": no parameter "{stem}"; {nearest(stem, settable_stems(drawn.interfaces[names[0]]))}')
    if not parameter.endswith(EVERY):
        if max(counts) > 1:
            raise UnitError(f'{where}: "{address}": has {max(counts)} elements; name one, {stem}[1], or all, {stem}{EVERY}')
        return [address]
    return [f"{pattern}.{stem}[{i + 1}]" for i in range(min(counts))]


def _elements(interface: Interface, name: str) -> int:
    return max(len(interface.elements(name, causality)) for causality in SETTABLE)
