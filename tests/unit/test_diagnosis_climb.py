"""The first fits of a climb: how many are begun. What they find is made up."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from orchestrator.diagnosis import climb
from orchestrator.diagnosis.climb import climbed

READINGS = 50.0


def ended(place: float, objective: float) -> Any:
    """A fit at a place so many posterior standard deviations from zero."""
    return SimpleNamespace(z=np.array([place]), jacobian=np.zeros((1, 1)), objective=objective, chi2=2.0 * objective)


GOOD, TRAPPED, ALSO_GOOD = ended(0.0, 21.0), ended(9.0, 79.0), ended(9.0, 22.0)


@pytest.mark.parametrize(
    ("ends", "begun", "best"),
    [
        ([GOOD] * 8, 2, [GOOD]),
        ([TRAPPED, GOOD, TRAPPED, GOOD, TRAPPED, TRAPPED, GOOD, GOOD], 4, [GOOD]),
        ([TRAPPED] * 8, 8, [TRAPPED]),  # agreed, but more than noise is left
        ([ALSO_GOOD, GOOD, None, TRAPPED, None, GOOD, TRAPPED, GOOD], 6, [GOOD, ALSO_GOOD]),
    ],
)
def test_fits_are_begun_until_two_that_explain_the_data_agree(monkeypatch: Any, ends: list[Any], begun: int, best: list[Any]) -> None:
    monkeypatch.setattr(climb, "counted", lambda *_: READINGS)
    started: list[Any] = []

    def run(_: str, tasks: Sequence[Any]) -> list[Any]:
        started.extend(tasks)
        return [None if ends[int(task.z[0])] is None else (None, ends[int(task.z[0])]) for task in tasks]

    landings: Any = None
    paths = climbed(landings, (), (0.3,), [np.array([float(i)]) for i in range(9)], run)
    assert len(started) == begun
    assert [path[-1].fit for path in paths] == best
