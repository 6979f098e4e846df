"""An end before the stop time: at the first recorded instant at which every condition has held for a while."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from orchestrator.master.plan import Board


@dataclass(frozen=True)
class Bound:
    """An output (by its unit's place and its name) whose magnitude must be below, or not below, the limit."""

    unit: int
    output: str
    limit: float
    below: bool


class Until:
    """Asked at recorded instants only: between them nobody fetches what is only recorded."""

    MEMORY = ("since",)

    def __init__(self, board: Board, bounds: Sequence[Bound] = (), hold: int = 0) -> None:
        """hold: ns. Without bounds it is never met."""
        places = np.array([board.start_at(bound.unit, bound.output) for bound in bounds], dtype=np.intp)
        limits = np.array([bound.limit for bound in bounds])
        below = np.array([bound.below for bound in bounds], dtype=bool)
        self._now, self._places, self._limits, self._below, self._hold = board.now, places, limits, below, hold
        self.since = -1
        """ns after the start, of the first instant of those at which all held without a break; -1: at the last one they did not."""

    def met(self, elapsed: int) -> bool:
        """Whether the instant `elapsed` ns after the start is the end."""
        if not len(self._places):
            return False
        if not ((np.abs(self._now[self._places]) < self._limits) == self._below).all():
            self.since = -1
            return False
        if self.since < 0:
            self.since = elapsed
        return elapsed - self.since >= self._hold
