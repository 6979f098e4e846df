"""A checked system with its start values -> a system structure description of SSP 1.0."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from importlib import metadata
from typing import Any

import tomli_w
from lxml import etree

from orchestrator.blueprint import Blueprint
from orchestrator.master.slave import Interface, Kind, Value, Variable
from orchestrator.master.system import Link
from orchestrator.results.provenance import DISTRIBUTION
from orchestrator.ssp.names import FMU_TYPE, NAMESPACES, OSP_ANNOTATION, SCENARIO_ANNOTATION, SCENARIO_NAMESPACE, tag
from orchestrator.ssp.units import stated, write_units
from orchestrator.ssp.ways import PLAIN, Way, way_of

START = "start"
"""Name of every component's parameter set: hosts that choose one by name take them all with it."""


def description(
    name: str, blueprint: Blueprint, values: Sequence[Mapping[str, Value]], sources: Sequence[str], outputs: Sequence[Sequence[str]],
    annotation: Mapping[str, Any], step: float,
) -> Any:
    """The root element.

    values: start values, sources: the FMU inside the archive, outputs: what is a connector though nothing is connected there; each by unit.
    step: s, for hosts with a fixed step.
    """
    about = {"version": "1.0", "name": name, "generationTool": f"{DISTRIBUTION} {_version()}"}
    root = etree.Element(tag("ssd:SystemStructureDescription"), about, nsmap=NAMESPACES)
    system = etree.SubElement(root, tag("ssd:System"), name=name)
    elements = etree.SubElement(system, tag("ssd:Elements"))
    used: list[Variable] = []
    for place, (unit, interface) in enumerate(blueprint.interfaces.items()):
        about = {"name": unit, "type": FMU_TYPE, "source": sources[place], "implementation": "CoSimulation"}
        component = etree.SubElement(elements, tag("ssd:Component"), about)
        used += _connectors(component, interface, _ends(blueprint, place), outputs[place])
        used += _start_values(component, interface, values[place])
    _connections(system, blueprint)
    write_units(root, used)
    table = blueprint.scenario.table
    times = {"startTime": repr(table.start_time), "stopTime": repr(table.stop_time)}
    experiment = etree.SubElement(root, tag("ssd:DefaultExperiment"), times)
    algorithm = etree.SubElement(_annotation(experiment, OSP_ANNOTATION), tag("osp:Algorithm"))
    etree.SubElement(algorithm, tag("osp:FixedStepAlgorithm"), baseStepSize=repr(step))
    own = etree.SubElement(_annotation(root, SCENARIO_ANNOTATION), "Scenario", nsmap={None: SCENARIO_NAMESPACE})
    own.text = etree.CDATA("\n" + tomli_w.dumps(annotation))
    return root


def text_of(root: Any) -> bytes:
    return bytes(etree.tostring(root, encoding="UTF-8", xml_declaration=True, pretty_print=True))


def _ends(blueprint: Blueprint, place: int) -> set[str]:
    given = {_way(blueprint, link)[0] for link in blueprint.links if link.source_unit == place}
    return given | {link.target for link in blueprint.links if link.target_unit == place}


def _connectors(component: Any, interface: Interface, ends: set[str], outputs: Iterable[str]) -> list[Variable]:
    """What is connected, and the outputs asked for: some hosts set every input connector there is."""
    wanted = [v for v in interface.variables.values() if v.name in ends or v.name in outputs]
    if wanted:
        parent = etree.SubElement(component, tag("ssd:Connectors"))
        for variable in wanted:
            connector = etree.SubElement(parent, tag("ssd:Connector"), name=variable.name, kind=variable.causality)
            etree.SubElement(connector, tag(f"ssc:{variable.kind}"), _unit(variable))
    return wanted


def _start_values(component: Any, interface: Interface, values: Mapping[str, Value]) -> list[Variable]:
    """What differs from the FMU's own start values."""
    given = [(interface.variables[name], value) for name, value in values.items() if not is_own_start(interface.variables[name], value)]
    if given:
        bindings = etree.SubElement(component, tag("ssd:ParameterBindings"))
        inline = etree.SubElement(etree.SubElement(bindings, tag("ssd:ParameterBinding")), tag("ssd:ParameterValues"))
        parameters = etree.SubElement(etree.SubElement(inline, tag("ssv:ParameterSet"), version="1.0", name=START), tag("ssv:Parameters"))
        for variable, value in given:
            parameter = etree.SubElement(parameters, tag("ssv:Parameter"), name=variable.name)
            etree.SubElement(parameter, tag(f"ssv:{variable.kind}"), value=_text(variable, value), **_unit(variable))
    return [variable for variable, _ in given]


def is_own_start(variable: Variable, value: Value) -> bool:
    if variable.start is None:
        return False
    if variable.kind is Kind.BOOLEAN:
        return value == (variable.start in ("true", "True", "1"))
    return variable.start == value if variable.kind is Kind.STRING else float(variable.start) == value


def _text(variable: Variable, value: Value) -> str:
    if variable.kind is Kind.BOOLEAN:
        return "true" if value else "false"
    return repr(float(value)) if variable.kind is Kind.REAL else str(value)


def _unit(variable: Variable) -> dict[str, str]:
    return {"unit": variable.unit} if variable.kind is Kind.REAL and stated(variable) else {}


def _connections(system: Any, blueprint: Blueprint) -> None:
    if not blueprint.links:
        return
    names = list(blueprint.interfaces)
    parent = etree.SubElement(system, tag("ssd:Connections"))
    for link in blueprint.links:
        source, way = _way(blueprint, link)
        about = {"startElement": names[link.source_unit], "startConnector": source}
        about |= {"endElement": names[link.target_unit], "endConnector": link.target}
        about |= {"suppressUnitConversion": "true"} if way.as_is else {}
        connection = etree.SubElement(parent, tag("ssd:Connection"), about)
        if way != PLAIN:
            etree.SubElement(connection, tag("ssc:LinearTransformation"), factor=repr(way.factor), offset=repr(way.offset))


def _way(blueprint: Blueprint, link: Link) -> tuple[str, Way]:
    names = list(blueprint.interfaces)
    label = f"{blueprint.scenario.where}: {names[link.source_unit]} -> {names[link.target_unit]}.{link.target}"
    return way_of(blueprint.derived[link.source_unit] if blueprint.derived else (), link, label)


def _annotation(parent: Any, kind: str) -> Any:
    return etree.SubElement(etree.SubElement(parent, tag("ssd:Annotations")), tag("ssc:Annotation"), type=kind)


def _version() -> str:
    try:
        return metadata.version(DISTRIBUTION)
    except metadata.PackageNotFoundError:
        return "not installed"
