"""Exports, and runs of what was exported, in processes of their own, and what must then be equal."""

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
from checkpoint_runs import orchestrator, run
from lxml import etree
from numpy.typing import NDArray

Columns = dict[str, NDArray[np.float64]]


def exported(scenario: object, ssp: Path, *arguments: object) -> Path:
    """An export that succeeds without a word."""
    done = orchestrator("export", scenario, "--ssp", ssp, *arguments, cwd=ssp.parent)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return ssp


def columns(scenario: object, out: Path, *arguments: object) -> Columns:
    """What a run recorded."""
    table = pq.read_table(run(scenario, out, *arguments) / "history.parquet")
    return {name: table[name].to_numpy() for name in table.column_names}


def same_bits(one: Columns, other: Columns) -> None:
    assert one.keys() == other.keys()
    for name in one:
        assert one[name].tobytes() == other[name].tobytes(), name


def description(ssp: Path, name: str = "SystemStructure.ssd") -> Any:
    """The root element of a description in an .ssp."""
    with zipfile.ZipFile(ssp) as archive:
        return etree.fromstring(archive.read(name))


def packed(ssp: Path, texts: dict[str, str | bytes], files: dict[str, Path] | None = None) -> Path:
    """An .ssp of these members; what it held before stays where it is not replaced."""
    members: dict[str, str | bytes] = {}
    if ssp.exists():
        with zipfile.ZipFile(ssp) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
    members |= texts | {name: path.read_bytes() for name, path in (files or {}).items()}
    with zipfile.ZipFile(ssp, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return ssp
