"""Packing: a unit, the whole package and pythonfmu's binaries become one .fmu, the same bytes whenever the content is the same."""

import hashlib
import uuid
import zipfile
from pathlib import Path
from xml.etree.ElementTree import Element, indent, tostring

import pythonfmu

from .description import model_description
from .documentation import documentation
from .main_script import source_digest
from .reference import FOLDER
from .terminals import terminals_and_icons
from .unit import Unit

PACKAGE = Path(__file__).parent.parent
ICONS = Path(__file__).parents[2] / "icons"  # beside the package, as the reference experiments are
PYTHONFMU = Path(pythonfmu.__file__).parent
MIDNIGHT = (2000, 1, 1, 0, 0, 0)


def packed(unit: type[Unit], folder: Path) -> Path:
    """Write NAME.fmu into a folder and give its path."""
    name, digest = unit.__name__, source_digest(PACKAGE)
    script = f"{name}_{digest}"
    entries: dict[str, bytes] = {
        f"resources/{script}.py": main_script(unit, digest).encode(),
        "resources/slavemodule.txt": script.encode(),
        "documentation/index.html": documentation(unit).encode(),
        "terminalsAndIcons/terminalsAndIcons.xml": xml(terminals_and_icons(unit)),
        **python_files(PACKAGE, "resources/lander"),
        **python_files(PYTHONFMU, "resources/pythonfmu", deep=False),
        **binaries(name),
        **icons(name),
    }
    if (FOLDER / f"{name}.csv").exists():
        entries["documentation/reference.csv"] = (FOLDER / f"{name}.csv").read_bytes()
    entries = {"modelDescription.xml": xml(model_description(unit, guid_of(entries))), **entries}
    folder.mkdir(parents=True, exist_ok=True)
    path, unfinished = folder / f"{name}.fmu", folder / f".{name}.{uuid.uuid4().hex}"
    with zipfile.ZipFile(unfinished, "w") as archive:
        for entry in entries:
            archive.writestr(information(entry), entries[entry], compresslevel=6)
    unfinished.replace(path)  # a reader finds the old file or the new one, whole
    return path


def main_script(unit: type[Unit], digest: str) -> str:
    """The text of main_script.py and the one line that names the unit."""
    file = unit.__module__.rpartition(".")[2]
    text = (PACKAGE / "shell" / "main_script.py").read_text("utf-8")
    return f'{text}\n\n{unit.__name__} = unit_class(globals(), "{file}", "{unit.__name__}", "{digest}")\n'


def python_files(package: Path, target: str, deep: bool = True) -> dict[str, bytes]:
    """A package's Python files under their names in the archive."""
    found = package.rglob("*.py") if deep else package.glob("*.py")
    return {f"{target}/{file.relative_to(package).as_posix()}": file.read_bytes() for file in sorted(found)}


def binaries(name: str) -> dict[str, bytes]:
    """pythonfmu's binaries, named after the unit."""
    folder = PYTHONFMU / "resources" / "binaries"
    files = sorted(file for file in folder.rglob("*") if file.suffix in (".so", ".dll", ".dylib"))
    return {f"binaries/{file.parent.name}/{name}{file.suffix}": file.read_bytes() for file in files}


def icons(name: str) -> dict[str, bytes]:
    """The unit's icon and that of its terminals; model.png is where FMI 2.0 has it."""
    wanted = {"terminalsAndIcons/icon": name, "terminalsAndIcons/port": "port"}
    files = {f"{entry}{kind}": ICONS / f"{stem}{kind}" for entry, stem in wanted.items() for kind in (".png", ".svg")}
    files["model.png"] = ICONS / f"{name}.png"
    return {entry: file.read_bytes() for entry, file in files.items() if file.exists()}


def guid_of(entries: dict[str, bytes]) -> str:
    """A GUID that changes with any file of the FMU and with nothing else."""
    digest = hashlib.sha256()
    for name in sorted(entries):
        digest.update(f"{name}\n{len(entries[name])}\n".encode() + entries[name])
    return f"{{{uuid.UUID(bytes=digest.digest()[:16])}}}"


def information(name: str) -> zipfile.ZipInfo:
    """An entry of the archive without the clock, the user or the system in it."""
    entry = zipfile.ZipInfo(name, MIDNIGHT)
    entry.compress_type, entry.create_system, entry.external_attr = zipfile.ZIP_DEFLATED, 3, 0o644 << 16
    return entry


def xml(root: Element) -> bytes:
    """An element as a file."""
    indent(root)
    content: bytes = tostring(root, encoding="UTF-8", xml_declaration=True)
    return content + b"\n"
