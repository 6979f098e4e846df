"""The other masters: each in an environment of its own under build/peers, each run in a process of its own on the same FMUs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import venv
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

from packs import HERE, ROOT

FOLDER = ROOT / "build" / "peers"
TIMEOUT = 600.0  # s
PACKAGES = {
    "libcosim": ("libcosimpy==0.0.6", "pythonfmu==0.7.0"),
    "ecos": ("ecospy==0.7.2", "pythonfmu==0.7.0", "tbb==2023.2.0"),   # its library needs libtbb.so.12 and does not bring it
    "fmpy": ("fmpy==0.3.32", "pythonfmu==0.7.0"),
    "cofmupy": ("cofmupy==1.0.0",),                                    # brings pythonfmu 0.6.3
    "toolbox": ("fmu-manipulation-toolbox==2.0",),                     # no master: makes one FMU of several
}
SHOWN = {"libcosim": "libcosim", "ecos": "ecos", "fmpy": "FMPy SSP", "cofmupy": "CoFmuPy"}


@dataclass
class Outcome:
    """What one run of one master gave; `message` says why there is nothing, where there is nothing."""

    times: list[float] = field(default_factory=list)
    values: dict[str, list[float]] = field(default_factory=dict)
    step_s: float = float("nan")
    """Stepping alone, wall time."""
    whole_s: float = float("nan")
    """The whole process: start of the interpreter, loading, stepping."""
    counts: dict[str, int] = field(default_factory=dict)
    """doSteps by kind of unit, counted inside the FMUs."""
    message: str = ""


def environment(peer: str) -> tuple[Path | None, str]:
    """The interpreter of a peer's environment, made if need be; or why there is none."""
    folder = FOLDER / peer
    python = folder / "bin" / "python"
    done = folder / "made-with.txt"
    # the units need numpy and numba in whatever interpreter runs them: those of this environment, lent to all
    wanted = [*PACKAGES[peer], *(f"{name}=={version(name)} lent" for name in ("numpy", "numba"))]
    if done.exists() and done.read_text("utf-8") == "\n".join(wanted):
        return python, ""
    venv.create(folder, clear=True, symlinks=True)
    lend(folder)      # pip too
    install = [str(python), "-m", "pip", "install", "-q", "--disable-pip-version-check", *PACKAGES[peer]]
    made = subprocess.run(install, capture_output=True, text=True, check=False)
    if made.returncode:
        return None, last_line(made.stderr) or f"{install[-1]}: exit code {made.returncode}"
    done.write_text("\n".join(wanted), "utf-8")
    return python, ""


def lend(folder: Path) -> None:
    """Let an environment see this one's packages behind its own."""
    packages = Path(sysconfig.get_path("purelib", vars={"base": str(folder), "platbase": str(folder)}))
    (packages / "lent.pth").write_text(sysconfig.get_path("purelib") + "\n", "utf-8")


def run_peer(peer: str, task: dict[str, Any], timeout: float = TIMEOUT) -> Outcome:
    """One run of a peer over a job (see peers/job.py)."""
    python, complaint = environment(peer)
    if python is None:
        return Outcome(message=f"not installed: {complaint}")
    return run_script(python, HERE / "peers" / f"run_{peer}.py", task, timeout)


def run_script(python: Path, script: Path, task: dict[str, Any], timeout: float = TIMEOUT) -> Outcome:
    """A script with a job in a process of its own, its doSteps counted by the units themselves."""
    with TemporaryDirectory() as folder:
        given, result = Path(folder) / "job.json", Path(folder) / "result.json"
        given.write_text(json.dumps(task), "utf-8")
        begin = perf_counter()
        try:
            done = subprocess.run(
                [str(python), str(script), str(given), str(result)],
                capture_output=True, text=True, errors="replace", check=False, timeout=timeout,
                env={**os.environ, **embedding(python), "STEP_COUNTS": folder}, cwd=folder,
            )
        except subprocess.TimeoutExpired:
            return Outcome(message=f"stopped after {timeout:g} s", counts=counts(Path(folder)))
        whole = perf_counter() - begin
        if not result.exists():
            why = last_line(done.stderr) or last_line(done.stdout) or "no message"
            return Outcome(message=f"exit code {done.returncode}: {why}", counts=counts(Path(folder)))
        got = json.loads(result.read_text("utf-8"))
        return Outcome(got["times"], got["values"], got["step_s"], whole, counts(Path(folder)))


def embedding(python: Path) -> dict[str, str]:
    """Units written in Python find the interpreter's library among the process's own, and a host the libraries of its environment."""
    beside = {"LD_LIBRARY_PATH": str(python.parent.parent / "lib")}
    library = Path(str(sysconfig.get_config_var("LIBDIR"))) / str(sysconfig.get_config_var("INSTSONAME"))
    return {**beside, "LD_PRELOAD": str(library)} if library.suffix != ".a" and library.exists() else beside


def counts(folder: Path) -> dict[str, int]:
    return {file.stem: int.from_bytes(file.read_bytes(), sys.byteorder) for file in folder.glob("*.count")}


def last_line(text: str) -> str:
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    return lines[-1][:300] if lines else ""
