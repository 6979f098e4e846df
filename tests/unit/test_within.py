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
"""


@pytest.mark.parametrize(("ago", "passed", "skipped"), [(500, 2, 0), (850, 1, 1), (1100, 0, 2)])
def test_what_has_not_begun_in_time_is_skipped_and_named(tmp_path: Path, ago: int, passed: int, skipped: int) -> None:
    """Of a session that began so many s ago and may begin tests within 1000 s."""
    plugin = (ROOT / "tests" / "conftest.py").read_text("utf-8")
    assert "BEGUN = monotonic()\n" in plugin
    (tmp_path / "conftest.py").write_text(plugin.replace("BEGUN = monotonic()\n", f"BEGUN = monotonic() - {ago}\n"), "utf-8")
    (tmp_path / "pytest.ini").write_text("[pytest]\nmarkers = slow\n", "utf-8")
    (tmp_path / "test_it.py").write_text(TESTS, "utf-8")
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-ra", "--within", "1000", str(tmp_path)]
    said = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=900, check=True).stdout
    counts = {word: int(n) for n, word in re.findall(r"(\d+) (passed|skipped)", said)}
    assert (counts.get("passed", 0), counts.get("skipped", 0)) == (passed, skipped)
    assert ("not begun within 750 s" in said) == (ago > 750)
