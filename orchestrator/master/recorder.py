"""Rows of recorded outputs at accepted steps, and the energy ledger of joined ports."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from orchestrator.master.plan import Board
from orchestrator.master.result import LedgerRow
from orchestrator.master.slave import Vector
from orchestrator.master.system import System


class Recorder:
    """A table that grows by doubling."""

    MEMORY = ("rows", "_due")

    def __init__(self, system: System, board: Board, interval: int) -> None:
        """`interval` in ns; 0 records every accepted step."""
        wanted = [(unit, name) for unit, names in enumerate(system.recorded) for name in names]
        self.names = [f"{system.slaves[unit].name}.{name}" for unit, name in wanted]
        self._places = np.array([board.start_at(unit, name) for unit, name in wanted], dtype=np.intp)
        self._now = board.now
        self._interval = interval
        self._due = 0
        self._times = np.empty(256)
        self._rows = np.empty((256, len(wanted)))
        self._count = 0
        self._early = False

    def is_due(self, elapsed: int, last: bool) -> bool:
        """Whether a step that ends `elapsed` ns after the start is to be recorded."""
        return self._interval == 0 or last or elapsed >= self._due

    def record(self, time: float, elapsed: int) -> None:
        if self._count == len(self._times):
            self._times = np.concatenate([self._times, np.empty_like(self._times)])
            self._rows = np.concatenate([self._rows, np.empty_like(self._rows)])
        self._times[self._count] = time
        np.take(self._now, self._places, out=self._rows[self._count], mode="clip")
        self._early = elapsed < self._due
        self._count += 1
        if self._interval:
            self._due = (elapsed // self._interval + 1) * self._interval

    @property
    def rows(self) -> Vector:
        """Time and columns, without a last row that only a stop asked for: a run that goes on does not have it."""
        kept = self._count - self._early
        return np.column_stack([self._times[:kept], self._rows[:kept]])

    @rows.setter
    def rows(self, table: Vector) -> None:
        self._count, self._early = len(table), False
        self._times = np.concatenate([table[:, 0], np.empty(256)])
        self._rows = np.concatenate([table[:, 1:], np.empty((256, self._rows.shape[1]))])

    @property
    def times(self) -> Vector:
        return self._times[: self._count].copy()

    def columns(self) -> dict[str, Vector]:
        return {name: self._rows[: self._count, at].copy() for at, name in enumerate(self.names)}


class Ledger:
    """Work done on each side of every joined pair of ports where both report it, J."""

    MEMORY = ("_begin", "_last", "_throughput")

    def __init__(self, system: System, board: Board) -> None:
        self._labels: list[tuple[str, str]] = []
        places: list[tuple[int, int]] = []
        for pair in system.pairs:
            first, second = (pair.first_unit, f"{pair.first_port}.work"), (pair.second_unit, f"{pair.second_port}.work")
            if first in board.place and second in board.place:
                self._labels.append((system.label(pair.first_unit, pair.first_port), system.label(pair.second_unit, pair.second_port)))
                places.append((board.start_at(*first), board.start_at(*second)))
        self._places = np.array(places, dtype=np.intp).reshape(-1, 2)
        self._now = board.now
        self._begin = np.zeros((len(places), 2))
        self._last = np.zeros((len(places), 2))
        self._throughput = np.zeros(len(places))

    def open(self) -> None:
        """At the start of the run."""
        self._begin = self._now[self._places]
        self._last = self._begin.copy()

    def enter(self) -> None:
        """After an accepted step."""
        if len(self._labels):
            work = self._now[self._places]
            self._throughput += np.abs(work - self._last).max(axis=1)
            self._last = work

    def rows(self) -> list[LedgerRow]:
        work: Sequence[Sequence[float]] = (self._last - self._begin).tolist()
        return [
            LedgerRow(first, second, done[0], done[1], float(through))
            for (first, second), done, through in zip(self._labels, work, self._throughput, strict=True)
        ]
