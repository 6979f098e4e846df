"""Who flies the landings of a search: tasks in this process, or in a crew of processes, each with a lander of its own that is reused.

A task is a picklable object called with a lander. Its result depends on itself and on the FMUs alone, so a result already in the store is
taken from there: an interrupted diagnosis goes on where it stopped, to the same numbers. Whoever flies a task, in this process or another,
gets it through a pickle, and so does its result: which parts are one object, and how an array lies in memory, is the same everywhere.
"""

from __future__ import annotations

import gc
import hashlib
import io
import multiprocessing
import os
import pickle
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Protocol, TypeVar

from orchestrator.diagnosis.landing import Lander
from orchestrator.interruption import unbroken, unheard

Result = TypeVar("Result")
Given = TypeVar("Given", covariant=True)
Heard = Callable[[int, int], None]
"""Called with (done, of) as tasks end."""


class Task(Protocol[Given]):
    """Something to do with a lander."""

    def __call__(self, lander: Lander) -> Given: ...


class Store:
    """What tasks came to, by their content, in a folder; without one nothing is kept."""

    def __init__(self, folder: Path | None, flown_by: Sequence[Path] = (), told: str = "") -> None:
        """flown_by: the FMUs; told: what else landings depend on and tasks do not say. What others flew is not taken."""
        self.folder = folder
        self._units = b"".join(hashlib.sha256(path.read_bytes()).digest() for path in flown_by) + told.encode()
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)

    def key(self, task: Task[Any]) -> str:
        return hashlib.sha256(self._units + content(task)).hexdigest()[:32] if self.folder else ""

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
    """Runs tasks and keeps count of the landings they flew, those of an earlier call that the store kept among them."""

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
        missing = [i for i, (found, _) in enumerate(known) if not found]
        done = len(tasks) - len(missing)
        results: list[Any] = [kept[1] if found else None for found, kept in known]
        self.flown += sum(kept[0] for found, kept in known if found)
        for i, (flown, result) in self._each(tasks, missing):
            self.flown += flown
            results[i] = result
            self.store.put(keys[i], (flown, result))
            done += 1
            if heard is not None:
                heard(done, len(tasks))
        return results

    def close(self) -> None:
        if self._own is not None:
            self._own.close()
            self._own = None
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None
            gc.collect()  # the pool's semaphores go with it; left to the end they are complained of as leaked

    def abandon(self) -> None:
        """Close without waiting for what is being flown."""
        if self._pool is not None:
            for process in list((self._pool._processes or {}).values()):
                process.terminate()
        self.close()

    def _each(self, tasks: Sequence[Task[Any]], which: Sequence[int]) -> Iterator[tuple[int, tuple[int, Any]]]:
        if not which:
            return
        if self.workers == 1 or len(which) == 1:
            with unbroken():
                self._own = self._own or self.make()
            for i in which:
                yield i, passed_on(counted(passed_on(tasks[i]), self._own))
            return
        if self._pool is None:
            self._pool = ProcessPoolExecutor(self.workers, get_context("spawn"), initializer=_begin, initargs=(self.make,))
        with unheard():
            futures = {self._pool.submit(_work, tasks[i]): i for i in which}
        for future in as_completed(futures):
            yield futures[future], future.result()


class Counting:
    """A lander that counts."""

    def __init__(self, lander: Lander) -> None:
        self.lander, self.flown = lander, 0
        self.varies = lander.varies

    def land(self, *arguments: Any) -> Any:
        self.flown += 1
        with unbroken():
            return self.lander.land(*arguments)

    def close(self) -> None:
        self.lander.close()


def counted(task: Task[Any], lander: Lander) -> tuple[int, Any]:
    """Landings flown, and the task's result."""
    counting = Counting(lander)
    result = task(counting)
    return counting.flown, result


def content(task: Any) -> bytes:
    """The task without regard to which of its parts are one object: equal tasks, equal bytes."""
    written = io.BytesIO()
    pickler = pickle.Pickler(written, protocol=5)
    pickler.fast = True
    pickler.dump(task)
    return written.getvalue()


def passed_on(thing: Result) -> Result:
    """The thing as another process would get it."""
    copy: Result = pickle.loads(pickle.dumps(thing, protocol=5))
    return copy


_lander: Lander | None = None


def _begin(make: Callable[[], Lander]) -> None:
    global _lander
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    _lander = make()


def _leave_with_parent() -> None:
    """A worker whose parent was killed would wait for work for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _work(task: Task[Any]) -> tuple[int, Any]:
    if _lander is None:
        raise RuntimeError("the worker has no lander")
    return counted(task, _lander)
