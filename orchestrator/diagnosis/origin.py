"""What a diagnosis was made from, so that its numbers can be had again: versions, units, scenario, data, seed."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.results.provenance import git_state, package_versions, scenario_text
from orchestrator.scenario.read import read_table

SHOWN = 16  # digits of a hash


def flown_units(addresses: Addresses) -> list[Path]:
    """The FMUs of the scenario, wherever they lie, and all others of its folder: an effect may add one."""
    own = [interface.path for interface in addresses.blueprint.interfaces.values() if interface.path is not None]
    return sorted({path.resolve() for path in (*addresses.folder.glob("*.fmu"), *own)})


def flown_otherwise(addresses: Addresses, scenario: Path, overrides: Sequence[str]) -> str:
    """All that the master is told of a scenario beyond its parameters' numbers: settings, connections, texts and the files they name."""
    texts = [value for values in addresses.blueprint.values for value in values.values() if isinstance(value, str)]
    files = [path for text in texts for path in (Path(text), scenario.parent / text) if text and path.is_file()]
    said = "\n".join([scenario_text(read_table(scenario)), *overrides, *texts])
    return _hash(said.encode(), *(path.read_bytes() for path in files))


def code() -> str:
    """Of the search itself and of the arithmetic below it: what an earlier version flew or fitted is not to be taken for its own."""
    package = Path(__file__).resolve().parents[1]
    return _hash(*(path.read_bytes() for path in sorted(package.rglob("*.py"))), version("numpy").encode(), version("scipy").encode())


def provenance(scenario: Path, data: Sequence[Path], units: Sequence[Path], settings: Mapping[str, Any]) -> dict[str, Any]:
    """Of the scenario with all it extends. data: folders of measured data; settings: what the command was told besides."""
    return {
        "python": f"{platform.python_version()}, {platform.system()} {platform.machine()}",
        "packages": package_versions(),
        "git": git_state(Path(__file__).parent) or "not a repository",
        "scenario": _hash(scenario_text(read_table(scenario)).encode()),
        "data": {str(folder): _hash(*(path.read_bytes() for path in _files(folder))) for folder in data},
        "units": {unit.name: _hash(unit.read_bytes()) for unit in units},
        **settings,
    }


def _files(folder: Path) -> list[Path]:
    return [*sorted(folder.glob("*.toml")), *sorted(folder.glob("*.csv"))]


def _hash(*contents: bytes) -> str:
    return "sha256 " + sha256(b"".join(sha256(it).digest() for it in contents)).hexdigest()[:SHOWN]
