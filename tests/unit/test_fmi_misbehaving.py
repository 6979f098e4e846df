"""Foreign units that return early, fail or hang: named in one line, and everything computed so far is kept."""

import os
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pytest
from fmi_c_sample import c_sample

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.master.result import RunResult
from orchestrator.simulation import run_scenario


def scenario(folder: Path, state: bool = True, **master: float) -> Path:
    settings = {"max_interval": 0.04, "min_interval": 1e-3} | master
    lines = "\n".join(f"{key} = {value}" for key, value in settings.items())
    fmu = c_sample(state)
    path = folder / "odd.toml"
    path.write_text(
        f'stop_time = 1.0\nfmus = "{fmu.parent.as_posix()}"\n[units.odd]\nfmu = "{fmu.stem}"\n[units.even]\nfmu = "{fmu.stem}"\n'
        f'[[connections]]\nfrom = "odd.x"\nto = "even.u"\n[master]\n{lines}\n'
    )
    return path


def ran(folder: Path, *overrides: str, state: bool = True) -> RunResult:
    return run_scenario(scenario(folder, state), overrides)


def test_an_early_return_is_honoured_for_everybody(tmp_path: Path) -> None:
    result = ran(tmp_path, "odd.wall=0.15")
    assert result.complete
    ends = [round(row.time + row.interval, 9) for row in result.log if row.accepted]
    assert {0.15, 0.3, 0.45, 0.6, 0.75, 0.9} <= set(ends)
    assert {row.limit for row in result.log if not row.accepted} == {"early return of odd"}
    assert result.rejected == 6
    assert result.columns["odd.x"][-1] == pytest.approx(1.0, abs=1e-12)


def test_an_early_return_of_a_unit_that_cannot_go_back_names_it_and_how_far_it_came(tmp_path: Path) -> None:
    result = ran(tmp_path, "odd.wall=0.15", state=False)
    assert not result.complete
    assert "odd: refused the step at t = 0.12 s of 0.04 s, came to 0.15 s and odd cannot roll back" in result.message
    assert result.times[-1] == pytest.approx(0.12)


@pytest.mark.parametrize(
    ("parameter", "words"),
    [
        ("error_from", "odd: doStep returned Error"),
        ("fatal_from", "odd: doStep returned Fatal"),
        ("nan_from", "odd: x is nan near t = 0.5"),
    ],
)
def test_a_failure_is_named_and_what_was_computed_stays(tmp_path: Path, parameter: str, words: str) -> None:
    result = ran(tmp_path, f"odd.{parameter}=0.5")
    assert words in result.message
    assert "\n" not in result.message
    assert not result.trusted
    assert 0.45 < result.times[-1] < 0.55


RUN = ("-m", "orchestrator", "run", "--quiet", "--no-figures")


def test_a_unit_that_hangs_ends_the_run_with_its_name_and_the_results_so_far(tmp_path: Path) -> None:
    path, out = scenario(tmp_path, step_timeout=1.0), tmp_path / "out"
    command = [sys.executable, *RUN, str(path), "--out", str(out), "--set", "odd.hang_from=0.5"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False, env=os.environ)
    assert done.returncode == 3, done.stderr
    assert "error: odd: has not come back from doStep at t = 0.52 s for 1 s" in done.stderr
    assert "Traceback" not in done.stderr
    rows = (out / "history.csv").read_text().splitlines()
    assert rows[-1].startswith("0.52")
    assert (out / "summary.json").is_file()


def test_a_unit_that_hangs_in_its_trial_before_the_run_is_named_too(tmp_path: Path) -> None:
    path = scenario(tmp_path, step_timeout=1.0)
    command = [sys.executable, *RUN, str(path), "--out", str(tmp_path / "out"), "--set", "odd.hang_from=0.0"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False, env=os.environ)
    assert done.returncode == 3, done.stderr
    assert done.stderr.startswith("error: odd: has not come back from doStep at t = 0 s for 1 s")
    assert done.stderr.count("\n") == 1


ALONE = {"units": {name: {"isolate": True} for name in ("odd", "even")}}


@pytest.mark.parametrize(
    ("crash_from", "words", "last"),
    [
        (0.08, "odd: crashed in doStep at t = 0.08 s (SIGSEGV); mend the unit, or give it isolate = true", 0.08),
        (0.0, "odd: crashed in doStep at t = 0 s (SIGSEGV)", None),
    ],
)
def test_a_crash_at_the_third_step_or_in_the_trial_is_a_line(tmp_path: Path, crash_from: float, words: str, last: float | None) -> None:
    path, out = scenario(tmp_path), tmp_path / "out"
    setting = ("--set", f"odd.crash_from={crash_from}")
    command = [sys.executable, *RUN, str(path), "--out", str(out), *setting]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False, env=os.environ)
    assert done.returncode == 3, done.stderr
    assert done.stderr.startswith(f"error: {words}")
    assert len(done.stderr.splitlines()) == 1
    if last is not None:
        assert (out / "history.csv").read_text().splitlines()[-1].startswith(str(last))


def test_a_crash_outside_of_dostep_is_a_line_that_names_who_was_called_and_leaves_the_results(tmp_path: Path) -> None:
    path, out = scenario(tmp_path), tmp_path / "out"
    command = [sys.executable, *RUN, str(path), "--out", str(out), "--set", "odd.save_crash_from=0.08"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False, env=os.environ)
    assert done.returncode == 3, done.stderr
    assert done.stderr == "error: odd: crashed while its state was saved (SIGSEGV); mend the unit\n"
    assert (out / "history.csv").read_text().splitlines()[-1].startswith("0.08")


def test_a_unit_in_a_process_of_its_own_crashes_alone_and_is_named(tmp_path: Path) -> None:
    result = run_scenario(scenario(tmp_path), ["odd.crash_from=0.08"], ALONE)
    assert result.message == "odd: crashed in doStep, its step 3, from t = 0.08 s: its process was ended by SIGSEGV; mend the unit"
    assert result.times[-1] == pytest.approx(0.08)


def test_a_unit_in_a_process_of_its_own_does_the_same_to_the_bit(tmp_path: Path) -> None:
    beside = run_scenario(scenario(tmp_path), ["odd.wall=0.15"])
    apart = run_scenario(scenario(tmp_path), ["odd.wall=0.15"], ALONE)
    assert apart.columns.keys() == beside.columns.keys()
    assert all((column == beside.columns[name]).all() for name, column in apart.columns.items())
    assert [row.limit for row in apart.log] == [row.limit for row in beside.log]


def test_a_run_is_known_by_the_scenario_that_was_read_and_not_by_what_was_written_since(tmp_path: Path) -> None:
    path = scenario(tmp_path)
    read = sha256(path.read_bytes()).hexdigest()
    blueprint = draw_up(read_scenario(path), path)
    path.write_text("# edited\n" + path.read_text())
    assert blueprint.sha256 == read
    assert draw_up(read_scenario(path), path).sha256 != read
