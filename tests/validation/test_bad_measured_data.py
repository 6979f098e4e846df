"""Measured data with faults in them, through the command line: one line and exit code 2, or a verdict of a data fault and exit code 3."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import ROOT, Completed, orchestrator
from hidden_landings import Case, Vehicle, write

Change = Callable[[list[list[str]]], None]


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A landing with nothing wrong."""
    folder = tmp_path_factory.mktemp("good")
    write(Vehicle(), Case("", 0.0, 13, "nothing_missing"), folder)
    return folder / "fit"


@pytest.fixture
def folder(good: Path, tmp_path: Path) -> Path:
    shutil.copytree(good, tmp_path / "landing")
    return tmp_path / "landing"


def diagnose(folder: Path) -> Completed:
    options = ("--out", folder.parent / "out", "--verdict-only", "--workers", 1)
    return orchestrator("diagnose", "apollo11_zupp", "--measured", folder, *options)


def rewrite(folder: Path, change: Change, name: str = "rates.csv") -> None:
    """Change the rows of a series, the header among them."""
    path = folder / name
    rows = [line.split(",") for line in path.read_text("utf-8").splitlines()]
    change(rows)
    path.write_text("\n".join(",".join(row) for row in rows) + "\n", "utf-8")


def edit(folder: Path, old: str, new: str) -> None:
    path = folder / "landing.toml"
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), "utf-8")


def refused(done: Completed, *words: str) -> None:
    assert done.returncode == 2, done.stderr + done.stdout
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert "Traceback" not in done.stderr
    for word in words:
        assert word in done.stderr


def faulty(done: Completed, out: Path, *words: str) -> None:
    assert done.returncode == 3, done.stderr + done.stdout
    assert "Traceback" not in done.stderr
    found = json.loads((out / "diagnosis.json").read_text("utf-8"))
    assert found["verdict"] == "data_fault"
    for word in words:
        assert word in json.dumps(found["faults"])
    assert found["sentence"]


def field(folder: Path, table: str, key: str) -> str:
    """The line of a key in a table of landing.toml."""
    text = (folder / "landing.toml").read_text("utf-8")
    part = text[text.index(f"[{table}]") :]
    return next(line for line in part.splitlines() if line.startswith(key))


def test_a_column_that_is_missing_is_named(folder: Path) -> None:
    rewrite(folder, lambda rows: [row.pop(1) for row in rows] and None)
    refused(diagnose(folder), "rates", "no column")


def test_an_unknown_unit_is_named(folder: Path) -> None:
    line = field(folder, "series.rates", "unit")
    edit(folder, line, 'unit = "furlong/s"')
    refused(diagnose(folder), "furlong/s")


def test_time_that_goes_backwards_is_named(folder: Path) -> None:
    def back(rows: list[list[str]]) -> None:
        rows[10], rows[11] = rows[11], rows[10]

    rewrite(folder, back)
    refused(diagnose(folder), "rates.csv", "time")


def test_a_sigma_of_zero_is_refused(folder: Path) -> None:
    line = field(folder, "series.rates", "sigma")
    edit(folder, line, "sigma = 0.0")
    refused(diagnose(folder), "sigma")


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    refused(diagnose(tmp_path / "nowhere"), "nowhere")


def test_a_stuck_channel_is_a_data_fault(folder: Path) -> None:
    def stick(rows: list[list[str]]) -> None:
        for row in rows[4:30]:
            row[1] = rows[4][1]

    rewrite(folder, stick)
    faulty(diagnose(folder), folder.parent / "out", "rates.")


def test_swapped_axes_are_a_data_fault(folder: Path) -> None:
    def swap(rows: list[list[str]]) -> None:
        rates = rows[0].index("pitch_rate"), rows[0].index("roll_rate")
        for row in rows[1:]:
            row[rates[0]], row[rates[1]] = row[rates[1]], row[rates[0]]

    rewrite(folder, swap)
    faulty(diagnose(folder), folder.parent / "out", "rates.pitch", "rates.roll")


def keys(out: Path) -> set[str]:
    return {path.name for path in (out / ".work").glob("[0-9a-f]*")} if out.exists() else set()


def interrupted(folder: Path, out: Path, workers: int, enough: int) -> tuple[int, str]:
    """Exit code and stderr of a diagnosis that hears Ctrl-C, as its processes do, once the store holds enough."""
    command = [sys.executable, "-m", "orchestrator", "diagnose", "apollo11_zupp", "--measured", folder, "--out", out]
    command += ["--verdict-only", "--workers", workers]
    process = subprocess.Popen([str(c) for c in command], cwd=ROOT, stderr=subprocess.PIPE, text=True, start_new_session=True)
    deadline = time.monotonic() + 1800.0
    while len(keys(out)) < enough and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=600.0)
    return process.returncode, said


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="a process group hears SIGINT on POSIX only")
def test_gaps_are_accepted_and_a_diagnosis_goes_on_after_ctrl_c(folder: Path, tmp_path: Path) -> None:
    def gaps(rows: list[list[str]]) -> None:
        for row in rows[5:9]:
            row[2] = "nan"

    rewrite(folder, gaps)
    out, fresh = tmp_path / "out", tmp_path / "fresh"
    code, said = interrupted(folder, out, 2, 4)
    assert code == 130, said
    assert len(said.strip().splitlines()) == 1, said
    assert said.startswith("interrupted:")
    first = keys(out)
    code, said = interrupted(folder, out, 1, len(first) + 1)
    assert code == 130, said
    second = keys(out)
    assert second > first
    interrupted(folder, fresh, 1, len(second) + 2)
    assert second <= keys(fresh), "the second call did not go on along the first one's path"
