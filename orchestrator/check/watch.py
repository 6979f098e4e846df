"""Runs a trial in a process of its own and says what became of it: findings, a crash with the place and the signal, or a hang."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep
from typing import Any

from orchestrator.check.finding import Finding, Verdict

_LOOKS = 0.02
"""s between two looks at the process."""
_START = 60.0
"""s at least until the process says its first word: Python's own start is not the unit's."""
_MOST_CRASHES = 4
_PROBE = "probe "


@dataclass
class Heard:
    """What a trial said before it ended, in whatever way."""

    findings: list[Finding] = field(default_factory=list)
    kept: dict[str, Any] = field(default_factory=dict)
    at: str = "start of the process"
    """The last action begun; empty: it came to its end."""
    end: str = ""
    """How it ended, if not well."""


def watched(trial: str, job: Mapping[str, Any], timeout: float) -> Heard:
    """A trial; one that dies on a probe is begun again without that probe."""
    whole, skip = Heard(), list[str]()
    for _ in range(_MOST_CRASHES):
        heard = _once(trial, {**job, "skip": skip}, timeout)
        whole.findings += heard.findings
        whole.kept |= heard.kept
        whole.at, whole.end = heard.at, heard.end
        if not heard.end:
            break
        do = "run it there in a debugger" if "signal" in heard.end else "look for an endless loop, or raise --timeout"
        whole.findings.append(Finding(trial, Verdict.FAIL, f"{heard.end} at {heard.at}", do=do))
        if not heard.at.startswith(_PROBE):
            break
        skip.append(heard.at.removeprefix(_PROBE))
    if any(finding.verdict is Verdict.FAIL for finding in whole.findings):
        whole.findings = [finding for finding in whole.findings if finding.verdict is not Verdict.PASS or finding.check != trial]
    return whole


def _once(trial: str, job: Mapping[str, Any], timeout: float) -> Heard:
    with TemporaryDirectory(prefix="check_") as folder:
        given, said, shouted = (Path(folder) / name for name in ("job.json", "said.jsonl", "stderr.txt"))
        given.write_text(json.dumps(job), "utf-8")
        said.touch()
        command = [sys.executable, "-m", "orchestrator.check.child", trial, str(given), str(said)]
        with shouted.open("wb") as errors:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=errors, stderr=errors)
            end = _wait(process, said, timeout)
        heard = _read(said)
        if end:
            heard.end = end
        elif process.returncode:
            heard.end = _death(process.returncode, shouted)
        elif heard.at:
            heard.end = "left the process"
        return heard


def _wait(process: subprocess.Popen[bytes], said: Path, timeout: float) -> str:
    """Until it ends; or says nothing more for `timeout` seconds, and is killed."""
    size, since = -1, monotonic()
    while process.poll() is None:
        now = said.stat().st_size
        if now != size:
            size, since = now, monotonic()
        elif monotonic() - since > (timeout if size else max(timeout, _START)):
            process.kill()
            process.wait()
            return f"hung for {timeout:g} s"
        sleep(_LOOKS)
    return ""


def _death(code: int, shouted: Path) -> str:
    if code < 0:
        try:
            name = f", {signal.Signals(-code).name}"
        except ValueError:
            name = ""
        return f"crashed (signal {-code}{name})"
    lines = shouted.read_text("utf-8", "replace").strip().splitlines()
    return f"ended with exit code {code}" + (f" ({lines[-1][:200]})" if lines else "")


def _read(said: Path) -> Heard:
    heard = Heard()
    for line in said.read_text("utf-8").splitlines():
        try:
            entry = json.loads(line)
        except ValueError:      # cut off by the crash
            continue
        if "at" in entry:
            heard.at = entry["at"]
        elif "finding" in entry:
            heard.findings.append(Finding.from_json(entry["finding"]))
        else:
            name, value = entry["kept"]
            heard.kept[name] = value
    return heard
