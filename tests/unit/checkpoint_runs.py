"""Runs in processes of their own that are killed, interrupted and resumed, and what must then be equal."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

WALL_TIME = ("wall_s", "share_outside_units", "unit_seconds_each")


def orchestrator(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "orchestrator", *map(str, arguments), "--quiet"]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=1800)


def run(scenario: object, out: Path, *arguments: object) -> Path:
    """A run that succeeds without a word."""
    done = orchestrator("run", scenario, "--out", out, "--no-figures", *arguments, cwd=out.parent)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return out


def stop_a_run(scenario: object, out: Path, number: int, how: signal.Signals, *arguments: object) -> int:
    """Start a run, send a signal as soon as it has written this checkpoint; its exit code."""
    command = [sys.executable, "-m", "orchestrator", "run", str(scenario), "--out", str(out), "--no-figures", *map(str, arguments)]
    process = subprocess.Popen(command, cwd=out.parent, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ})
    while not checkpoint(out, number).exists():
        assert process.poll() is None, "ended before its checkpoint"
        time.sleep(0.001)
    process.send_signal(how)
    return process.wait(timeout=900)


def checkpoint(out: Path, number: int) -> Path:
    return out / "checkpoints" / f"checkpoint_{number:06d}.bin"


def resumed(out: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """From another folder: nothing may depend on where the run was started."""
    (out / "elsewhere").mkdir(exist_ok=True)
    return orchestrator("resume", out, "--no-figures", *arguments, cwd=out / "elsewhere")


def content(out: Path) -> dict[str, Any]:
    """All that must be the same to the last bit: every file but the pictures, without wall times and the folder's own name."""
    files: dict[str, Any] = {path.name: path.read_bytes() for path in out.iterdir() if path.suffix in (".csv", ".parquet", ".toml", ".md")}
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    del summary["directory"]
    summary["master"] = {key: value for key, value in summary["master"].items() if key not in WALL_TIME}
    inputs = json.loads((out / "inputs.json").read_text(encoding="utf-8"))
    return files | {"summary": summary, "units": inputs["units"]}
