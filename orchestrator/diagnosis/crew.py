"""Who flies the landings of a search: tasks in this process, or in a crew of processes, each with a lander of its own that is reused.

A task is a picklable object called with a lander. Its result depends on itself alone, so a result already in the store is taken from there:
an interrupted diagnosis goes on where it stopped, to the same numbers.
"""

from __future__ import annotations

import hashlib
import pickle
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Protocol, TypeVar

from orchestrator.diagnosis.landing import Lander

Result = TypeVar("Result", covariant=True)
Heard = Callable[[int, int], None]
"""Called with (done, of) as tasks end."""


class Task(Protocol[Result]):
    """Something to do with a lander."""

    def __call__(self, lander: Lander) -> Result: ...


class Store:
    """Results of tasks by content, in a folder; without one nothing is kept."""

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)

    def key(self, task: Task[Any]) -> str:
        return hashlib.sha256(pickle.dumps(task, protocol=5)).hexdigest()[:32] if self.folder else ""

    def get(self, key: str) -> tuple[bool, Any]:
        path = self.folder / key if self.folder else None
        if path is None or not path.is_file():
            return False, None
        try:
            return True, pickle.loads(path.read_bytes())
        except Exception:  # half written when the machine went down: done again
            return False, None

    def put(self, key: str, result: Any) -> None:
        if self.folder is None:
            return
        unfinished = self.folder / f".{key}"
        unfinished.write_bytes(pickle.dumps(result, protocol=5))
        unfinished.replace(self.folder / key)


class Crew:
    """Runs tasks and keeps count of the landings they flew."""

    def __init__(self, make: Callable[[], Lander], workers: int = 1, store: Store | None = None) -> None:
        """make: a picklable maker of landers; workers: processes, 1 for this one."""
        self.make, self.workers, self.store = make, workers, store or Store(None)
        self.flown = 0
        self._own: Lander | None = None
        self._pool: ProcessPoolExecutor | None = None

    def run(self, tasks: Sequence[Task[Any]], heard: Heard | None = None) -> list[Any]:
        """The tasks' results in their order."""
        keys = [self.store.key(task) for task in tasks]
        known = [self.store.get(key) for key in keys]
        results: list[Any] = [result for _, result in known]
        missing = [i for i, (found, _) in enumerate(known) if not found]
        done = len(tasks) - len(missing)
        for i, (flown, result) in self._each(tasks, missing):
            self.flown += flown
            results[i] = result
            self.store.put(keys[i], result)
            done += 1
            if heard is not None:
                heard(done, len(tasks))
        return results

    def close(self) -> None:
        if self._own is not None:
            self._own.close()
            self._own = None
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = None

    def _each(self, tasks: Sequence[Task[Any]], which: Sequence[int]) -> Iterator[tuple[int, tuple[int, Any]]]:
        if not which:
            return
        if self.workers == 1 or len(which) == 1:
            self._own = self._own or self.make()
            for i in which:
                yield i, counted(tasks[i], self._own)
            return
        if self._pool is None:
            self._pool = ProcessPoolExecutor(self.workers, get_context("spawn"), initializer=_begin, initargs=(self.make,))
        futures = {self._pool.submit(_work, tasks[i]): i for i in which}
        for future in as_completed(futures):
            yield futures[future], future.result()


class Counting:
    """A lander that counts."""

    def __init__(self, lander: Lander) -> None:
        self.lander, self.flown = lander, 0

    def land(self, *arguments: Any) -> Any:
        self.flown += 1
        return self.lander.land(*arguments)

    def close(self) -> None:
        self.lander.close()


def counted(task: Task[Any], lander: Lander) -> tuple[int, Any]:
    """Landings flown, and the task's result."""
    counting = Counting(lander)
    result = task(counting)
    return counting.flown, result


_lander: Lander | None = None


def _begin(make: Callable[[], Lander]) -> None:
    global _lander
    _lander = make()


def _work(task: Task[Any]) -> tuple[int, Any]:
    if _lander is None:
        raise RuntimeError("the worker has no lander")
    return counted(task, _lander)
