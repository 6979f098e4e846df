"""Exports, and runs of what was exported, in processes of their own, and what must then be equal."""

import json
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from checkpoint_runs import orchestrator
from lxml import etree
from numpy.typing import NDArray

Columns = dict[str, NDArray[np.float64]]
_RUN = """
import json, os, sys
from pathlib import Path
import numpy as np
from orchestrator.simulation import Simulation, draw_up, read_scenario
asked = json.loads(sys.argv[1])
path = Path(asked["path"])
simulation = Simulation(draw_up(read_scenario(path, asked["overrides"], {"stop_time": asked["stop"]}, asked["variant"]), path))
result = simulation.run()
assert not result.message, result.message
np.savez(asked["out"], time=result.times, **result.columns)
os._exit(0)
"""


def exported(scenario: object, ssp: Path, *arguments: object) -> Path:
    """An export that succeeds without a word."""
    done = orchestrator("export", scenario, "--ssp", ssp, *arguments, cwd=ssp.parent)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return ssp


def columns(scenario: object, stop: float = 0.05, overrides: Sequence[str] = (), variant: str = "") -> Columns:
    """What a run recorded, `time` with it; in a process of its own, without the files a run writes."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "columns.npz"
        asked = json.dumps({"path": str(scenario), "out": str(out), "stop": stop, "overrides": list(overrides), "variant": variant})
        done = subprocess.run([sys.executable, "-c", _RUN, asked], capture_output=True, text=True, timeout=1800)
        assert done.returncode == 0, done.stderr
        with np.load(out) as stored:
            return dict(stored)


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
