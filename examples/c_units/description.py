"""A table of variables -> modelDescription.xml of FMI 2.0 or 3.0, and terminalsAndIcons.xml."""

from collections.abc import Iterator
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from tables import POWERS, Table, Variable

VARIABILITY = {"parameter": "fixed", "input": None, "output": None, "local": None}


def places(table: Table) -> dict[str, int]:
    """Where each variable begins in the unit's array: its value reference."""
    found, at = {}, 0
    for variable in table.variables:
        found[variable.name] = at
        at += variable.size
    return found


def model_description(name: str, table: Table, token: str, fmi: int, states: bool) -> bytes:
    three = fmi == 3
    root = Element(
        "fmiModelDescription",
        {"fmiVersion": "3.0" if three else "2.0", "modelName": name, ("instantiationToken" if three else "guid"): token,
         "description": table.description, "generationTool": "examples/c_units/build.py", "variableNamingConvention": "structured"},
    )  # fmt: skip
    state = "FMUState" if three else "FMUstate"
    able = {f"canGetAndSet{state}": "true", f"canSerialize{state}": "true"} if states else {}
    SubElement(root, "CoSimulation", {"modelIdentifier": name, "canHandleVariableCommunicationStepSize": "true", **able})
    units = SubElement(root, "UnitDefinitions")
    for unit, powers in POWERS.items():
        if any(variable.unit == unit for variable in table.variables):
            SubElement(SubElement(units, "Unit", {"name": unit}), "BaseUnit", {base: str(power) for base, power in powers.items()})
    if table.enumeration:
        types = SubElement(root, "TypeDefinitions")
        home = types if three else SubElement(types, "SimpleType", {"name": "Phase"})
        phase = SubElement(home, *(("EnumerationType", {"name": "Phase"}) if three else ("Enumeration", {})))
        for value, item in enumerate(table.enumeration):
            SubElement(phase, "Item", {"name": item, "value": str(value + 1)})
    (_variables3 if three else _variables2)(root, table)
    indent(root)
    return tostring(root, encoding="UTF-8", xml_declaration=True)


def terminals(table: Table, fmi: int) -> bytes:
    """One terminal a port: what stands before the first point of its members' names."""
    root = Element("fmiTerminalsAndIcons", {"fmiVersion": "3.0"})
    all_of_them = SubElement(root, "Terminals")
    ports: dict[str, list[str]] = {}
    for variable in table.variables:
        port, point, _ = variable.name.partition(".")
        if point and variable.causality in ("input", "output"):
            ports.setdefault(port, []).extend([variable.name] if fmi == 3 else [name for name, _ in _scalars(variable)])
    for port, names in ports.items():
        terminal = SubElement(all_of_them, "Terminal", {"name": port, "matchingRule": "bus", "terminalKind": "lander.port"})
        for name in names:
            member = {"variableName": name, "memberName": name.partition(".")[2], "variableKind": "signal"}
            SubElement(terminal, "TerminalMemberVariable", member)
    indent(root)
    return tostring(root, encoding="UTF-8", xml_declaration=True)


def _scalars(variable: Variable) -> Iterator[tuple[str, float]]:
    for at, start in enumerate(variable.starts):
        yield (f"{variable.name}[{at + 1}]" if isinstance(variable.start, tuple) else variable.name), start


def _attributes(variable: Variable, three: bool) -> dict[str, str]:
    if variable.unit == "Boolean":
        return {}
    if variable.unit == "Phase":
        return {"declaredType": "Phase"}
    return {"unit": variable.unit} | ({"nominal": f"{variable.nominal:g}"} if variable.nominal != 1.0 else {})


def _start(variable: Variable, values: tuple[float, ...]) -> dict[str, str]:
    if variable.causality not in ("parameter", "input"):
        return {}
    if variable.unit == "Boolean":
        return {"start": " ".join("true" if value else "false" for value in values)}
    return {"start": " ".join(f"{value:.17g}" for value in values)}


def _variables2(root: Element, table: Table) -> None:
    kinds = {"Boolean": "Boolean", "Phase": "Enumeration"}
    listed, outputs, number = SubElement(root, "ModelVariables"), [], 0
    for variable in table.variables:
        for at, (name, value) in enumerate(_scalars(variable)):
            number += 1
            about = {"name": name, "valueReference": str(places(table)[variable.name] + at), "description": variable.text}
            discrete = {"variability": "discrete"} if variable.unit in kinds else {}
            about |= {"causality": variable.causality} | ({"variability": "fixed"} if variable.causality == "parameter" else discrete)
            scalar = SubElement(listed, "ScalarVariable", about)
            SubElement(scalar, kinds.get(variable.unit, "Real"), _attributes(variable, False) | _start(variable, (value,)))
            if variable.causality == "output":
                outputs.append(number)
    structure = SubElement(root, "ModelStructure")
    for tag in ("Outputs", "InitialUnknowns"):
        group = SubElement(structure, tag)
        for number in outputs:
            SubElement(group, "Unknown", {"index": str(number)} | ({"dependencies": ""} if tag == "Outputs" else {}))


def _variables3(root: Element, table: Table) -> None:
    kinds = {"Boolean": "Boolean", "Phase": "Enumeration"}
    listed, structure = SubElement(root, "ModelVariables"), SubElement(root, "ModelStructure")
    taken = sum(variable.size for variable in table.variables)
    SubElement(listed, "Float64", {"name": "time", "valueReference": str(taken), "causality": "independent", "variability": "continuous"})
    for variable in table.variables:
        about = {"name": variable.name, "valueReference": str(places(table)[variable.name]), "description": variable.text}
        about |= {"causality": variable.causality} | ({"variability": "fixed"} if variable.causality == "parameter" else {})
        kind = kinds.get(variable.unit, "Float64")
        entry = SubElement(listed, kind, about | _attributes(variable, True) | _start(variable, variable.starts))
        if isinstance(variable.start, tuple):
            SubElement(entry, "Dimension", {"start": str(variable.size)})
    for tag in ("Output", "InitialUnknown"):
        for variable in table.variables:
            if variable.causality == "output":
                about = {"valueReference": str(places(table)[variable.name])}
                SubElement(structure, tag, about | ({"dependencies": ""} if tag == "Output" else {}))
