"""modelDescription.xml of FMI 2.0 or 3.0 -> Interface."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from math import prod
from pathlib import Path
from typing import Any

from fmpy import platform as this_platform
from fmpy import read_model_description, supported_platforms

from orchestrator.errors import UnitError
from orchestrator.fmi.types import FmiType, integer_range, types_of
from orchestrator.fmi.unpack import content_hash
from orchestrator.master.slave import Interface, Kind, Variable

_CAPABILITIES = (
    "canGetAndSetFMUstate",
    "canSerializeFMUstate",
    "canHandleVariableCommunicationStepSize",
    "canInterpolateInputs",
    "canBeInstantiatedOnlyOncePerProcess",
    "providesDirectionalDerivative",
    "needsExecutionTool",
)
_OF_FMI3 = ("hasEventMode", "mightReturnEarlyFromDoStep", "providesIntermediateUpdate")
_SI = ("kg", "m", "s", "A", "K", "mol", "cd", "rad", "factor", "offset")
_EXPORT = "export it as co-simulation of FMI 2.0 or 3.0"
Dimensions = dict[str, tuple[float, ...] | None]


def read_interface(path: Path) -> Interface:
    """What the FMU says of itself, or a UnitError that names the file. Read once as long as the file stays what it is."""
    try:
        now = path.stat()
    except OSError:
        return _read_interface(path)
    return _read_again(path, now.st_mtime_ns, now.st_size)


@lru_cache(maxsize=64)
def _read_again(path: Path, changed: int, size: int) -> Interface:
    return _read_interface(path)


def _read_interface(path: Path) -> Interface:
    try:
        description: Any = read_model_description(str(path))
    except Exception as error:
        first_line = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
        raise UnitError(f"{path}: not a readable FMU ({first_line}); build or download it again") from None
    if not description.fmiVersion.startswith(("2.", "3.")):
        raise UnitError(f"{path}: is FMI {description.fmiVersion}, this master steps FMI 2.0 and 3.0; {_EXPORT}")
    if description.coSimulation is None:
        other = "model exchange" if description.modelExchange is not None else "scheduled execution"
        raise UnitError(f"{path}: is for {other} only, expects co-simulation; {_EXPORT}")
    platforms = supported_platforms(str(path))
    if this_platform not in platforms:
        raise UnitError(f"{path}: holds binaries for {', '.join(platforms) or 'no platform'}, this machine is {this_platform}")
    known = types_of(description.fmiVersion)
    dimensions = {unit.name: _dimension(unit.baseUnit) for unit in description.unitDefinitions}
    capabilities = _CAPABILITIES + (_OF_FMI3 if description.fmiVersion.startswith("3.") else ())
    return Interface(
        model_name=description.modelName,
        variables={v.name: v for raw in description.modelVariables for v in _variables(raw, known[raw.type], dimensions)},
        capabilities={name: bool(getattr(description.coSimulation, name, False)) for name in capabilities},
        guid=description.guid,
        fmi_version=description.fmiVersion,
        generation_tool=description.generationTool or "",
        description=description.description or "",
        path=path,
        sha256=content_hash(path),
    )


def model_identifier(path: Path) -> str:
    """Name of the binary inside the FMU."""
    description: Any = read_model_description(str(path), validate=False)
    return str(description.coSimulation.modelIdentifier)


def _dimension(base: Any) -> tuple[float, ...] | None:
    return None if base is None else tuple(float(getattr(base, name)) for name in _SI)


def _variables(raw: Any, fmi_type: FmiType, dimensions: Dimensions) -> Iterator[Variable]:
    """The variable, or the elements of an array, by rows and with its dimensions' start values; then its other names."""
    one = _variable(raw, fmi_type, dimensions)
    shape = tuple(raw.shape or ()) if raw.dimensions else None
    size = 1 if shape is None else prod(shape)
    starts: list[str | None] = [None] * size
    if raw.start is not None:
        text = str(raw.start)
        given = [text] if shape is None or fmi_type.kind is Kind.STRING else text.split()
        starts = list(given) if len(given) == size else [given[0]] * size if given else starts
    for name in (raw.name, *(alias.name for alias in getattr(raw, "aliases", None) or ())):
        for at, start in enumerate(starts):
            yield replace(one, name=name if shape is None else f"{name}[{at + 1}]", start=start, element=at, size=size)


def _variable(raw: Any, fmi_type: FmiType, dimensions: Dimensions) -> Variable:
    """Attributes a variable does not state itself come from its declared type."""

    def stated(attribute: str) -> str | None:
        value = getattr(raw, attribute, None)
        if value is None and raw.declaredType is not None:
            value = getattr(raw.declaredType, attribute, None)
        return None if value is None else str(value)

    minimum, maximum, nominal, unit = (stated(name) for name in ("min", "max", "nominal", "unit"))
    found = raw.declaredType.items if raw.type == "Enumeration" and raw.declaredType is not None else ()
    items = {item.name: int(item.value) for item in found}
    low, high = integer_range(fmi_type.c_type) if fmi_type.kind is Kind.INTEGER else (None, None)
    if items:
        low, high = min(items.values()), max(items.values())
    return Variable(
        name=raw.name,
        kind=fmi_type.kind,
        causality=raw.causality or "local",
        unit=unit or "",
        dimension=dimensions.get(unit or ""),
        minimum=low if minimum is None else float(minimum),
        maximum=high if maximum is None else float(maximum),
        nominal=1.0 if nominal is None else float(nominal),
        description=raw.description or "",
        reference=int(raw.valueReference),
        type=raw.type,
        items=items,
    )
