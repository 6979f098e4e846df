"""modelDescription.xml of a unit, from its records alone."""

from collections.abc import Iterable
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element, SubElement

from .layout import Layout, Scalar
from .unit_strings import exponents

if TYPE_CHECKING:
    from .unit import Unit

MADE = "2000-01-01T00:00:00Z"  # no clock: the same content gives the same bytes
CAPABILITIES = {
    "needsExecutionTool": "true",
    "canHandleVariableCommunicationStepSize": "true",
    "canInterpolateInputs": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canNotUseMemoryManagementFunctions": "true",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
}
CATEGORIES = ("logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal", "logAll")
MESSAGE = "What the unit last had to complain of; empty when all is well."


def model_description(unit: "type[Unit]", guid: str) -> Element:
    """The whole description; attributes in FMI's order."""
    root = Element(
        "fmiModelDescription",
        {
            "fmiVersion": "2.0",
            "modelName": unit.__name__,
            "guid": guid,
            "description": " ".join(unit.description.split()),
            "generationTool": "lander.shell with pythonfmu",
            "generationDateAndTime": MADE,
            "variableNamingConvention": "structured",
        },
    )
    SubElement(root, "CoSimulation", {"modelIdentifier": unit.__name__, **CAPABILITIES})
    root.append(unit_definitions(unit.layout))
    categories = SubElement(root, "LogCategories")
    for category in CATEGORIES:
        SubElement(categories, "Category", {"name": category})
    start, stop, step = unit.experiment
    SubElement(root, "DefaultExperiment", {"startTime": repr(start), "stopTime": repr(stop), "stepSize": repr(step)})
    root.append(port_contract(unit))
    variables = SubElement(root, "ModelVariables")
    for scalar in unit.layout.visible:
        variables.append(scalar_variable(scalar))
    message = SubElement(
        variables,
        "ScalarVariable",
        {
            "name": "message",
            "valueReference": str(unit.layout.size),
            "description": MESSAGE,
            "causality": "local",
            "variability": "discrete",
            "initial": "calculated",
        },
    )
    SubElement(message, "String")
    root.append(model_structure(unit.layout, unit.initially))
    return root


def port_contract(unit: "type[Unit]") -> Element:
    """Which kind of unit this is and which variables one in its place must have; all others are optional. FMI has no word for it."""
    missing = [name for name in unit.required if name not in unit.layout.slices]
    if missing:
        raise ValueError(f"{unit.__name__}: required {missing} are not declared")
    annotations = Element("VendorAnnotations")
    tool = SubElement(annotations, "Tool", {"name": "lander"})
    SubElement(tool, "PortContract", {"kind": unit.kind or unit.__name__, "required": " ".join(unit.required)})
    return annotations


def unit_definitions(layout: Layout) -> Element:
    """Every unit in use, with its exponents of the base units."""
    definitions = Element("UnitDefinitions")
    for unit in sorted({unit_name(scalar) for scalar in layout.visible if scalar.record.kind == "Real"}):
        powers = {name: str(power) for name, power in exponents(unit).items()}
        SubElement(SubElement(definitions, "Unit", {"name": unit}), "BaseUnit", powers)
    return definitions


def unit_name(scalar: Scalar) -> str:
    """The unit's string, "1" where there is none."""
    return scalar.record.unit or "1"


def scalar_variable(scalar: Scalar) -> Element:
    """One variable, its causality and variability, and its type with unit, bounds, nominal and start value."""
    record = scalar.record
    continuous = "continuous" if record.kind == "Real" else "discrete"
    variability = "fixed" if record.causality == "parameter" else continuous
    attributes = {
        "name": scalar.name,
        "valueReference": str(scalar.slot),
        "description": " ".join(record.description.split()),
        "causality": record.causality,
        "variability": variability,
    }
    if record.causality != "input":
        attributes["initial"] = "exact" if record.causality == "parameter" else "calculated"
    element = Element("ScalarVariable", attributes)
    SubElement(element, record.kind, type_attributes(scalar))
    return element


def type_attributes(scalar: Scalar) -> dict[str, str]:
    """Attributes of Real, Integer, Boolean or String; numbers are written so that they read back to the last bit."""
    record, attributes = scalar.record, dict[str, str]()
    if record.kind == "String":
        return {"start": ""}
    if record.kind == "Real":
        attributes["unit"] = unit_name(scalar)
    if record.kind != "Boolean":
        for name, limit in (("min", record.minimum), ("max", record.maximum)):
            if limit is not None:
                attributes[name] = number(limit, record.kind)
    if record.kind == "Real" and record.nominal is not None:
        attributes["nominal"] = number(record.nominal, record.kind)
    if record.causality in ("parameter", "input"):
        attributes["start"] = number(scalar.start, record.kind)
    return attributes


def number(value: float, kind: str) -> str:
    """A number in XML, the shortest that reads back exactly."""
    if kind == "Boolean":
        return "true" if value else "false"
    return str(int(value)) if kind == "Integer" else repr(float(value))


def model_structure(layout: Layout, initial_inputs: tuple[str, ...]) -> Element:
    """Outputs with what they depend on at one communication point, and what their initial values depend on.

    Where nothing feeds through, the list is empty and is written: without it importers assume dependence on everything
    and find algebraic loops that are not there.
    """
    index = {scalar.slot: i for i, scalar in enumerate(layout.visible, 1)}
    structure = Element("ModelStructure")
    outputs = [scalar for scalar in layout.visible if scalar.record.causality == "output"]
    parameters = [record.name for record in layout.records if record.causality == "parameter"]
    for name in ("Outputs", "InitialUnknowns") if outputs else ():
        unknowns = SubElement(structure, name)
        for scalar in outputs:
            record = scalar.record
            initially = (*parameters, *initial_inputs, *record.depends) if record.initially is None else record.initially
            known = record.depends if name == "Outputs" else initially
            SubElement(unknowns, "Unknown", {"index": str(index[scalar.slot]), "dependencies": indices(layout, index, record.name, known)})
    return structure


def indices(layout: Layout, index: dict[int, int], unknown: str, names: Iterable[str]) -> str:
    """The indices of all elements of the named variables, in rising order."""
    slots: set[int] = set()
    for name in names:
        if name not in layout.slices:
            raise ValueError(f"{unknown} depends on {name}, which is not declared")
        where = layout.slices[name]
        slots.update(range(where.start, where.stop))
    return " ".join(str(index[slot]) for slot in sorted(slots))
