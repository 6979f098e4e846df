"""The command line, as a user meets it: in a process of its own, so that exit codes and crashes at exit show."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from fmi_samples import oscillator, sample_fmus

ROOT = Path(__file__).resolve().parents[2]

def orchestrator(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "orchestrator", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=900)


def test_a_run_leaves_its_results_and_a_table_and_exit_code_zero(tmp_path: Path) -> None:
    done = orchestrator("run", oscillator(tmp_path), "--out", tmp_path / "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "Two masses and a spring" in done.stdout
    assert done.stderr == ""                        # no progress bar in a pipe
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["complete"] is True


def test_a_bare_name_is_found_and_results_have_a_default_place(tmp_path: Path) -> None:
    (tmp_path / "scenarios").mkdir()
    oscillator(tmp_path / "scenarios")
    done = orchestrator("run", "oscillator", "--quiet", "--stop-time", "0.05", "--tolerance", "1e-5", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    assert (tmp_path / "results" / "oscillator" / "summary.json").is_file()


def test_list_gives_names_and_titles_and_leaves_data_out(tmp_path: Path) -> None:
    (tmp_path / "scenarios").mkdir()
    oscillator(tmp_path / "scenarios")
    (tmp_path / "scenarios" / "data.toml").write_text("x = 1\n")
    done = orchestrator("list", cwd=tmp_path)
    assert done.returncode == 0
    assert done.stdout.split() == ["oscillator", "Two", "masses", "and", "a", "spring"]


def test_show_tells_units_connections_and_parameters_without_running(tmp_path: Path) -> None:
    done = orchestrator("show", oscillator(tmp_path), "--set", "b.mass=3.5", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for text in ("SampleSpring", "a.end", "spring.a", "b.mass", "3.5"):
        assert text in done.stdout
    assert not (tmp_path / "results").exists()


WRONG = {
    "an unknown parameter": (("--set", "a.mas=1"), "oscillator.toml: a.mas: unknown parameter"),
    "an unknown unit": (("--set", "c.mass=1"), '--set c.mass=1: no unit "c"'),
    "a value that is no number": (("--set", "a.mass=nan"), "oscillator.toml: a.mass = nan: is not a number"),
    "a stop time before the start": (("--stop-time", "-1"), "oscillator.toml: stop_time -1 s is not after start_time 0 s"),
    "an unknown option": (("--stopp", "1"), "No such option: --stopp"),
    "a negative tolerance": (("--tolerance", "-1"), "oscillator.toml: master.tolerance = -1.0: input should be greater than 0"),
}


@pytest.mark.parametrize(("arguments", "message"), WRONG.values(), ids=WRONG)
def test_a_request_that_cannot_be_run_is_one_line_and_exit_code_two(tmp_path: Path, arguments: tuple[str, str], message: str) -> None:
    done = orchestrator("run", oscillator(tmp_path), *arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert "Traceback" not in done.stderr


BROKEN = {
    "a missing FMU": ('fmu = "SampleSpring"', 'fmu = "SampleSprng"', 'no such FMU; did you mean "SampleSpring"?'),
    "a missing folder": (sample_fmus().as_posix(), "/nowhere", "no such FMU, nor any other in that folder; build them"),
    "a missing port": ("spring.a", "spring.c", 'spring.c: unit spring has no port "c"'),
    "bad TOML": ("[master]", "[master", "oscillator.toml: not valid TOML"),
    "an unknown key": ("max_interval", "max_intervall", 'master.max_intervall: unknown key; did you mean "max_interval"?'),
    "an input connected twice": ("b.end", "a.end", "a.end.force: fed by spring.a.force and by spring.b.force"),
}


@pytest.mark.parametrize(("old", "new", "message"), BROKEN.values(), ids=BROKEN)
def test_a_broken_scenario_is_one_line_and_exit_code_two(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = oscillator(tmp_path, **{old: new})
    done = orchestrator("run", path, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_a_place_that_cannot_take_results_is_refused_before_the_run(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file\n")
    done = orchestrator("run", oscillator(tmp_path), "--out", tmp_path / "taken", cwd=tmp_path)
    assert done.returncode == 2
    assert "taken: cannot take the results (File exists); give another --out" in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "option"),
    [
        (("diagnose", "SCENARIO", "--measured", ".", "--out", "taken"), "--out"),
        (("distinguish", "SCENARIO", "--measured", ".", "--out", "taken"), "--out"),
        (("campaign", "CAMPAIGN", "--out", "taken"), "--out"),
        (("check", "SCENARIO", "--json", "taken/check.json"), "--json"),
    ],
)
def test_no_command_flies_for_a_place_that_cannot_take_results(tmp_path: Path, arguments: tuple[str, ...], option: str) -> None:
    (tmp_path / "taken").write_text("a file\n")
    places = {"SCENARIO": oscillator(tmp_path), "CAMPAIGN": ROOT / "scenarios" / "campaigns" / "apollo11_scatter.toml"}
    done = orchestrator(*(places.get(word, word) for word in arguments), cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr == f"error: taken: cannot take the results (File exists); give another {option}\n"


def test_outside_a_project_a_bare_name_says_where_names_are_looked_for(tmp_path: Path) -> None:
    done = orchestrator("run", "apollo11_zupp", cwd=tmp_path)
    assert done.returncode == 2
    told = "there is no folder `scenarios` here or above; change to the project's folder, or give a file"
    assert done.stderr == f"error: apollo11_zupp: {told}\n"


def test_a_missing_scenario_names_the_nearest(tmp_path: Path) -> None:
    (tmp_path / "scenarios").mkdir()
    oscillator(tmp_path / "scenarios")
    done = orchestrator("run", "oscilator", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr == 'error: oscilator: no such scenario; did you mean "oscillator"?\n'


def moody(folder: Path) -> Path:
    path = folder / "moody.toml"
    path.write_text(f'stop_time = 1.0\nfmus = "{sample_fmus().as_posix()}"\n[units.m]\nfmu = "SampleMoody"\n')
    return path


@pytest.mark.parametrize(
    ("parameter", "message"),
    [
        ("raise_from", "m: doStep returned Fatal: "),
        ("refuse_from", "m: refused the step at t = 0.1"),
        ("nan_from", "m: time is nan near t = 0.1"),
    ],
)
def test_a_run_that_cannot_be_finished_keeps_what_it_has_and_returns_three(tmp_path: Path, parameter: str, message: str) -> None:
    done = orchestrator("run", moody(tmp_path), "--set", f"m.{parameter}=0.1", "--out", tmp_path / "out", cwd=tmp_path)
    assert done.returncode == 3
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["complete"] is False


def test_a_run_that_misses_its_tolerance_is_not_trusted_and_returns_three(tmp_path: Path) -> None:
    path = oscillator(tmp_path, **{"tolerance = 1e-6": "tolerance = 1e-12\nmin_interval = 1e-3"})
    done = orchestrator("run", path, "--out", tmp_path / "out", cwd=tmp_path)
    assert done.returncode == 3
    assert "steps missed the tolerance 1e-12 m (worst" in done.stderr


def test_ctrl_c_keeps_everything_computed_marked_incomplete(tmp_path: Path) -> None:
    """Where the signal comes before the run has begun, on a slow machine, it is sent later."""
    path = oscillator(tmp_path, **{"stop_time = 0.5": "stop_time = 1000.0"})
    command = [sys.executable, "-m", "orchestrator", "run", str(path), "--out", str(tmp_path / "out")]
    for wait in (4.0, 15.0, 60.0):
        process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=tmp_path, env={**os.environ})
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=600)
        if (tmp_path / "out" / "summary.json").is_file():
            break
    assert process.returncode == 130, errors
    assert "interrupted" in errors
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["complete"] is False


def test_the_scenario_a_run_leaves_behind_repeats_it_to_the_bit(tmp_path: Path) -> None:
    start = '\n[start]\nvary = "b.position_start"\nzero = "b.posit*"\nvalue = 0.7\n'
    first = orchestrator("run", oscillator(tmp_path, start), "--set", "b.mass=2.5", "--out", tmp_path / "one", cwd=tmp_path)
    again = orchestrator("run", tmp_path / "one" / "scenario.toml", "--out", tmp_path / "two", cwd=tmp_path)
    assert (first.returncode, again.returncode) == (0, 0), again.stderr
    assert (tmp_path / "one" / "history.csv").read_bytes() == (tmp_path / "two" / "history.csv").read_bytes()


def test_ctrl_c_before_anything_is_computed_is_said() -> None:
    """typer 0.29 ends without a word."""
    program = """
import sys
from orchestrator import cli

def interrupted():
    raise KeyboardInterrupt

cli.scenario_folder = interrupted
sys.argv = ["orchestrator", "list"]
cli.main()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=900)
    assert (done.returncode, done.stderr) == (130, "interrupted: nothing was computed\n")


def test_ctrl_c_while_the_commands_are_imported_is_said() -> None:
    """On a slow machine they take seconds, and a signal in a module's own code would be a traceback."""
    program = """
import os, signal, sys

class Interrupting:
    def find_spec(self, name, path=None, target=None):
        if name == "rich.table":
            os.kill(os.getpid(), signal.SIGINT)
        return None

signal.signal(signal.SIGINT, signal.default_int_handler)   # the tests may run as a job in the background, which ignores it
sys.meta_path.insert(0, Interrupting())
from orchestrator.__main__ import main
sys.argv = ["orchestrator", "list"]
main()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=900)
    assert (done.returncode, done.stderr) == (130, "interrupted: nothing was computed\n")
