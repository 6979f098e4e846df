"""A crew: the same results however many fly and however often it is interrupted, and nothing is flown twice."""

import signal
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from diagnosis_samples import Logged, coordinate, ringing, ringing_landing
from numpy.typing import NDArray

from orchestrator.diagnosis.crew import Crew, Store, content, passed_on, unbroken
from orchestrator.diagnosis.fit import fitted
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.problem import Landings, Model

Array = NDArray[np.float64]
NAMES = ("v", "w", "phase", "tilt")


@dataclass(frozen=True)
class FitOne:
    """A fit from a point."""

    landings: Landings
    z: Array

    def __call__(self, lander: Lander) -> object:
        model = Model(self.landings, [coordinate(n, 0.15) for n in NAMES], lander)
        predicted = model.predict(self.z)
        assert predicted is not None
        return fitted(model, self.z, model.slopes(self.z, predicted)[:, :], predicted)


def tasks(count: int = 6) -> list[FitOne]:
    landings, random = ringing_landing({"v": 1.1}), np.random.default_rng(0)
    starts = 0.5 * random.standard_normal((4, count))
    return [FitOne(landings, starts[:, i]) for i in range(count)]


def flown(log: Path) -> int:
    return log.stat().st_size if log.exists() else 0


def test_one_and_two_workers_come_to_the_same_bytes() -> None:
    alone, together = Crew(ringing, 1), Crew(ringing, 2)
    try:
        assert [content(r) for r in alone.run(tasks())] == [content(r) for r in together.run(tasks())]
        assert alone.flown == together.flown > 0
    finally:
        together.close()


def test_what_is_in_the_store_is_not_flown_again_and_still_counted(tmp_path: Path) -> None:
    log = tmp_path / "log"
    first = Crew(Logged(log), 1, Store(tmp_path / "work"))
    results = first.run(tasks())
    before = flown(log)
    again = Crew(Logged(log), 1, Store(tmp_path / "work"))
    assert [content(r) for r in again.run(tasks())] == [content(r) for r in results]
    assert flown(log) == before == first.flown == again.flown


def test_a_crew_interrupted_half_way_goes_on_to_the_same_results(tmp_path: Path) -> None:
    whole = Crew(ringing, 1)
    expected = [content(r) for r in whole.run(tasks())]
    log = tmp_path / "log"
    stopped = Crew(Logged(log, whole.flown // 2), 1, Store(tmp_path / "work"))
    with pytest.raises(KeyboardInterrupt):
        stopped.run(tasks())
    before = flown(log)
    on = Crew(Logged(log), 1, Store(tmp_path / "work"))
    assert [content(r) for r in on.run(tasks())] == expected
    assert flown(log) - before < whole.flown
    assert on.flown == whole.flown


def test_a_task_made_of_stored_results_has_the_key_it_had_before(tmp_path: Path) -> None:
    """Whether an array is a view, and whether two members are one object, must not matter to what is resumed."""
    store = Store(tmp_path)
    (kept,) = Crew(ringing, 1, store).run(tasks(1))
    (read,) = Crew(ringing, 1, store).run(tasks(1))
    landings = tasks(1)[0].landings
    assert store.key(FitOne(landings, kept.z)) == store.key(FitOne(passed_on(landings), read.z))


def test_other_units_or_other_data_are_not_answered_from_the_store(tmp_path: Path) -> None:
    unit = tmp_path / "unit.fmu"
    unit.write_bytes(b"one")
    (task,) = tasks(1)
    before = Store(tmp_path / "work", [unit]).key(task)
    unit.write_bytes(b"two")
    assert Store(tmp_path / "work", [unit]).key(task) != before
    assert Store(tmp_path / "work", [unit], "another interval").key(task) != Store(tmp_path / "work", [unit]).key(task)
    assert Store(tmp_path / "work").key(FitOne(task.landings, 1.001 * task.z)) != Store(tmp_path / "work").key(task)


def test_a_result_half_written_is_made_again(tmp_path: Path) -> None:
    store = Store(tmp_path)
    (task,) = tasks(1)
    (tmp_path / store.key(task)).write_bytes(b"\x80\x05")
    assert store.get(store.key(task)) == (False, None)


def test_progress_is_told_to_the_end_whatever_the_store_knows(tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    Crew(ringing, 1, Store(tmp_path)).run(tasks(3))
    Crew(ringing, 1, Store(tmp_path)).run(tasks(4), lambda done, of: told.append((done, of)))
    assert told[-1] == (4, 4)


def test_an_interrupt_waits_until_a_landing_is_over() -> None:
    ended = []

    def landing() -> None:
        with unbroken():
            signal.raise_signal(signal.SIGINT)
            ended.append(True)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs inherit that it is ignored
    try:
        with pytest.raises(KeyboardInterrupt):
            landing()
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    assert ended
