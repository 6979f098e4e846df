"""modelDescription.xml -> Interface."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

from fmpy import platform as this_platform
from fmpy import read_model_description, supported_platforms

from orchestrator.errors import UnitError
from orchestrator.fmi.unpack import content_hash
from orchestrator.master.slave import Interface, Kind, Variable

_KINDS = {"Real": Kind.REAL, "Integer": Kind.INTEGER, "Enumeration": Kind.INTEGER, "Boolean": Kind.BOOLEAN, "String": Kind.STRING}
_CAPABILITIES = (
    "canGetAndSetFMUstate",
    "canSerializeFMUstate",
    "canHandleVariableCommunicationStepSize",
    "canInterpolateInputs",
    "canBeInstantiatedOnlyOncePerProcess",
    "providesDirectionalDerivative",
    "needsExecutionTool",
)
_SI = ("kg", "m", "s", "A", "K", "mol", "cd", "rad", "factor", "offset")


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
    if description.fmiVersion != "2.0":
        raise UnitError(f"{path}: is FMI {description.fmiVersion}, this master steps FMI 2.0; export it as FMI 2.0 co-simulation")
    if description.coSimulation is None:
        raise UnitError(f"{path}: is for model exchange only, expects co-simulation; export it as FMI 2.0 co-simulation")
    platforms = supported_platforms(str(path))
    if this_platform not in platforms:
        raise UnitError(f"{path}: holds binaries for {', '.join(platforms) or 'no platform'}, this machine is {this_platform}")
    dimensions = {unit.name: _dimension(unit.baseUnit) for unit in description.unitDefinitions}
    variables = {v.name: _variable(v, dimensions) for v in description.modelVariables}
    return Interface(
        model_name=description.modelName,
        variables=variables,
        capabilities={name: bool(getattr(description.coSimulation, name, False)) for name in _CAPABILITIES},
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


def _variable(raw: Any, dimensions: dict[str, tuple[float, ...] | None]) -> Variable:
    """Attributes a variable does not state itself come from its declared type."""
    kind = _KINDS.get(raw.type, Kind.STRING)

    def stated(attribute: str) -> str | None:
        value = getattr(raw, attribute, None)
        if value is None and raw.declaredType is not None:
            value = getattr(raw.declaredType, attribute, None)
        return None if value is None else str(value)

    minimum, maximum, nominal, unit = (stated(name) for name in ("min", "max", "nominal", "unit"))
    return Variable(
        name=raw.name,
        kind=kind,
        causality=raw.causality or "local",
        unit=unit or "",
        dimension=dimensions.get(unit or ""),
        start=None if raw.start is None else str(raw.start),
        minimum=None if minimum is None else float(minimum),
        maximum=None if maximum is None else float(maximum),
        nominal=1.0 if nominal is None else float(nominal),
        description=raw.description or "",
        reference=int(raw.valueReference),
    )
