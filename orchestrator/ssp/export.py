"""A scenario, and its variants, as one .ssp: start conditions solved, FMUs inside."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from orchestrator.blueprint import Blueprint, draw_up, read_scenario
from orchestrator.errors import SspError
from orchestrator.master.slave import Kind, Value
from orchestrator.results import references
from orchestrator.scenario.read import read_table
from orchestrator.scenario.record import matching_outputs
from orchestrator.simulation import Simulation
from orchestrator.ssp.names import DEFAULT_SSD, RESOURCES
from orchestrator.ssp.write import description, text_of
from orchestrator.terrain.hand_over import MAP

_NAME = re.compile(r"[A-Za-z0-9_+.\-]+")
_MADE = (1980, 1, 1, 0, 0, 0)
"""Times of all members: the same scenario and FMUs give the same file to the byte."""

_IN_THE_DESCRIPTION = ("fmu", "parameters")
_AS_KIND: dict[Kind, Callable[[float], Value]] = {Kind.REAL: float, Kind.INTEGER: int, Kind.BOOLEAN: bool}


@dataclass
class Contents:
    """Members of the archive by name."""

    texts: dict[str, bytes] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)
    hashes: dict[str, str] = field(default_factory=dict)
    """SHA-256 of an FMU -> its name in the archive."""

    def beside(self, path: Path) -> str:
        """The name a file gets that the annotation mentions; another of that name gets another."""
        member, number = f"{RESOURCES}/{path.name}", 1
        while member in self.files and self.files[member].resolve() != path.resolve():
            number += 1
            member = f"{RESOURCES}/{path.stem}-{number}{path.suffix}"
        self.files[member] = path
        return member

    def fmu(self, path: Path, sha256: str) -> str:
        """The name an FMU gets; two versions of one unit get two."""
        if sha256 not in self.hashes:
            member, number = f"{RESOURCES}/{path.stem}.fmu", 1
            while member in self.files:
                number += 1
                member = f"{RESOURCES}/{path.stem}-{number}.fmu"
            self.hashes[sha256], self.files[member] = member, path
        return self.hashes[sha256]


def export(
    path: Path, to: Path, overrides: Sequence[str] = (), variants: Mapping[str, Path] | None = None, outputs: Sequence[str] = (),
    step: float | None = None,
) -> list[str]:
    """Write the .ssp; the names of the descriptions in it."""
    contents = Contents()
    _add(contents, DEFAULT_SSD, draw_up(read_scenario(path, overrides), path), outputs, step)
    for name, overlay in (variants or {}).items():
        if not _NAME.fullmatch(name) or f"{name}.ssd" == DEFAULT_SSD:
            raise SspError(f'--variant {name}: expects a name of letters, digits, + - _ and .; choose another')
        _add(contents, f"{name}.ssd", draw_up(_variant(path, overlay, overrides), path), outputs, step)
    _pack(contents, to)
    return list(contents.texts)


def export_blueprint(blueprint: Blueprint, to: Path, outputs: Sequence[str] = ()) -> None:
    """The same for a system that is drawn up already."""
    contents = Contents()
    _add(contents, DEFAULT_SSD, blueprint, outputs, None)
    _pack(contents, to)


def _variant(base: Path, overlay: Path, overrides: Sequence[str]) -> Any:
    """An overlay that extends a scenario is one; another is laid over the base."""
    tree = read_table(overlay)
    return read_scenario(overlay, overrides) if "stop_time" in tree else read_scenario(base, overrides, tree)


def _add(contents: Contents, ssd: str, blueprint: Blueprint, outputs: Sequence[str], step: float | None) -> None:
    values = solved_values(blueprint)
    for given in values:
        if given.get(MAP):
            given[MAP] = contents.beside(Path(str(given[MAP])))
    sources = [contents.fmu(_file(name, i.path), i.sha256) for name, i in blueprint.interfaces.items()]
    annotation = _annotation(contents, blueprint)
    where = f"{blueprint.scenario.where}: --output"
    shown = matching_outputs(outputs, blueprint.interfaces, where) if outputs else [[] for _ in sources]
    name = ssd.removesuffix(".ssd") if ssd != DEFAULT_SSD else blueprint.scenario.where.removesuffix(".toml")
    fixed = blueprint.scenario.table.master.min_interval if step is None else step
    contents.texts[ssd] = text_of(description(name, blueprint, values, sources, shown, annotation, fixed))


def solved_values(blueprint: Blueprint) -> list[dict[str, Value]]:
    """Start values by unit: what the scenario sets, its start condition solved, and what each connected input is at the start."""
    simulation = Simulation(blueprint)
    try:
        simulation.initialise()
        values = [dict(given) for given in blueprint.values]
        faces = list(blueprint.interfaces.values())
        for link in blueprint.links:
            kind = faces[link.target_unit].variables[link.target].kind
            if kind in _AS_KIND:
                value = simulation.master.value(link.source_unit, link.source)
                values[link.target_unit][link.target] = _AS_KIND[kind](value)
    finally:
        simulation.close()
    return values


def _annotation(contents: Contents, blueprint: Blueprint) -> dict[str, Any]:
    """What SSP has no words for. Units, values and connections stand in the description; this says how the master takes them."""
    tree = blueprint.scenario.as_run()
    for key in ("fmus", "start_time", "stop_time"):
        tree.pop(key, None)
    manners = {name: {key: value for key, value in unit.items() if key not in _IN_THE_DESCRIPTION} for name, unit in tree["units"].items()}
    tree["units"] = {name: manner for name, manner in manners.items() if any(manner.values())}
    published = references.find(tree.get("results", {}).get("references"), references.folders_of(blueprint.path))
    height_map = tree.get("terrain", {}).get("file")
    for table, key, path in (("results", "references", published), ("terrain", "file", height_map)):
        if path is not None:
            tree[table] = tree[table] | {key: contents.beside(Path(path))}
    return {key: value for key, value in tree.items() if value not in ({}, [], "")}


def _file(unit: str, path: Path | None) -> Path:
    if path is None:
        raise SspError(f"{unit}: is not an FMU; only FMUs go into an .ssp")
    return path


def _pack(contents: Contents, to: Path) -> None:
    try:
        to.parent.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(to, "w") as archive:
            for name, text in contents.texts.items():
                archive.writestr(zipfile.ZipInfo(name, _MADE), text, zipfile.ZIP_DEFLATED)
            for name, path in contents.files.items():
                archive.writestr(zipfile.ZipInfo(name, _MADE), path.read_bytes(), zipfile.ZIP_STORED)
    except OSError as error:
        raise SspError(f"{to}: cannot be written ({error.strerror or error}); choose another place") from None
