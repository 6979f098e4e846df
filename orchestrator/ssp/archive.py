"""An .ssp on disk: unpacked under its content's hash, its documents parsed, those of SSP 1.0 held against the standard's schemas."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from lxml import etree

from orchestrator.errors import SspError, nearest
from orchestrator.fmi.unpack import content_hash, unpack
from orchestrator.ssp.names import DEFAULT_SSD, tag

_SCHEMAS = {
    "SystemStructureDescription": "SystemStructureDescription.xsd",
    "ParameterSet": "SystemStructureParameterValues.xsd",
    "ParameterMapping": "SystemStructureParameterMapping.xsd",
}
_NAMESPACE = re.compile(r"\{[^}]*\}")
_VERSIONS = ("1.", "2.")


@dataclass(frozen=True)
class Archive:
    """One description in an unpacked .ssp."""

    folder: Path
    where: str
    """Opens messages: "system.ssp" or "system.ssp#variant.ssd"."""
    description: Any
    """Root element of the .ssd."""

    def file(self, source: str, who: str) -> Path:
        """The file a `source` names; it must lie inside the archive."""
        parts = urlsplit(source)
        path = (self.folder / unquote(parts.path)).resolve()
        if parts.scheme or parts.netloc or not parts.path or not path.is_relative_to(self.folder.resolve()):
            raise SspError(f'{self.where}: {who}: source "{source}" is not inside the archive; put the file in and name it relative')
        if not path.is_file():
            there = [p.relative_to(self.folder).as_posix() for p in self.folder.rglob("*") if p.is_file()]
            raise SspError(f'{self.where}: {who}: "{source}" is not in the archive; {nearest(source, there)}')
        return path

    def document(self, source: str, who: str) -> Any:
        """The root of another document in the archive (.ssv, .ssm)."""
        return parsed(self.file(source, who), f"{self.where}: {source}")


def opened(path: Path, variant: str = "") -> Archive:
    """The default description of an .ssp, or the one of a variant."""
    if not path.is_file():
        raise SspError(f"{path}: no such file; name an .ssp")
    folder = unpack(path, content_hash(path))
    name = f"{variant.removesuffix('.ssd')}.ssd" if variant else DEFAULT_SSD
    where = f"{path.name}#{name}" if variant else path.name
    if not (folder / name).is_file():
        if not variant:
            raise SspError(f"{path}: holds no {DEFAULT_SSD}; is it an .ssp?")
        raise SspError(f'{path}: no variant "{variant}"; {nearest(variant, variants(folder))}')
    return Archive(folder, where, parsed(folder / name, where))


def variants(folder: Path) -> list[str]:
    """Names of the descriptions beside the default one."""
    return sorted(ssd.stem for ssd in folder.glob("*.ssd") if ssd.name != DEFAULT_SSD)


def parsed(path: Path, where: str) -> Any:
    """The root element of a document, valid by the schema where it is SSP 1.0."""
    reader = etree.XMLParser(resolve_entities=False, no_network=True, remove_comments=True, remove_pis=True)
    try:
        root = etree.parse(str(path), reader).getroot()
    except etree.XMLSyntaxError as error:
        raise SspError(f"{where}: not well-formed XML ({error.msg}); export it again") from None
    version = root.get("version", "")
    if not version.startswith(_VERSIONS):
        raise SspError(f'{where}: is of version "{version}", expects 1.0 or 2.0; export it as one of these')
    if version.startswith("1."):
        complaint = schema_fault(root)
        if complaint:
            raise SspError(f"{where}: not valid SSP 1.0: {complaint}; correct it there")
    return root


def schema_fault(root: Any) -> str:
    """The first thing the standard's schema has against a document of SSP 1.0; "" where there is nothing."""
    kind = etree.QName(root).localname
    if kind not in _SCHEMAS:
        return f"unknown root element {kind}"
    schema = _schema(kind)
    if schema.validate(root):
        return ""
    first = schema.error_log[0]
    message = _NAMESPACE.sub("", first.message).replace("\n", " ").rstrip(". ")
    return f"line {first.line}: {message}"


@cache
def _schema(kind: str) -> Any:
    """FMPy brings the standard's schema files (BSD-2-Clause) with it."""
    import fmpy.ssp

    return etree.XMLSchema(file=str(Path(fmpy.ssp.__file__).parent / "schema" / _SCHEMAS[kind]))


def first(element: Any, *names: str) -> Any:
    """The first descendant along these names, or None."""
    for name in names:
        element = None if element is None else element.find(tag(name))
    return element


def every(element: Any, *names: str) -> list[Any]:
    """All children of the last name below the first descendant along the others."""
    parent = first(element, *names[:-1])
    return [] if parent is None else list(parent.findall(tag(names[-1])))
