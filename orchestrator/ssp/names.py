"""Names the SSP standard fixes, and those of this project's own annotation. SSP 2.0 kept the namespaces of 1.0."""

from __future__ import annotations

_STANDARD = "http://ssp-standard.org/SSP1/"
NAMESPACES = {
    "ssd": f"{_STANDARD}SystemStructureDescription",
    "ssc": f"{_STANDARD}SystemStructureCommon",
    "ssv": f"{_STANDARD}SystemStructureParameterValues",
    "ssm": f"{_STANDARD}SystemStructureParameterMapping",
    "osp": "http://opensimulationplatform.com/SSP/OSPAnnotations",
}
DEFAULT_SSD = "SystemStructure.ssd"
RESOURCES = "resources"
FMU_TYPE = "application/x-fmu-sharedlibrary"

SCENARIO_ANNOTATION = "org.lander-touchdown.scenario"
"""Type of the annotation that holds what SSP has no words for, as a scenario's TOML; other tools pass it over."""
SCENARIO_NAMESPACE = "urn:org.lander-touchdown:scenario"
OSP_ANNOTATION = "com.opensimulationplatform"
"""libcosim's: the fixed step it takes when it is told no other."""

KINDS = {
    "Real": "Real", "Float64": "Real", "Float32": "Real",
    "Integer": "Integer", "Int8": "Integer", "Int16": "Integer", "Int32": "Integer", "Int64": "Integer",
    "UInt8": "Integer", "UInt16": "Integer", "UInt32": "Integer", "UInt64": "Integer",
    "Boolean": "Boolean", "String": "String", "Enumeration": "Enumeration",
}  # fmt: skip
"""Element names of types, of SSP 1.0 and 2.0 -> what they hold."""


def tag(name: str) -> str:
    """"ssd:System" -> the name as lxml has it."""
    prefix, _, local = name.partition(":")
    return f"{{{NAMESPACES[prefix]}}}{local}"
