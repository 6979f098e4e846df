"""`pytest --unit-under-test`: a right unit made elsewhere passes, a wrong sign is caught by a test that says so."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from hosted import PACKAGE, package_with, packed_from

ROOT = Path(__file__).resolve().parents[2]

WRONG = {      # file, what stands there, what stands there instead, a test that must fail
    "rate_sensor": ("received = scale * rate + bias", "received = -scale * rate + bias",
                    "a_lasting_rate_arrives_on_its_own_channel_with_its_sign"),
    "regolith_contact": ("self.feel(time)",
                         'self.feel(time); self["pad.force"][1:] *= -1.0', "a_slide_is_braked_along_its_own_line"),
    "vehicle_body": ("advance_body(self.body, LONGEST, step, *self.inputs, *self.outputs)",
                     'self["engine.force"] *= -1.0; advance_body(self.body, LONGEST, step, *self.inputs, *self.outputs)',
                     "a_force_on_any_port_gives_every_direction_the_same_mass"),
    "gear_leg": ('self["bottomed"] = float(done == BOTTOMED)',
                 'self["bottomed"] = float(done == BOTTOMED); self["mount.torque"] *= -1.0', "a_force_on_the_pad_reaches_the_body_whole"),
}


def report_of(fmu: Path, *options: str) -> tuple[int, str]:
    """Exit code and report. The units run as plain Python here: compiling a changed one takes longer than running it."""
    plugin = ["-p", "orchestrator.check.pytest_plugin"]      # an installed package brings it by itself
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *plugin, "--unit-under-test", str(fmu), *options]
    environment = dict(os.environ, LANDER_PLAIN_PYTHON="1", PYTHONPATH=os.pathsep.join([str(ROOT), str(PACKAGE.parent)]))
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, env=environment)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.parametrize("file", WRONG)
def test_a_unit_with_a_wrong_sign_fails_the_test_that_says_so(file: str, tmp_path: Path) -> None:
    right, wrong, expected = WRONG[file]
    text = (PACKAGE / "units" / f"{file}.py").read_text("utf-8")
    assert text.count(right) == 1
    code, report = report_of(packed_from(package_with(tmp_path, **{file: text.replace(right, wrong)}), file), "-x", "-k", expected)
    assert code == 1, report
    assert re.search(rf"FAILED .*{expected}", report), report


def test_a_right_unit_made_elsewhere_passes_the_tests_of_its_kind_and_no_others_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "tests" / "unit"))
    from check_samples import c_sensor

    code, report = report_of(c_sensor())
    assert code == 0, report
    assert re.search(r"7 passed, 4 skipped, \d+ deselected", report), report


def test_a_unit_of_no_known_kind_is_told_in_one_line(tmp_path: Path) -> None:
    code, report = report_of(tmp_path / "nothing.fmu")
    assert code == 4
    assert "nothing.fmu: no such file; give the path of an FMU" in report
