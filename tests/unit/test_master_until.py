"""An end before the stop time: when all conditions have held for a while, and not sooner."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from fmi_samples import oscillator

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.errors import ScenarioError
from orchestrator.master.until import Bound, Until
from orchestrator.simulation import run_scenario

CALM = Bound(0, "speed", 1.0, below=True)
TOUCHING = Bound(0, "contact", 0.5, below=False)


def told(until: Until, now: np.ndarray, values: list[tuple[int, float, float]]) -> list[bool]:
    found = []
    for elapsed, speed, contact in values:
        now[:] = speed, contact
        found.append(until.met(elapsed))
    return found


def watched(hold: int) -> tuple[Until, np.ndarray]:
    now = np.zeros(2)
    board = SimpleNamespace(now=now, start_at=lambda unit, name: ("speed", "contact").index(name))
    return Until(board, [CALM, TOUCHING], hold), now     # type: ignore[arg-type]


def test_all_conditions_must_hold_without_a_break() -> None:
    until, now = watched(hold=20)
    calm = [(0, 0.5, 1.0), (10, -0.9, 1.0), (15, -1.1, 1.0), (20, 0.1, 1.0), (30, 0.1, 0.0), (40, 0.1, 1.0), (50, 0.1, 1.0), (60, 0.1, 1.0)]
    assert told(until, now, calm) == [False] * 7 + [True]


def test_what_it_remembers_is_enough_to_go_on_from_a_checkpoint() -> None:
    first, now = watched(hold=20)
    told(first, now, [(0, 0.1, 1.0), (10, 0.1, 1.0)])
    second, now = watched(hold=20)
    for name in Until.MEMORY:
        setattr(second, name, getattr(first, name))
    assert told(second, now, [(20, 0.1, 1.0)]) == [True]


def test_a_run_that_ends_early_is_complete_and_the_beginning_of_the_whole_one(tmp_path: Path) -> None:
    path = oscillator(tmp_path)
    whole = run_scenario(path)
    ended = run_scenario(path, changes={"until": {"hold": 0.1, "below": {"spring.stretch": 10.0}}})
    assert ended.complete
    assert ended.trusted
    assert 0.1 <= ended.times[-1] < 0.15
    for name, column in ended.columns.items():
        assert (column == whole.columns[name][: len(column)]).all()


def test_conditions_on_nothing_are_refused(tmp_path: Path) -> None:
    path = oscillator(tmp_path)
    with pytest.raises(ScenarioError, match=r"until: holds no condition; add below or above"):
        read_scenario(path, changes={"until": {"hold": 0.1}})
    with pytest.raises(ScenarioError, match=r'until.below: "spring.strech" matches no output; did you mean "spring.stretch"'):
        draw_up(read_scenario(path, changes={"until": {"hold": 0.1, "below": {"spring.strech": 1.0}}}), path)


def test_what_ends_a_run_alone_waits_for_nothing() -> None:
    now = np.zeros(2)
    board = SimpleNamespace(now=now, start_at=lambda unit, name: ("speed", "contact").index(name))
    until = Until(board, [CALM, TOUCHING, Bound(0, "speed", 5.0, below=False, alone=True)], 20)     # type: ignore[arg-type]
    assert told(until, now, [(0, 4.9, 0.0), (10, -5.1, 0.0)]) == [False, True]


def test_a_run_ends_at_once_beyond_a_bound_that_stands_alone(tmp_path: Path) -> None:
    path = oscillator(tmp_path)
    whole = run_scenario(path)
    name, column = next((name, column) for name, column in whole.columns.items() if name.endswith("stretch"))
    limit = 0.5 * float(np.abs(column).max())
    ended = run_scenario(path, changes={"until": {"hold": 9.0, "beyond": {name: limit}}})
    assert ended.complete
    assert abs(ended.columns[name][-1]) >= limit
    assert (np.abs(ended.columns[name][:-1]) < limit).all()


def test_a_run_that_takes_too_long_ends_with_an_error_and_keeps_its_rows(tmp_path: Path) -> None:
    path = oscillator(tmp_path)
    result = run_scenario(path, changes={"master": {"wall_limit": 1e-9}})
    assert not result.trusted
    assert "master.wall_limit of 1e-09 s used up at t = " in result.message
    assert len(result.times) == 2  # the limit is looked at after each step


def test_a_condition_is_watched_though_nothing_else_is_recorded(tmp_path: Path) -> None:
    until = '\n[record]\nvariables = []\n[until]\nhold = 0.01\nbelow = { "a.position" = 1e9 }\n'
    result = run_scenario(oscillator(tmp_path, until))
    assert result.times[-1] < 0.05
    assert list(result.columns) == ["a.position"]
