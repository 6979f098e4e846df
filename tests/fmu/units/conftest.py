"""Which FMU each component test drives: ours of its kind, or the one under test.

A test module names its KIND. Only ports of the contract are used; what only some units have (a parameter, an optional output) is used
where it is there. One instance serves a module: a new start is a reset. A unit that may crash is better checked first
(`orchestrator check my.fmu`), which runs it in processes of its own.
"""

from collections.abc import Iterator
from pathlib import Path

import pytest
from piece import Piece

from orchestrator.check.guess import guessed
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.load import load
from orchestrator.fmi.structure import read_structure

OURS = {kind: kind for kind in ("GearLeg", "GuidanceControl", "RateSensor", "RegolithContact", "VehicleBody")}


def kind_of(config: pytest.Config) -> str | None:
    """The kind of the unit under test; None: there is none."""
    path: Path | None = config.getoption("--unit-under-test", None)
    if path is None:
        return None
    if not path.is_file():
        raise pytest.UsageError(f"--unit-under-test {path}: no such file; give the path of an FMU")
    asked: str | None = config.getoption("unit_kind", None)
    found = guessed(read_interface(path), read_structure(path).kind)
    kind = asked or (found.kind if found else None)
    if kind not in OURS:
        what = f"is {kind}" if kind else "is of no kind known here"
        raise pytest.UsageError(f"--unit-under-test {path}: {what}, expects one of {', '.join(OURS)}; name it with --as KIND")
    return kind


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Tests of other kinds than the unit under test's are left out."""
    kind = kind_of(config)
    if kind:
        chosen = [item for item in items if getattr(getattr(item, "module", None), "KIND", kind) == kind]
        config.hook.pytest_deselected(items=[item for item in items if item not in chosen])
        items[:] = chosen


@pytest.fixture(scope="module")
def piece(request: pytest.FixtureRequest) -> Iterator[Piece]:
    """The unit in the hands of a test."""
    path = request.config.getoption("--unit-under-test", None)
    if path is None:
        path = request.getfixturevalue("fmus")[OURS[request.module.KIND]]
    slave = load("piece", read_interface(path))
    yield Piece(slave)
    slave.close()
