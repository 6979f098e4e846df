"""A found term as an FMU of its own: a copy of the unit it belongs to that starts with the found parameters, for any FMI tool.

The orchestrator knows no unit from inside. What it relies on is pythonfmu's form: `resources/slavemodule.txt` names the script whose most
derived class is the unit, and that class declares its `variables` as records with `name` and `start` (decision 2).
"""

from __future__ import annotations

import hashlib
import re
import uuid
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from orchestrator.diagnosis.starts import number_of
from orchestrator.errors import UnitError
from orchestrator.fmi.description import read_interface
from orchestrator.master.slave import Interface, Kind, Value, stem
from orchestrator.scenario.parameters import start_values

_WORD = re.compile(r"[A-Za-z_]\w*")
_DESCRIPTION, _MODULE, _PAGE = "modelDescription.xml", "resources/slavemodule.txt", "documentation/index.html"
_STALE = ("documentation/reference.csv",)
"""Of the original's parameters."""
_STARTS = """

class {unit}({unit}):
    variables = tuple(replaced(record, {starts}) for record in {unit}.variables)
"""
_REPLACED = """

def replaced(record, starts):
    from dataclasses import replace

    return replace(record, start=tuple(starts[record.name])) if record.name in starts else record
"""


def build_term_fmu(folder: Path, fmu: Path, parameters: Mapping[str, Any], name: str, description: str = "") -> Path:
    """folder/NAME.fmu. parameters: as a scenario gives them, checked against what the unit declares."""
    if not _WORD.fullmatch(name):
        raise UnitError(f'{name}: is no name for an FMU; give letters, digits and "_" only')
    interface = read_interface(fmu)
    values = start_values(name, interface, parameters)
    with zipfile.ZipFile(fmu) as archive:
        entries = {entry: archive.read(entry) for entry in archive.namelist() if entry not in _STALE and not entry.endswith("/")}
    if _MODULE not in entries:
        raise UnitError(f"{fmu}: is not made of a Python script; only such a unit can be copied with other start values")
    root = ElementTree.fromstring(entries.pop(_DESCRIPTION))
    unit = _identifier(root, fmu)
    entries = _renamed(entries, unit, name)
    _rescript(entries, interface, values, name, unit)
    _describe(root, values, name, description or f"{interface.description} {_said(values)}")
    if _PAGE in entries:
        entries[_PAGE] = entries[_PAGE].replace(b"<body>", f"<body><p>{name}: {_said(values)}.</p>".encode(), 1)
    root.set("guid", _guid(entries, ElementTree.tostring(root)))
    return _write(folder / f"{name}.fmu", {_DESCRIPTION: ElementTree.tostring(root, "UTF-8", xml_declaration=True), **entries})


def _identifier(root: ElementTree.Element, fmu: Path) -> str:
    run = root.find("CoSimulation")
    if run is None:
        raise UnitError(f"{fmu}: is not for co-simulation")
    return run.get("modelIdentifier", "")


def _renamed(entries: dict[str, bytes], unit: str, name: str) -> dict[str, bytes]:
    """The binaries bear the model identifier."""
    return {re.sub(rf"^(binaries/[^/]+/){re.escape(unit)}(\.\w+)$", rf"\g<1>{name}\g<2>", entry): it for entry, it in entries.items()}


def _rescript(entries: dict[str, bytes], interface: Interface, values: Mapping[str, Value], name: str, unit: str) -> None:
    """A last class below the unit's own, in a script with a name of its own: the Python FMUs of a process share their modules."""
    old = entries[_MODULE].decode().strip()
    text = entries.pop(f"resources/{old}.py").decode() + _REPLACED + _STARTS.format(unit=unit, starts=_starts(interface, values))
    script = f"{name}_{hashlib.sha256(text.encode()).hexdigest()[:12]}"
    entries[f"resources/{script}.py"] = text.encode()
    entries[_MODULE] = script.encode()


def _starts(interface: Interface, values: Mapping[str, Value]) -> dict[str, tuple[float, ...]]:
    """Vector -> all its elements, the found ones among them."""
    vectors = dict.fromkeys(stem(variable) for variable in values)
    return {vector: tuple(number_of(values.get(it.name, it.start)) for it in interface.vectors[vector]) for vector in vectors}


def _describe(root: ElementTree.Element, values: Mapping[str, Value], name: str, description: str) -> None:
    root.set("modelName", name)
    root.set("description", description)
    run = root.find("CoSimulation")
    if run is not None:
        run.set("modelIdentifier", name)
    for variable in root.iter("ScalarVariable"):
        value = values.get(variable.get("name", ""))
        if value is not None:
            kind = next(it for it in variable if it.tag in {str(k) for k in Kind})
            kind.set("start", str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value))


def _said(values: Mapping[str, Value]) -> str:
    return "with " + ", ".join(f"{name} = {value:g}" if isinstance(value, float) else f"{name} = {value}" for name, value in values.items())


def _guid(entries: Mapping[str, bytes], description: bytes) -> str:
    digest = hashlib.sha256(description)
    for entry in sorted(entries):
        digest.update(f"{entry}\n{len(entries[entry])}\n".encode() + entries[entry])
    return f"{{{uuid.UUID(bytes=digest.digest()[:16])}}}"


def _write(path: Path, entries: Mapping[str, bytes]) -> Path:
    """The same content gives the same bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f".{path.name}.{uuid.uuid4().hex}")
    with zipfile.ZipFile(unfinished, "w") as archive:
        for entry, content in entries.items():
            information = zipfile.ZipInfo(entry, (2000, 1, 1, 0, 0, 0))
            information.compress_type, information.create_system, information.external_attr = zipfile.ZIP_DEFLATED, 3, 0o644 << 16
            archive.writestr(information, content)
    unfinished.replace(path)
    return path
