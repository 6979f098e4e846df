"""What a checkpoint belongs to: scenario, parameters, FMUs and versions; and the blueprint made from that again."""

from __future__ import annotations

import hashlib
import platform
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from orchestrator.blueprint import Blueprint, draw_up
from orchestrator.checkpoint.file import CheckpointError
from orchestrator.fmi.unpack import content_hash
from orchestrator.results.provenance import DISTRIBUTION, scenario_text
from orchestrator.scenario.expand import Scenario, expand
from orchestrator.scenario.locate import find_fmu, fmu_folder
from orchestrator.scenario.read import check_table

_SOURCES = ("master", "fmi", "checkpoint")


def origin(blueprint: Blueprint) -> dict[str, Any]:
    """As JSON knows it."""
    return {
        "made_with": made_with(),
        "where": blueprint.scenario.where,
        "path": str(blueprint.path.resolve()) if blueprint.path else None,
        "scenario": scenario_text(blueprint.scenario.as_run()),
        "values": blueprint.values,
        "fmus": {name: interface.sha256 for name, interface in blueprint.interfaces.items()},
    }


def blueprint_of(about: Mapping[str, Any], stop_time: float | None = None) -> Blueprint:
    """The checked system a checkpoint was made of; a CheckpointError when the versions or the FMUs are others by now."""
    _require_same_versions(about["made_with"])
    tree = tomllib.loads(about["scenario"])
    if stop_time is not None:
        tree["stop_time"] = stop_time
    path = Path(about["path"]) if about["path"] else None
    scenario = expand(check_table(tree, about["where"]), about["where"])
    _require_same_fmus(scenario, path, about["fmus"])
    blueprint = draw_up(scenario, path)
    blueprint.values[:] = about["values"]
    return blueprint


@cache
def made_with() -> dict[str, str]:
    """All that could change a bit: this package's stepping and what computes for it."""
    try:
        version = metadata.version(DISTRIBUTION)
    except metadata.PackageNotFoundError:
        version = "not installed"
    return {
        DISTRIBUTION: version,
        "the master's sources": sources(_SOURCES),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "machine": f"{platform.system()} {platform.machine()}",
    }


def sources(folders: Sequence[str]) -> str:
    """Digest of this package's files in these folders."""
    package = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for file in sorted(file for folder in folders for file in (package / folder).glob("*.py")):
        digest.update(file.name.encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()[:12]


def _require_same_versions(then: Mapping[str, str]) -> None:
    now = made_with()
    for what in [*then, *(what for what in now if what not in then)]:
        if then.get(what) != now.get(what):
            raise CheckpointError(
                f"checkpoint: made with {what} {then.get(what)}, this is {now.get(what)}, so the run would not go on with the same bits;"
                " resume with the version that wrote it, or run again"
            )


def _require_same_fmus(scenario: Scenario, path: Path | None, hashes: Mapping[str, str]) -> None:
    folder = fmu_folder(scenario.table.fmus, path)
    known: dict[Path, str] = {}
    for unit in scenario.units:
        fmu = find_fmu(unit.fmu, folder, f"{scenario.where}: units.{unit.name}")
        known[fmu] = known.get(fmu) or content_hash(fmu)
        if known[fmu] != hashes[unit.name]:
            raise CheckpointError(
                f"{unit.name}: {fmu} has changed since the checkpoint (SHA-256 {hashes[unit.name][:12]} then, {known[fmu][:12]} now);"
                " put the old file back, or run again"
            )
