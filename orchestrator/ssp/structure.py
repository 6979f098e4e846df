"""A description's system, nested ones flattened: components, and which output reaches which input by way of which transformation."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lxml import etree

from orchestrator.errors import SspError, nearest
from orchestrator.ssp.archive import Archive, every, first
from orchestrator.ssp.names import FMU_TYPE, tag
from orchestrator.ssp.ways import PLAIN, Way

Node = tuple[str, str]
"""Path of an element ("" the root system, "vehicle.leg1"), name of a connector."""
_FORBIDDEN = re.compile(r"[^A-Za-z0-9_+\-]")


@dataclass(frozen=True)
class Component:
    path: str
    unit: str
    """Its path as a unit's name."""
    fmu: Path
    connectors: dict[str, str]
    """Name -> kind."""


@dataclass(frozen=True)
class Wire:
    """From an output of a component, or a connector of a system, to an input of a component."""

    source: Node
    target: Node
    way: Way = PLAIN


@dataclass
class Structure:
    components: dict[str, Component] = field(default_factory=dict)
    """By path, in the order of the document."""
    systems: dict[str, dict[str, str]] = field(default_factory=dict)
    """Connectors of each system by its path."""
    parameterised: list[tuple[str, Any]] = field(default_factory=list)
    """Path and element of what may have parameter bindings, the outermost last."""
    edges: dict[Node, list[tuple[Node, Way]]] = field(default_factory=dict)
    """Each ssd:Connection, from both of its ends."""

    def wires(self) -> list[Wire]:
        """Every output followed to the inputs it reaches."""
        return [
            wire for path, component in self.components.items() for name, kind in component.connectors.items() if kind == "output"
            for wire in self._reached((path, name))
        ]  # fmt: skip

    def taken_by(self, node: Node) -> list[Wire]:
        """What a system's own connector leads to inside."""
        return list(self._reached(node))

    def _reached(self, source: Node) -> Iterator[Wire]:
        front, seen = [Wire(source, source)], {source}
        while front:
            here = front.pop(0)
            for end, way in self.edges.get(here.target, ()):
                if end in seen:
                    continue
                seen.add(end)
                wire = Wire(source, end, here.way.then(way))
                owner = self.components.get(end[0])
                if owner is None:
                    front.append(wire)
                elif owner.connectors[end[1]] in ("input", "parameter"):
                    yield wire


def flattened(archive: Archive) -> Structure:
    """The system of a description with every system inside it."""
    structure = Structure()
    _system(archive, first(archive.description, "ssd:System"), "", structure)
    if not structure.components:
        raise SspError(f"{archive.where}: has no component; nothing could be run")
    names = [component.unit for component in structure.components.values()]
    for component in structure.components.values():
        if names.count(component.unit) > 1:
            raise SspError(f'{archive.where}: {component.path}: its name as a unit, "{component.unit}", is not the only one; rename it')
    return structure


def _system(archive: Archive, system: Any, path: str, structure: Structure) -> None:
    structure.systems[path] = _connectors(system)
    if first(system, "ssd:SignalDictionaries") is not None or every(system, "ssd:Elements", "ssd:SignalDictionaryReference"):
        raise SspError(f"{archive.where}: {path or 'system'}: uses a signal dictionary; connect the components themselves")
    elements = first(system, "ssd:Elements")
    for element in () if elements is None else elements:
        inner = f"{path}.{element.get('name')}" if path else element.get("name")
        if element.tag == tag("ssd:System"):
            _system(archive, element, inner, structure)
        elif element.tag == tag("ssd:Component"):
            structure.components[inner] = _component(archive, element, inner)
            structure.parameterised.append((inner, element))
        else:
            raise SspError(f"{archive.where}: {inner}: is a {etree.QName(element).localname}, expects components and systems; leave it out")
    structure.parameterised.append((path, system))
    for connection in every(system, "ssd:Connections", "ssd:Connection"):
        _connection(archive, connection, path, structure)


def _connectors(element: Any) -> dict[str, str]:
    return {connector.get("name"): connector.get("kind") for connector in every(element, "ssd:Connectors", "ssd:Connector")}


def _component(archive: Archive, element: Any, path: str) -> Component:
    kind, source = element.get("type", FMU_TYPE), element.get("source", "")
    if kind != FMU_TYPE or source.startswith("#"):
        raise SspError(f'{archive.where}: {path}: is "{kind}" from "{source}", this reader takes FMUs; put the system itself in its place')
    if element.get("implementation", "any") not in ("any", "CoSimulation"):
        raise SspError(f"{archive.where}: {path}: asks for {element.get('implementation')}, this master steps CoSimulation; change it")
    return Component(path, _FORBIDDEN.sub("_", path), archive.file(source, path), _connectors(element))


def _connection(archive: Archive, connection: Any, path: str, structure: Structure) -> None:
    ends = [_end(archive, connection, side, path, structure) for side in ("start", "end")]
    kinds = [_kind(structure, node) for node in ends]
    if "inout" in kinds or "calculatedParameter" in kinds:
        label = " -> ".join(".".join(node) for node in ends)
        raise SspError(f"{archive.where}: {label}: connects {' and '.join(kinds)}, this master connects outputs to inputs; remove it")
    as_is = connection.get("suppressUnitConversion", "false") in ("true", "1")
    way = Way(*_transformation(archive, connection), as_is)
    for one, other in (ends, ends[::-1]):
        structure.edges.setdefault(one, []).append((other, way))


def _end(archive: Archive, connection: Any, side: str, path: str, structure: Structure) -> Node:
    element, name = connection.get(f"{side}Element"), connection.get(f"{side}Connector")
    owner = path if not element else f"{path}.{element}" if path else element
    component = structure.components.get(owner)
    known = structure.systems.get(owner) if component is None else component.connectors
    if known is None:
        inside = [p.rpartition(".")[2] for p in (*structure.components, *structure.systems) if p and p.rpartition(".")[0] == path]
        raise SspError(f'{archive.where}: connection of {owner}.{name}: no element "{element}"; {nearest(str(element), inside)}')
    if name not in known:
        raise SspError(f'{archive.where}: connection of {owner}.{name}: no connector "{name}" there; {nearest(name, known)}')
    return owner, name


def _kind(structure: Structure, node: Node) -> str:
    component = structure.components.get(node[0])
    return (structure.systems[node[0]] if component is None else component.connectors)[node[1]]


def _transformation(archive: Archive, connection: Any) -> tuple[float, float]:
    for child in connection:
        kind = etree.QName(child).localname
        if kind.endswith("MappingTransformation"):
            label = f"{connection.get('startElement')}.{connection.get('startConnector')}"
            raise SspError(f"{archive.where}: connection of {label}: has a {kind}, this reader knows linear ones; do it in a unit")
    return linear(first(connection, "ssc:LinearTransformation"))


def linear(element: Any) -> tuple[float, float]:
    """Factor and offset of a linear transformation, or of none."""
    return (1.0, 0.0) if element is None else (float(element.get("factor", 1.0)), float(element.get("offset", 0.0)))
