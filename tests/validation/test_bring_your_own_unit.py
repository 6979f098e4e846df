"""Every command of docs/bring-your-own-unit.md, in the order of the page, as printed."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "bring-your-own-unit.md"
PROGRAMS = {
    "python": [sys.executable],
    "orchestrator": [sys.executable, "-m", "orchestrator"],
    "pytest": [sys.executable, "-m", "pytest", "-p", "orchestrator.check.pytest_plugin"],
}
TEMPLATE = ROOT / "examples" / "template_unit"


def commands() -> list[list[str]]:
    blocks = re.findall(r"```bash\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    return [shlex.split(line) for block in blocks for line in block.splitlines()]


@pytest.mark.skipif(not (ROOT / "build" / "fmus" / "GearLeg.fmu").exists(), reason="python build_fmus.py first")
def test_every_command_of_the_page_does_what_it_says() -> None:
    assert len(commands()) >= 10
    for program, *arguments in commands():
        done = subprocess.run([*PROGRAMS[program], *arguments], cwd=ROOT, capture_output=True, text=True, timeout=1800, env={**os.environ})
        assert done.returncode == 0, f"{program} {' '.join(arguments)}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
    mine, theirs = ((ROOT / "results" / name / "comparison.md").read_text("utf-8") for name in ("mine", "theirs"))
    assert mine != theirs


def test_the_overlay_on_the_page_is_the_one_in_the_folder() -> None:
    (shown,) = re.findall(r"```toml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    real = (TEMPLATE / "apollo11_my_guidance.toml").read_text("utf-8")
    assert [line.partition("#")[0].rstrip() for line in shown.splitlines() if line] == [
        line.partition("#")[0].rstrip() for line in real.splitlines() if line and not line.startswith("#")
    ]


def test_the_template_knows_nothing_of_this_project() -> None:
    imports = re.findall(r"^(?:from|import) (\w+)", (TEMPLATE / "my_guidance.py").read_text("utf-8"), re.MULTILINE)
    assert set(imports) == {"xml", "pythonfmu"}
