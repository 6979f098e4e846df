"""With `pytest --unit-under-test my_leg.fmu` only the component tests of tests/fmu/units are of interest."""

from pathlib import Path

import pytest

UNITS = Path(__file__).parent / "fmu" / "units"


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    if config.getoption("--unit-under-test", None) and collection_path.is_file() and UNITS not in collection_path.parents:
        return True
    return None
