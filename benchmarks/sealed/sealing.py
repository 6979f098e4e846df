"""A diagnosis behind glass: it is given copies of two folders, in a place from which the rest of the set cannot be named.

Its working folder, its arguments and its environment hold no path of the set; where the keys are is not even known to `run`. What it opened
is noted by an audit hook (watch/sitecustomize.py) that its worker processes inherit, and scoring refuses a diagnosis that opened a key.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

from sealed.commit import ROOT, commit

WATCH = Path(__file__).resolve().parent / "watch"
COMMAND = (sys.executable, "-m", "orchestrator", "diagnose", "{scenario}", "--measured", "fit", "--holdout", "holdout",
           "--out", "out", "--seed", "{seed}", "--workers", "1")  # fmt: skip
STOPPED = -1  # exit code of a diagnosis that took too long
KEPT = ("HOME", "LANG", "PATH", "SYSTEMROOT", "TMPDIR", "NUMBA_CACHE_DIR", "VIRTUAL_ENV")


@dataclass(frozen=True)
class Diagnosis:
    """How to call it: words in which {scenario} and {seed} are filled in."""

    scenario: Path
    seed: int
    command: Sequence[str] = COMMAND
    limit: float = 7200.0
    """s of wall time."""

    def words(self) -> list[str]:
        filled = {"scenario": str(self.scenario), "seed": str(self.seed)}
        return [word.format(**filled) for word in self.command]


def environment(log: Path) -> dict[str, str]:
    """As little as the diagnosis needs; one thread, so that cases do not take each other's time."""
    kept = {name: os.environ[name] for name in KEPT if name in os.environ}
    path = os.pathsep.join(str(folder) for folder in (WATCH, ROOT, ROOT / "fmus", ROOT / "benchmarks"))
    return kept | {"PYTHONPATH": path, "SEALED_OPENED": str(log), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def diagnose(case: Path, result: Path, diagnosis: Diagnosis) -> dict[str, Any]:
    """The record of one run, also in RESULT/run.json, beside diagnosis.json and the list of files opened."""
    result.mkdir(parents=True, exist_ok=True)
    (result / "closure.json").unlink(missing_ok=True)  # of an earlier diagnosis
    with tempfile.TemporaryDirectory(prefix="sealed-") as place:
        room = Path(place)
        for name in ("fit", "holdout"):
            shutil.copytree(case / name, room / name)
        (room / "out").mkdir()
        start = perf_counter()
        exit_code, said = _call(diagnosis, room)
        record: dict[str, Any] = {"seconds": perf_counter() - start, "exit_code": exit_code, "by": commit()}
        record["command"] = shlex.join(diagnosis.words())
        found = room / "out" / "diagnosis.json"
        whole = _whole(found) if exit_code != STOPPED else None  # one that was stopped has not proved what it wrote
        if whole is not None:
            record["simulations"] = whole.get("simulations")
        opened = room / "opened.txt"
        lines = opened.read_text("utf-8").splitlines() if opened.is_file() else []
        record["opened"] = [line for line in lines if not line.startswith(place)]
        record["watched"] = opened.is_file()
        (result / "said.txt").write_text(said, "utf-8")
        (result / "run.json").write_text(json.dumps(record, indent=1) + "\n", "utf-8")
        if whole is not None:
            shutil.copyfile(found, result / "diagnosis.json")
    return record


def _whole(path: Path) -> dict[str, Any] | None:
    """A diagnosis, if it was written to its end."""
    try:
        tree: dict[str, Any] = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        return None
    return tree


def _call(diagnosis: Diagnosis, room: Path) -> tuple[int, str]:
    try:
        done = subprocess.run(diagnosis.words(), cwd=room, env=environment(room / "opened.txt"), stdin=subprocess.DEVNULL, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=diagnosis.limit, check=False)  # fmt: skip
    except subprocess.TimeoutExpired as late:
        said = late.stdout.decode("utf-8", "replace") if isinstance(late.stdout, bytes) else late.stdout or ""
        return STOPPED, f"{said}\nstopped after {diagnosis.limit:g} s"
    return done.returncode, done.stdout
