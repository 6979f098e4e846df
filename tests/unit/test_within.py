"""`pytest --within`: what a slow machine leaves out."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TESTS = """
import pytest

def test_quick(): pass

@pytest.mark.slow
def test_slow(): pass

@pytest.mark.slow
@pytest.mark.together
@pytest.mark.parametrize("place", [1, 2])
def test_beside(place): pass
"""


TOGETHER = """
import conftest, pytest

pytestmark = pytest.mark.together

def test_one(): conftest.BEGUN -= 2000

def test_two(): pass
"""


def said_of(tests: str, folder: Path, ago: int = 0) -> str:
    """What a session says that began so many s ago and may begin tests within 1000 s."""
    plugin = (ROOT / "tests" / "conftest.py").read_text("utf-8")
    assert "BEGUN = monotonic()\n" in plugin
    (folder / "conftest.py").write_text(plugin.replace("BEGUN = monotonic()\n", f"BEGUN = monotonic() - {ago}\n"), "utf-8")
    (folder / "pytest.ini").write_text("[pytest]\nmarkers =\n  slow\n  together\n", "utf-8")
    (folder / "test_it.py").write_text(tests, "utf-8")
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-ra", "--within", "1000", str(folder)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=900, check=True).stdout


@pytest.mark.parametrize(("ago", "passed", "skipped"), [(400, 4, 0), (650, 2, 2), (850, 1, 3), (1100, 0, 4)])
def test_what_has_not_begun_in_time_is_skipped_and_named(tmp_path: Path, ago: int, passed: int, skipped: int) -> None:
    said = said_of(TESTS, tmp_path, ago)
    counts = {word: int(n) for n, word in re.findall(r"(\d+) (passed|skipped)", said)}
    assert (counts.get("passed", 0), counts.get("skipped", 0)) == (passed, skipped)
    assert ("not begun within 750 s" in said) == (ago > 750)
    assert ("not begun within 500 s" in said) == (ago > 500)


def test_what_began_together_is_not_left_out_half_way(tmp_path: Path) -> None:
    """The second test's setup comes too late, but its work began with the first's."""
    assert "2 passed" in said_of(TOGETHER, tmp_path)
