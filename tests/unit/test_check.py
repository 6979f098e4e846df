"""`orchestrator check` on a unit that keeps the contract, and on one of each fault: named with both values, and the command lives."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from check_samples import c_sensor

from orchestrator.check.trials import TRIALS
from orchestrator.check.trials.rollback import _places

FAULTS = {
    "missing port": ("names", "telemetry.roll", 'did you mean "telemetry.rol"?'),
    "causality": ("causality", "telemetry.roll", "is local, the contract has it as output"),
    "other unit": ("units of measure", "rates.yaw", "is in m/s, the contract has rad/s"),
    "other frame": ("frames", "rates.yaw", 'is in frame "L" by its description, the contract has "B"'),
    "crash": ("runs", "", "crashed (signal 11, SIGSEGV) at step 4 of"),
    "hang": ("runs", "", "hung for 5 s at step 4 of"),
    "exit": ("runs", "", "ended with exit code 7 at step 4 of"),
    "error": ("runs", "", "doStep returned Error"),
    "clock": ("determinism", "", "other bits"),
    "per call": ("step size", "telemetry.", "does not converge"),
    "lying state": ("rollback", "", "canGetAndSetFMUstate is true, but step 1 gives other bits after going back to step 0: telemetry."),
    "feedthrough": ("feedthrough", "telemetry.yaw", "telemetry.yaw answers rates.yaw at once, Outputs does not say so"),
    "nan passes": ("bad input", "rates.yaw = nan", "doStep is OK, but telemetry.yaw is nan"),
    "crash on nan": ("bad input", "", "crashed (signal 11, SIGSEGV) at probe rates.yaw = nan"),
}


def ran(fmu: Path, folder: Path, *options: str) -> tuple[int, str, list[dict[str, str]]]:
    """Exit code, standard error, findings."""
    report = folder / "report.json"
    command = [sys.executable, "-m", "orchestrator", "check", str(fmu), "--json", str(report), "--timeout", "5", *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False)
    findings = json.loads(report.read_text())["findings"] if report.exists() else []
    return done.returncode, done.stderr, findings


def test_a_foreign_unit_that_keeps_the_contract_passes_without_saying_what_it_is(tmp_path: Path) -> None:
    code, errors, findings = ran(c_sensor(), tmp_path)
    assert code == 0, errors
    assert {f["verdict"] for f in findings} <= {"pass", "note", "warn"}
    report = json.loads((tmp_path / "report.json").read_text())
    assert (report["kind"], report["kind_guessed"], report["passed"]) == ("RateSensor", True, True)
    checks = {f["check"] for f in findings if f["verdict"] == "pass"}
    assert {"names", "causality", "units of measure", "frames", "determinism", "step size", "rollback", "serialisation", "feedthrough",
            "bad input", "bad parameters"} <= checks


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_is_named_with_where_and_both_values(fault: str, tmp_path: Path) -> None:
    check, where, words = FAULTS[fault]
    trial = check if check in TRIALS else "runs"      # one trial is enough to find it, and takes less time
    code, errors, findings = ran(c_sensor(fault), tmp_path, "--as", "RateSensor", "--only", trial)
    failed = [f for f in findings if f["verdict"] == "FAIL"]
    assert code == 2
    assert [f for f in failed if f["check"] == check and f["where"].startswith(where) and words in f["found"] + f["do"]], failed
    assert errors.startswith(f"error: {c_sensor(fault).name}: ")
    assert errors.count("\n") == 1
    assert "Traceback" not in errors


@pytest.mark.parametrize(("fault", "check"), [("no frame", "frames"), ("no state", "capabilities"), ("degrees", "units of measure")])
def test_what_only_makes_it_worse_is_a_warning_and_does_not_fail(fault: str, check: str, tmp_path: Path) -> None:
    code, _, findings = ran(c_sensor(fault), tmp_path, "--only", "rollback")
    assert code == 0
    assert {f["check"] for f in findings if f["verdict"] == "warn"} == {check}


def test_a_unit_of_no_known_kind_is_held_against_no_contract(tmp_path: Path) -> None:
    from fmi_c_sample import c_sample

    code, _, findings = ran(c_sample(), tmp_path, "--set", "wall=1e9")
    assert json.loads((tmp_path / "report.json").read_text())["kind"] is None
    assert "names" not in {f["check"] for f in findings}
    assert code == 2      # its outputs depend on everything by its words, and NaN goes through it
    assert {f["check"] for f in findings if f["verdict"] == "FAIL"} == {"bad input"}


def test_another_kind_asked_for_and_one_that_does_not_exist(tmp_path: Path) -> None:
    code, errors, _ = ran(c_sensor(), tmp_path, "--as", "GearLeg", "--only", "runs")
    assert code == 2
    assert "names: body.position: input is missing, the contract requires it: body.position[1..3] in m" in errors
    code, errors, _ = ran(c_sensor(), tmp_path, "--as", "GearLegg")
    assert code == 2
    assert errors == 'error: --as GearLegg: no such kind of unit; did you mean "GearLeg"?\n'
    code, errors, _ = ran(c_sensor(), tmp_path, "--only", "rolback")
    assert (code, errors) == (2, 'error: --only rolback: no such trial; did you mean "rollback"?\n')


def test_what_is_no_fmu_is_told_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "text.fmu").write_text("nothing")
    code, errors, _ = ran(tmp_path / "text.fmu", tmp_path)
    assert code == 2
    assert "text.fmu: not a readable FMU" in errors


@pytest.mark.parametrize(("count", "places"), [(1, [0]), (4, [0]), (9, [0, 6]), (16, [0, 5, 10]), (99, [0, 33, 66])])
def test_a_state_is_saved_only_where_the_unit_is(count: int, places: list[int]) -> None:
    """After going back it has gone on five steps: a place before these would be stepped at times where the unit is not."""
    assert _places(count) == places
