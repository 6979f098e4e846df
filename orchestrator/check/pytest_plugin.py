"""pytest's options for the component tests: known wherever the package is installed, wherever the FMU lies.

In a conftest.py they would be unknown while pytest looks for its root folder, and the FMU's path would be taken for a folder of tests.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any


def pytest_addoption(parser: Any) -> None:
    group = parser.getgroup("units", "component tests of a unit (tests/fmu/units)")
    group.addoption("--unit-under-test", metavar="FMU", type=Path, help="run the component tests on this FMU, and no other tests")
    group.addoption("--as", dest="unit_kind", metavar="KIND", help="what it stands in for, as GearLeg; without it, guessed from its ports")
