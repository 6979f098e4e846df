"""Parameter bindings -> start values by component: outer levels over inner ones, later bindings over earlier ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from lxml import etree

from orchestrator.errors import SspError, nearest
from orchestrator.master.slave import Interface, Variable
from orchestrator.scenario.conversion import unit_conversion
from orchestrator.ssp.archive import Archive, every, first
from orchestrator.ssp.names import KINDS
from orchestrator.ssp.structure import Structure, linear
from orchestrator.ssp.units import Dimension, units_of
from orchestrator.ssp.ways import PLAIN, Way

Given = float | int | bool | str | list[Any]


@dataclass(frozen=True)
class Parameter:
    name: str
    value: Given
    unit: str = ""
    dimension: Dimension | None = None
    way: Way = PLAIN


def start_values(archive: Archive, structure: Structure, interfaces: Mapping[str, Interface]) -> dict[str, dict[str, Given]]:
    """Path of a component -> variable -> value in the unit of measure the FMU declares."""
    values: dict[str, dict[str, Given]] = {path: {} for path in structure.components}
    for path, element in structure.parameterised:
        for binding in every(element, "ssd:ParameterBindings", "ssd:ParameterBinding"):
            shared = binding.get("source") is not None
            for parameter in _parameters(archive, binding, path):
                targets = list(_targets(structure, path, parameter))
                if not targets and not shared:
                    raise SspError(f'{archive.where}: {path or "system"}: parameter "{parameter.name}" belongs to no component; correct it')
                for component, name, given in targets:
                    variable = _variable(archive, component, name, interfaces[component], shared)
                    if variable is not None:
                        values[component][name] = _in_unit(archive, f"{component}.{name}", given, variable)
    return values


def _targets(structure: Structure, path: str, parameter: Parameter) -> Iterator[tuple[str, str, Parameter]]:
    """Component, variable and value each parameter ends at; none where the name is of nobody here."""
    if path in structure.components:
        yield path, parameter.name, parameter
        return
    full = f"{path}.{parameter.name}" if path else parameter.name
    for component in structure.components:
        if full.startswith(f"{component}."):
            yield component, full.removeprefix(f"{component}."), parameter
    for system, connectors in structure.systems.items():
        name = full.removeprefix(f"{system}.") if system else full
        if name in connectors and (not system or full.startswith(f"{system}.")):
            for wire in structure.taken_by((system, name)):
                yield *wire.target, replace(parameter, way=parameter.way.then(wire.way))


def _variable(archive: Archive, component: str, name: str, interface: Interface, shared: bool) -> Variable | None:
    """A set in a file of its own may be written for many components: what one of them does not have is passed over."""
    elements = interface.vectors.get(name)
    found = elements[0] if elements else interface.variables.get(name)
    if found is None and not shared:
        raise SspError(f'{archive.where}: {component}: the FMU has no variable "{name}"; {nearest(name, interface.variables)}')
    return found


def _in_unit(archive: Archive, what: str, parameter: Parameter, variable: Variable) -> Given:
    given = Variable(parameter.name, unit=parameter.unit, dimension=parameter.dimension)
    conversion = (1.0, 0.0) if parameter.way.as_is else unit_conversion(given, variable)
    if conversion is None:
        raise SspError(f"{archive.where}: {what}: is given in {parameter.unit}, expects {variable.unit}; give it in that unit")

    def one(value: Any) -> Any:
        if isinstance(value, bool | str):
            return value
        factor, offset, _ = parameter.way
        converted = value if conversion == (1.0, 0.0) else conversion[0] * value + conversion[1]      # whole numbers stay whole
        return converted if (factor, offset) == (1.0, 0.0) else factor * converted + offset

    return [one(x) for x in parameter.value] if isinstance(parameter.value, list) else one(parameter.value)


def _parameters(archive: Archive, binding: Any, path: str) -> list[Parameter]:
    """The parameters of one binding under the names they are looked up by."""
    who = f"{path or 'system'}: parameter binding"
    if binding.get("type", "application/x-ssp-parameter-set") != "application/x-ssp-parameter-set":
        raise SspError(f'{archive.where}: {who}: is of type "{binding.get("type")}", expects a parameter set; convert it to .ssv')
    mapping = _mapping(archive, first(binding, "ssd:ParameterMapping"), who)
    prefix = binding.get("prefix", "")
    found = []
    for values in _sets(archive, binding, who):
        dimensions = units_of(archive.description) | units_of(values)
        enumerations = _enumerations(archive.description) | _enumerations(values)
        for element in every(values, "ssv:Parameters", "ssv:Parameter"):
            parameter = _parameter(archive, element, dimensions, enumerations)
            found.append(replace(parameter, name=prefix + parameter.name))
    if mapping is None:
        return found
    return [
        replace(parameter, name=target, way=way)
        for parameter in found for source, target, way in mapping if source == parameter.name
    ]  # fmt: skip


def _sets(archive: Archive, binding: Any, who: str) -> list[Any]:
    source = binding.get("source")
    if source is not None:
        if binding.get("sourceBase", "SSD") != "SSD":
            raise SspError(f"{archive.where}: {who}: lies inside the component; put the .ssv beside the .ssd")
        return [archive.document(source, who)]
    return every(binding, "ssd:ParameterValues", "ssv:ParameterSet")


def _mapping(archive: Archive, element: Any, who: str) -> list[tuple[str, str, Way]] | None:
    """Source, target and what is done to the value; None where names stand for themselves."""
    if element is None:
        return None
    source = element.get("source")
    root = archive.document(source, who) if source is not None else first(element, "ssm:ParameterMapping")
    entries = []
    for entry in every(root, "ssm:MappingEntry"):
        for child in entry:
            if etree.QName(child).localname.endswith("MappingTransformation"):
                raise SspError(f"{archive.where}: {who}: {entry.get('source')}: this reader knows linear mappings; write the value itself")
        as_is = entry.get("suppressUnitConversion", "false") in ("true", "1")
        entries.append((entry.get("source"), entry.get("target"), Way(*linear(first(entry, "ssc:LinearTransformation")), as_is)))
    return entries


def _parameter(archive: Archive, element: Any, dimensions: Mapping[str, Dimension], enumerations: Mapping[str, int]) -> Parameter:
    name = element.get("name")
    for child in element:
        kind = KINDS.get(etree.QName(child).localname)
        if kind is not None:
            try:
                value = _value(kind, child.get("value", ""), enumerations)
            except ValueError:
                raise SspError(f'{archive.where}: parameter {name} = "{child.get("value")}": is no {kind}; correct it') from None
            unit = child.get("unit", "")
            return Parameter(name, value, unit, dimensions.get(unit))
    kinds = ", ".join(etree.QName(child).localname for child in element) or "nothing"
    raise SspError(f"{archive.where}: parameter {name}: holds {kinds}, this reader takes numbers, truth values and strings; leave it out")


def _value(kind: str, text: str, enumerations: Mapping[str, int]) -> Given:
    """Several numbers, as SSP 2.0 writes arrays, give a list."""
    if kind == "String":
        return text
    if kind == "Enumeration" and text in enumerations:
        return enumerations[text]
    read: dict[str, Callable[[str], Given]] = {"Real": float, "Integer": int, "Boolean": _truth, "Enumeration": int}
    numbers = [read[kind](word) for word in text.split()]
    if not numbers:
        raise ValueError(text)
    return numbers if len(numbers) > 1 else numbers[0]


def _truth(word: str) -> bool:
    if word not in ("true", "1", "false", "0"):
        raise ValueError(word)
    return word in ("true", "1")


def _enumerations(root: Any) -> dict[str, int]:
    """Names of items -> their numbers, of the enumerations a document lists."""
    lists = [child for child in root if etree.QName(child).localname == "Enumerations"]
    return {item.get("name"): int(item.get("value")) for all_of in lists for item in all_of.iter() if item.get("value") is not None}
