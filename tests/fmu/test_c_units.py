"""The units in C of examples/c_units keep the port contract and pass the component tests of their kind: nobody's FMUs, no Python inside."""

import subprocess
import sys
from pathlib import Path

import pytest
from test_unit_under_test import report_of

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("c_units")
    command = [sys.executable, str(ROOT / "examples" / "c_units" / "build.py"), "--out", str(folder)]
    subprocess.run(command, check=True, capture_output=True)
    return folder


@pytest.mark.parametrize("name", ["Gnc2", "Gnc3", "Soil2"])
def test_a_unit_in_c_keeps_its_contract(name: str, built: Path) -> None:
    command = [sys.executable, "-m", "orchestrator", "check", str(built / f"{name}.fmu")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "held against the contract of" in done.stdout


@pytest.mark.parametrize(("name", "passed"), [("Gnc2", 3), ("Gnc3", 3), ("Soil2", 9)])
def test_a_unit_in_c_passes_the_component_tests(name: str, passed: int, built: Path) -> None:
    code, report = report_of(built / f"{name}.fmu")
    assert code == 0, report
    assert f"{passed} passed" in report
