"""The contracts that stand beside `orchestrator check` are those of the built FMUs, and each FMU of ours keeps its own."""

import subprocess
import sys
from pathlib import Path

import pytest
from lander.units import unit_files

from orchestrator.check.contract import FOLDER, contract_of, kinds
from orchestrator.check.drawing import drawn, text_of

NAMES = ["".join(word.capitalize() for word in file.split("_")) for file in unit_files()]


def test_the_contracts_kept_are_those_of_the_built_fmus(fmus: dict[str, Path]) -> None:
    """After a change of a unit's variables: python -m orchestrator.check.drawing build/fmus."""
    now = drawn([fmus[name] for name in sorted(fmus)])
    assert sorted(now) == kinds()
    for kind, contract in now.items():
        assert (FOLDER / f"{kind}.toml").read_text("utf-8") == text_of(contract), kind
        assert contract_of(kind) == contract


@pytest.mark.parametrize("name", NAMES)
def test_every_fmu_of_ours_keeps_its_contract(name: str, fmus: dict[str, Path]) -> None:
    command = [sys.executable, "-m", "orchestrator", "check", str(fmus[name])]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert " 0 warnings, 0 failed" in done.stdout
    assert "no kind of unit" not in done.stdout
