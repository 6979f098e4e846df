"""What an FMU says beyond its variables: on what outputs depend, its default experiment, the kind of unit it was made as."""

from __future__ import annotations

import zipfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from fmpy import read_model_description

from orchestrator.master.slave import stem

Dependencies = dict[str, frozenset[str] | None]
"""Output → inputs and parameters it depends on; None: it does not say, so on everything."""


@dataclass(frozen=True)
class Structure:
    outputs: Dependencies
    """At a communication point."""
    initially: Dependencies
    step: float | None = None
    stop: float | None = None
    kind: str = ""
    """Of port contract, where the FMU says so."""
    required: tuple[str, ...] = field(default=())


def known_of(stated: Dependencies, output: str) -> frozenset[str] | None:
    """What an output is stated to depend on. FMI 3 names an array where the master has its elements."""
    return stated[output] if output in stated else stated.get(stem(output))


def read_structure(path: Path) -> Structure:
    """Of an FMU that `read_interface` has read."""
    description: Any = read_model_description(str(path), validate=False)
    experiment = description.defaultExperiment
    with zipfile.ZipFile(path) as archive:
        contract = ElementTree.fromstring(archive.read("modelDescription.xml")).find(".//PortContract")
    return Structure(
        outputs=_dependencies(description.outputs),
        initially=_dependencies(description.initialUnknowns),
        step=_number(experiment, "stepSize"),
        stop=_number(experiment, "stopTime"),
        kind="" if contract is None else contract.get("kind", ""),
        required=() if contract is None else tuple(contract.get("required", "").split()),
    )


def _dependencies(unknowns: Any) -> Dependencies:
    return {
        one.variable.name: None if one.dependencies is None else frozenset(known.name for known in one.dependencies) for one in unknowns
    }


def _number(experiment: Any, name: str) -> float | None:
    value = getattr(experiment, name, None)
    return None if value is None else float(value)
