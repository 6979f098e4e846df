"""What is needed to repeat a run: the resolved scenario, and which versions of everything made the numbers."""

import json
import platform
import re
import subprocess
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from orchestrator.master.result import RunResult, UnitRecord
from orchestrator.terrain.ground import repeatable

DISTRIBUTION = "lander-touchdown"


def write_scenario(result: RunResult, path: Path) -> Path:
    """The scenario as it was run, overlays merged: one TOML file that `orchestrator run` takes."""
    lines = [f"# {result.title}", "# As run: overlays merged, settings of the command line applied."]
    if result.scenario_path is not None:
        lines.append(f"# From {result.scenario_path.name}")
    scenario = repeatable(result.scenario, result.unit_records, path.parent)
    path.write_text("\n".join(lines) + "\n\n" + scenario_text(scenario), encoding="utf-8")
    return path


def scenario_text(scenario: Mapping[str, Any]) -> str:
    """A scenario's content as TOML that gives every number back."""
    return tomli_w.dumps(_plain(scenario))


def write_inputs(result: RunResult, path: Path) -> Path:
    """Versions of Python, packages and units, and the parameters each unit was given."""
    inputs = {
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "scenario": result.scenario_path.name if result.scenario_path else None,
        "variant": result.variant or None,
        "scenario_sha256": result.scenario_sha256,
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "packages": package_versions(),
        "git": git_state(Path(__file__).parent),
        "units": {record.name: _unit(record) for record in result.unit_records},
    }
    path.write_text(json.dumps(_plain(inputs), indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    return path


def package_versions() -> dict[str, str]:
    """Installed versions of this project and of what it requires to run."""
    try:
        required = metadata.requires(DISTRIBUTION) or []
    except metadata.PackageNotFoundError:
        return {}
    names = [re.split(r"[\s<>=!~;\[]", line, maxsplit=1)[0] for line in required if "extra ==" not in line]
    versions = {}
    for name in [DISTRIBUTION, *names]:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            versions[name] = "not installed"
    return versions


def git_state(folder: Path) -> dict[str, Any] | None:
    """Commit of the source tree and whether tracked files differ from it; None outside a repository or without git."""
    try:
        commit = _git(folder, "rev-parse", "HEAD")
        return {"commit": commit, "modified": bool(_git(folder, "status", "--porcelain", "--untracked-files=no"))}
    except (OSError, subprocess.SubprocessError):
        return None


def _git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, check=True, timeout=10)
    return done.stdout.strip()


def _unit(record: UnitRecord) -> dict[str, Any]:
    return {
        "fmu": record.fmu,
        "sha256": record.sha256,
        "model_name": record.model_name,
        "guid": record.guid,
        "fmi_version": record.fmi_version,
        "generation_tool": record.generation_tool,
        "capabilities": record.capabilities,
        "rollback": record.rollback,
        "parameters": record.parameters,
    }


def _plain(value: Any) -> Any:
    """Only what TOML and JSON know: tuples and arrays as lists, paths as text, unset entries left out."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items() if item is not None}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value if item is not None]
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    return str(value) if isinstance(value, Path) else value
