"""Scenarios run once a session through the command line, as a user runs them, each in a process of its own."""

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[2]
Array = NDArray[np.float64]
Completed = subprocess.CompletedProcess[str]


@dataclass(frozen=True)
class Landing:
    """A run directory."""

    folder: Path
    summary: dict[str, Any]

    def series(self, name: str) -> Array:
        """A recorded column over time."""
        column: Array = pq.read_table(self.folder / "history.parquet", columns=[name])[name].to_numpy()
        return column


def orchestrator(*arguments: object, limit: float = 3600.0) -> Completed:
    """The command line in the project's folder; limit: s of wall time."""
    command = [sys.executable, "-m", "orchestrator", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, timeout=limit, check=False)


@pytest.fixture(scope="session")
def landing(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Landing]:
    """`landing(scenario, *settings, tolerance=None)`: the run of a scenario in scenarios/, made when first asked for."""
    made: dict[tuple[str, ...], Landing] = {}

    def run(scenario: str, *settings: str, tolerance: float | None = None) -> Landing:
        words = [word for setting in settings for word in ("--set", setting)]
        words += [] if tolerance is None else ["--tolerance", str(tolerance)]
        key = (scenario, *words)
        if key not in made:
            folder = tmp_path_factory.mktemp(scenario)
            done = orchestrator("run", f"scenarios/{scenario}.toml", "--out", folder, "--no-figures", *words)
            assert done.returncode == 0, done.stderr
            made[key] = Landing(folder, json.loads((folder / "summary.json").read_text(encoding="utf-8")))
        return made[key]

    return run
