"""What a user gets wrong: one line on stderr that names it, exit code 2, and nothing run; Ctrl-C keeps what there is."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import ROOT, Completed, orchestrator

ZUPP = "scenarios/apollo11_zupp.toml"


def variant(folder: Path, text: str) -> Path:
    """A scenario that extends the Zupp-like one by `text`."""
    path = folder / "variant.toml"
    path.write_text(f'extends = "{(ROOT / ZUPP).as_posix()}"\n{text}', encoding="utf-8")
    return path


def deep(folder: Path) -> Path:
    """The Zupp-like scenario without its start condition, and the body a metre too low."""
    text = (ROOT / ZUPP).read_text(encoding="utf-8")
    before, rest = text.split("[start]")
    after = rest[rest.index("[master]") :]
    path = folder / "deep.toml"
    lowered = before.replace("[units.body.parameters]", "[units.body.parameters]\nposition_start = [3.0, 0.0, 0.0]")
    path.write_text(f'fmus = "{(ROOT / "build" / "fmus").as_posix()}"\n{lowered}{after}', encoding="utf-8")
    return path


def refused(done: Completed, *words: str) -> None:
    """Assert one line with all the words, exit code 2."""
    assert done.returncode == 2, done.stderr
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert "Traceback" not in done.stderr
    for word in words:
        assert word in done.stderr


SET = {
    "an unknown parameter": ("body.mas=7000", "mas", "mass"),
    "a negative mass": ("body.mass=-7000", "mass", "-7000"),
    "a negative mass in a leg": ("leg+Z.footpad_mass=-1", "footpad_mass", "-1"),
    "nan": ("body.mass=nan", "mass", "nan"),
    "nan in the soil": ("soil+Y.friction=nan", "friction", "nan"),
}
AT_THE_START = {
    "a leg that cannot close": ("leg+Z.connection=4", "connection", "4"),
    "an inertia no body has": ("body.inertia[1]=90000", "inertia", "90000"),
}


@pytest.mark.parametrize("words", SET.values(), ids=SET)
def test_a_value_that_cannot_be_is_refused(tmp_path: Path, words: tuple[str, ...]) -> None:
    setting, *expected = words
    refused(orchestrator("run", ZUPP, "--set", setting, "--out", tmp_path / "out"), *expected)


@pytest.mark.parametrize("words", AT_THE_START.values(), ids=AT_THE_START)
def test_parameters_that_do_not_go_together_are_refused_in_the_units_words(tmp_path: Path, words: tuple[str, ...]) -> None:
    setting, *expected = words
    refused(orchestrator("run", ZUPP, "--set", setting, "--out", tmp_path / "out"), *expected)


FILES = {
    "an unknown key": ("[master]\nmax_intervall = 1e-3\n", "max_intervall", "max_interval"),
    "a wrong unit of measure": ('[[connections]]\nfrom = "soil+Z.normal_force"\nto = "leg+Z.body.position[1]"\n', "N", "m"),
    "a missing FMU": ('[units.sensor]\nfmu = "RateSensr"\n', "RateSensr", "RateSensor"),
    "a stop time before the start": ("stop_time = -1.0\n", "stop_time", "-1"),
}


@pytest.mark.parametrize("words", FILES.values(), ids=FILES)
def test_a_scenario_that_cannot_be_is_refused(tmp_path: Path, words: tuple[str, ...]) -> None:
    text, *expected = words
    path = variant(tmp_path, f'fmus = "{(ROOT / "build" / "fmus").as_posix()}"\n{text}')
    refused(orchestrator("run", path, "--out", tmp_path / "out"), *expected)


def test_a_pad_that_starts_deep_in_the_soil_is_refused(tmp_path: Path) -> None:
    refused(orchestrator("run", deep(tmp_path), "--out", tmp_path / "out"), "deep in the soil", "position_start[1]")


def interrupted(out: Path, wait: float) -> tuple[int, str]:
    """Exit code and stderr of a long landing that gets a SIGINT after `wait` seconds."""
    command = [sys.executable, "-m", "orchestrator", "run", ZUPP, "--stop-time", "100", "--out", str(out)]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(wait)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=1800)
    return process.returncode, errors


def test_ctrl_c_in_mid_landing_keeps_the_run_marked_incomplete(tmp_path: Path) -> None:
    """Units load in about 4 s; on a busy machine the signal may come before the first step, and then later is tried."""
    out = tmp_path / "out"
    for wait in (8.0, 30.0, 90.0, 240.0):
        code, errors = interrupted(out, wait)
        assert code == 130, errors
        assert "interrupted" in errors
        if (out / "summary.json").is_file():
            break
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    assert summary["complete"] is False
    assert summary["interrupted"] is True
    assert (out / "history.csv").is_file()
    assert 0.0 <= summary["master"]["simulated_s"] < 100.0
