"""An end before the stop time: at the first recorded instant at which every condition has held for a while, or one for which none waits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from orchestrator.master.plan import Board


@dataclass(frozen=True)
class Bound:
    """An output (by its unit's place and its name) whose magnitude must be below, or not below, the limit."""

    unit: int
    output: str
    limit: float
    below: bool
    alone: bool = False
    """Ends the run by itself and at once."""


class Conditions(NamedTuple):
    """Bounds as arrays."""

    places: NDArray[np.intp]
    limits: NDArray[np.float64]
    below: NDArray[np.bool_]


class Until:
    """Asked at recorded instants only: between them nobody fetches what is only recorded."""

    MEMORY = ("since",)

    def __init__(self, board: Board, bounds: Sequence[Bound] = (), hold: int = 0) -> None:
        """hold: ns. Without bounds it is never met."""
        self._now, self._hold = board.now, hold
        self._together = _conditions(board, [bound for bound in bounds if not bound.alone])
        self._alone = _conditions(board, [bound for bound in bounds if bound.alone])
        self.since = -1
        """ns after the start, of the first instant of those at which all held without a break; -1: at the last one they did not."""

    def met(self, elapsed: int) -> bool:
        """Whether the instant `elapsed` ns after the start is the end."""
        if self._hold_of(self._alone).any():
            return True
        if not len(self._together.places):
            return False
        if not self._hold_of(self._together).all():
            self.since = -1
            return False
        if self.since < 0:
            self.since = elapsed
        return elapsed - self.since >= self._hold

    def _hold_of(self, these: Conditions) -> NDArray[np.bool_]:
        """Which of them hold now."""
        held: NDArray[np.bool_] = (np.abs(self._now[these.places]) < these.limits) == these.below
        return held


def _conditions(board: Board, bounds: Sequence[Bound]) -> Conditions:
    places = np.array([board.start_at(bound.unit, bound.output) for bound in bounds], dtype=np.intp)
    return Conditions(places, np.array([bound.limit for bound in bounds]), np.array([bound.below for bound in bounds], dtype=bool))
