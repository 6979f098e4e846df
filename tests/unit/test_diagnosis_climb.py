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


@pytest.mark.parametrize(
    ("onward", "drawn", "end"),
    [
        (58.0, 0, 58.0),  # 37 for 80 readings more: noise
        (75.0, 20, 64.0),  # 54: other ways on are looked for, one is found
        (None, 20, 64.0),  # cannot be flown from the fit itself
    ],
)
def test_other_ways_on_are_drawn_where_a_horizon_leaves_more_than_noise(
    monkeypatch: Any, onward: float | None, drawn: int, end: float
) -> None:
    below, beyond = 0.3, 0.5
    monkeypatch.setattr(climb, "counted", lambda _, horizon: {below: READINGS, beyond: READINGS + 80.0}[horizon])
    counts: list[int] = []
    first, slopes = SimpleNamespace(horizon=below), np.ones((1, 1))

    def run(_: str, tasks: Sequence[Any]) -> list[Any]:
        found: list[Any] = []
        for task in tasks:
            if isinstance(task, climb.Start):
                found.append((first, ended(0.0, 21.0)))
            elif isinstance(task, climb.Draw):
                counts.append(task.count)
                alone = task.count == 0
                assert task.slopes is (None if alone or onward is None else slopes)
                found.append([] if alone and onward is None else [SimpleNamespace(horizon=beyond, slopes=slopes, alone=alone)])
            else:
                found.append(ended(0.0, onward if task.point.alone and onward is not None else 64.0))
        return found

    landings: Any = None
    paths = climbed(landings, (), (below, beyond), [np.zeros(1)], run)
    assert sum(counts) == drawn
    assert paths[0][-1].fit.objective == end


def test_what_a_horizon_may_add_shrinks_with_noise_that_is_smaller_than_stated(monkeypatch: Any) -> None:
    monkeypatch.setattr(climb, "counted", lambda _, horizon: 100.0 * horizon)
    below, above = (climb.Rung(SimpleNamespace(horizon=h), ended(0.0, phi)) for h, phi in ((1.0, 12.5), (2.0, 40.0)))  # type: ignore[arg-type]
    landings: Any = None
    assert not climb._as_noise_lets(landings, below, above)  # 55 of 100 readings of half the noise: 25 would do
