"""With `pytest --unit-under-test my_leg.fmu` only the component tests of tests/fmu/units are run; with `--within`, what begins in time."""

from pathlib import Path
from time import monotonic

import pytest

UNITS = Path(__file__).parent / "fmu" / "units"
BEGUN = monotonic()
SOONER = 0.75  # of the limit: by then tests marked slow are to begin
TOGETHER = 0.5  # and by then the first of a file whose tests, marked together, all begin with it
FIRST: dict[Path, float] = {}


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--within",
        type=float,
        metavar="SECONDS",
        help="tests that have not begun by then are skipped and named, those marked slow already by three quarters of it",
    )


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    if config.getoption("--unit-under-test", None) and collection_path.is_file() and UNITS not in collection_path.parents:
        return True
    return None


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Before any fixture of the test is made."""
    limit = item.config.getoption("--within", None)
    if limit is None:
        return
    ago = monotonic() - BEGUN
    if item.get_closest_marker("together"):
        ago, limit = FIRST.setdefault(item.path, ago), TOGETHER * limit
    elif item.get_closest_marker("slow"):
        limit = SOONER * limit
    if ago > limit:
        pytest.skip(f"not begun within {limit:g} s; run it by itself")
