"""A scenario file and the files it extends -> one checked table."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from orchestrator.errors import ScenarioError, nearest
from orchestrator.scenario.faults import first_fault
from orchestrator.scenario.model import ScenarioTable, known_keys

Tree = dict[str, Any]
SSP = ".ssp"


def read_table(path: Path, variant: str = "") -> Tree:
    """The scenario as a plain tree: overlays merged, paths made absolute, nothing checked yet. `variant` picks a system of an .ssp."""
    if path.suffix == SSP:
        return _read_ssp(path, variant)
    if variant:
        raise ScenarioError(f"--variant {variant}: {path.name} is a scenario file, variants are in an .ssp; leave it out")
    return _read(path, ())


def check_table(tree: Mapping[str, Any], where: str) -> ScenarioTable:
    """The tree as a ScenarioTable, or one line about the first thing wrong with it."""
    try:
        table = ScenarioTable.model_validate(tree)
    except ValidationError as error:
        raise ScenarioError(f"{where}: {first_fault(error, known_keys)}") from None
    if not table.stop_time > table.start_time:
        raise ScenarioError(
            f"{where}: stop_time {table.stop_time:g} s is not after start_time {table.start_time:g} s; set a later stop_time"
        )
    return table


def merge(base: Tree, overlay: Tree) -> Tree:
    """Tables merge key by key, an overlay's connections are added to the base's, anything else replaces what was there.

    A unit that is given another FMU is another unit: nothing of the base's table for it stays. `disconnect` takes connections of the
    base away.
    """
    merged = _merged(_without_replaced_units(base, overlay), overlay)
    if "disconnect" in merged:
        merged["connections"] = _left(base.get("connections", []), merged.pop("disconnect")) + list(overlay.get("connections", []))
    return merged


def _without_replaced_units(base: Tree, overlay: Tree) -> Tree:
    units, new = base.get("units"), overlay.get("units")
    if not isinstance(units, dict) or not isinstance(new, dict):
        return base

    def replaced(name: str) -> bool:
        one, other = units[name], new.get(name)
        return isinstance(one, dict) and isinstance(other, dict) and "fmu" in other and other["fmu"] != one.get("fmu")

    return base | {"units": {name: {} if replaced(name) else unit for name, unit in units.items()}}


def _left(connections: list[Tree], patterns: Any) -> list[Tree]:
    """Connections none of whose ends is named by a glob over "unit", "unit.port" or "unit.variable"."""
    if not isinstance(patterns, list) or not all(isinstance(pattern, str) for pattern in patterns):
        raise ScenarioError(f'disconnect = {patterns!r}: expects a list of names, e.g. ["guidance", "body.effect1"]')
    ends = [[str(end) for end in connection.get("ports") or (connection.get("from"), connection.get("to"))] for connection in connections]
    for pattern in patterns:
        if not any(_names(pattern, end) for both in ends for end in both):
            known = [end for both in ends for end in both]
            raise ScenarioError(f'disconnect: "{pattern}" is an end of no connection of the base; {nearest(pattern, known)}')
    named = [any(_names(pattern, end) for pattern in patterns for end in both) for both in ends]
    return [connection for connection, gone in zip(connections, named, strict=True) if not gone]


def _names(pattern: str, end: str) -> bool:
    literal = pattern.replace("[", "[[]")
    return fnmatchcase(end, literal) or fnmatchcase(end.partition(".")[0], literal)


def _merged(base: Tree, overlay: Tree) -> Tree:
    merged = dict(base)
    for key, value in overlay.items():
        if isinstance(value, dict) and isinstance(merged.get(key), dict):
            merged[key] = _merged(merged[key], value)
        elif key == "connections" and isinstance(value, list) and isinstance(merged.get(key), list):
            merged[key] = [*merged[key], *value]
        else:
            merged.pop(key, None)  # to the end: what is said last counts, of a vector and its elements too
            merged[key] = value
    return merged


def _read(path: Path, above: tuple[Path, ...]) -> Tree:
    if path.resolve() in above:
        raise ScenarioError(f"{path}: extends itself by way of {above[-1].name}; remove one `extends`")
    try:
        tree = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        asked = f' (extended by {above[-1].name})' if above else ""
        raise ScenarioError(f"{path}: no such file{asked}; `orchestrator list` shows the scenarios there are") from None
    except tomllib.TOMLDecodeError as error:
        raise ScenarioError(f"{path}: not valid TOML: {error}; correct it there") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioError(f"{path}: cannot be read ({error}); give a TOML file in UTF-8") from None
    _anchor_paths(tree, path.parent)
    extended = tree.pop("extends", None)
    if extended is None:
        if "disconnect" in tree:
            raise ScenarioError(f"{path}: disconnect: takes connections of a base away, but nothing is extended; remove it")
        return tree
    if not isinstance(extended, str):
        raise ScenarioError(f"{path}: extends = {extended!r}: expects the name of one TOML file")
    file, mark, variant = extended.partition(f"{SSP}#")
    if mark or extended.endswith(SSP):
        base = _read_ssp(path.parent / (file + SSP if mark else extended), variant)
    else:
        base = _read(path.parent / extended, (*above, path.resolve()))
    try:
        return merge(base, tree)
    except ScenarioError as error:
        raise ScenarioError(f"{path.name}: {error}") from None


def _read_ssp(path: Path, variant: str) -> Tree:
    from orchestrator.ssp.scenario import read_system  # brings lxml and FMPy, and most scenarios are not one

    return read_system(path, variant)


def _anchor_paths(tree: Tree, folder: Path) -> None:
    """Paths are relative to the file that states them, also when another folder's file extends it."""
    if isinstance(tree.get("fmus"), str):
        tree["fmus"] = str((folder / tree["fmus"]).resolve())
    terrain = tree.get("terrain")
    if isinstance(terrain, dict) and isinstance(terrain.get("file"), str):
        terrain["file"] = str((folder / terrain["file"]).resolve())
    units = tree.get("units")
    for unit in units.values() if isinstance(units, dict) else ():
        if isinstance(unit, dict) and isinstance(unit.get("fmu"), str) and is_path(unit["fmu"]):
            unit["fmu"] = str((folder / unit["fmu"]).resolve())


def is_path(fmu: str) -> bool:
    return fmu.endswith(".fmu") or "/" in fmu or "\\" in fmu
