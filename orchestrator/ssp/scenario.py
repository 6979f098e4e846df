"""A system structure description as the tree of a scenario: what `orchestrator run` and `extends` take from an .ssp."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from orchestrator.errors import SspError
from orchestrator.fmi.description import read_interface
from orchestrator.master.slave import Interface, stem
from orchestrator.ssp.archive import Archive, every, first, opened
from orchestrator.ssp.joins import Ends, Joined, joins
from orchestrator.ssp.names import OSP_ANNOTATION, RESOURCES, SCENARIO_ANNOTATION, tag
from orchestrator.ssp.structure import Node, Structure, Wire, flattened
from orchestrator.ssp.values import Given, start_values
from orchestrator.ssp.ways import Way, alteration

Tree = dict[str, Any]


def read_system(path: Path, variant: str = "") -> Tree:
    """The scenario an .ssp describes, nothing checked yet but the file itself.

    Units, start values and connections are the standard's; the rest is our annotation's where there is one, else the scenario's defaults.
    """
    archive = opened(path, variant)
    structure = flattened(archive)
    own = _own_annotation(archive)
    interfaces = {path: read_interface(component.fmu) for path, component in structure.components.items()}
    wires = structure.wires()
    fed = {wire.target for wire in wires}
    values = {
        path: {name: _found(archive, value) for name, value in given.items() if (path, name) not in fed}     # the master finds those itself
        for path, given in start_values(archive, structure, interfaces).items()
    }  # fmt: skip
    tree: Tree = {"title": archive.description.get("name", ""), **_times(archive), **own}
    tree["units"] = _units(structure, values, own.get("units", {}))
    tree["connections"] = _connections(archive, structure, interfaces, wires, own.get("connections"))
    if not own:
        tree["master"] = _steps(archive)
    for table, key in (("results", "references"), ("terrain", "file")):
        beside = archive.folder / own.get(table, {}).get(key, "")
        if beside.is_file():
            tree[table] = own[table] | {key: str(beside)}
    return tree


def _found(archive: Archive, value: Given) -> Given:
    """A text that names a file of the archive is where that file now lies."""
    if isinstance(value, str) and value.startswith(f"{RESOURCES}/") and (archive.folder / value).is_file():
        return str(archive.folder / value)
    return value


def _own_annotation(archive: Archive) -> Tree:
    for annotation in every(archive.description, "ssd:Annotations", "ssc:Annotation"):
        if annotation.get("type") == SCENARIO_ANNOTATION:
            try:
                return tomllib.loads("".join(annotation.itertext()))
            except tomllib.TOMLDecodeError as error:
                raise SspError(f"{archive.where}: annotation {SCENARIO_ANNOTATION}: not valid TOML: {error}; correct it") from None
    return {}


def _times(archive: Archive) -> Tree:
    experiment = first(archive.description, "ssd:DefaultExperiment")
    stated = {} if experiment is None else {"start_time": experiment.get("startTime"), "stop_time": experiment.get("stopTime")}
    return {key: float(text) for key, text in stated.items() if text is not None}


def _steps(archive: Archive) -> Tree:
    """The fixed step another tool left for its own master is taken as the longest interval."""
    found = [
        float(algorithm.get("baseStepSize"))
        for annotation in every(archive.description, "ssd:DefaultExperiment", "ssd:Annotations", "ssc:Annotation")
        if annotation.get("type") == OSP_ANNOTATION
        for algorithm in annotation.iter(tag("osp:FixedStepAlgorithm"))
    ]
    return {} if not found else {"max_interval": found[0], "min_interval": min(found[0] / 100.0, 5e-5)}


def _units(structure: Structure, values: Mapping[str, Mapping[str, Given]], own: Mapping[str, Any]) -> Tree:
    """In the order of the document, which is that of stepping where the annotation gives none."""
    return {
        component.unit: {"fmu": str(component.fmu), "parameters": dict(values[path]), **own.get(component.unit, {})}
        for path, component in structure.components.items()
    }


def _connections(
    archive: Archive, structure: Structure, interfaces: Mapping[str, Interface], wires: list[Wire], own: list[Tree] | None
) -> list[Tree]:
    """Joined ports where all their links are there, and what is left, vectors in one line."""
    units = {path: component.unit for path, component in structure.components.items()}
    by_unit = {units[path]: interface for path, interface in interfaces.items()}
    left: dict[Ends, Way] = {}
    for wire in wires:
        ends = _label(units, wire.source), _label(units, wire.target)
        if ends in left:
            raise SspError(f"{archive.where}: {ends[0]} -> {ends[1]}: is connected twice; remove one connection")
        left[ends] = wire.way
    made: list[Joined] = joins(by_unit, left, archive.where, own)
    for joined in made:
        for ends in joined.ends:
            del left[ends]
    return [joined.table for joined in made] + list(_by_variable(left, by_unit))


def _label(units: Mapping[str, str], node: Node) -> str:
    return f"{units[node[0]]}.{node[1]}"


def _by_variable(left: Mapping[Ends, Way], interfaces: Mapping[str, Interface]) -> Iterator[Tree]:
    done: set[Ends] = set()
    for ends, way in left.items():
        if ends in done:
            continue
        vector = _whole_vector(ends, left, interfaces)
        done.update(vector or [ends])
        source, target = (_stem(end) for end in ends) if vector else ends
        one, other = (interfaces[end.partition(".")[0]].variables.get(end.partition(".")[2]) for end in ends)
        yield {"from": source, "to": target} | (alteration(way, one, other) if one and other else {})


def _whole_vector(ends: Ends, left: Mapping[Ends, Way], interfaces: Mapping[str, Interface]) -> list[Ends]:
    """All pairs of elements, where every element of one vector goes to the same of the other in the same way."""
    (unit, _, source), (other, _, target) = (end.partition(".") for end in ends)
    given, taken = (interfaces[u].vectors.get(stem(name), []) for u, name in ((unit, source), (other, target)))
    pairs = [(f"{unit}.{one.name}", f"{other}.{two.name}") for one, two in zip(given, taken, strict=False)]
    whole = len(given) == len(taken) > 1 and all(left.get(pair) == left[ends] for pair in pairs) and ends in pairs
    return pairs if whole else []


def _stem(end: str) -> str:
    unit, _, name = end.partition(".")
    return f"{unit}.{stem(name)}"
