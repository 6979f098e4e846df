"""Error estimates of one step: what the reduced interface models missed, and how far motion moved between passes.

    ports with a model:   H·max(|Δv|, 0.3 m·|Δω|),  Δ = what the model's owner reached − what the partner predicted
    other motion:         H·max(|Δv|, 4 m·|Δω|),    Δ = last pass − the pass before
    motion held over H:   H/2·max(|Δv|, 4 m·|Δω|),  Δ = end − start, where explicit coupling is all there is

The partner's prediction in a pass already contains the mismatch it was given in that pass; the mismatch accumulates what is still missed.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import nan

import numpy as np
from numpy.typing import NDArray

from orchestrator.master.plan import Board
from orchestrator.master.ports import MotionPort, ReducedPort


class Norms:
    """max(|Δv|, lever·|Δω|) of rows of six."""

    def __init__(self, labels: Sequence[str], lever: float) -> None:
        self.labels = list(labels)
        self._lever = lever

    def largest(self, delta: NDArray[np.float64]) -> tuple[float, str]:
        """Over the rows; m/s, and which row."""
        if len(self.labels) == 1:
            a, b, c, d, e, f = delta.tolist()
            return max(a * a + b * b + c * c, self._lever**2 * (d * d + e * e + f * f)) ** 0.5, self.labels[0]
        squares = np.square(delta).reshape(len(self.labels), 2, 3).sum(axis=2)
        norms = np.maximum(squares[:, 0], self._lever**2 * squares[:, 1])
        worst = int(norms.argmax())
        return float(norms[worst]) ** 0.5, self.labels[worst]


class ModelEstimate:
    """Over the ports with a reduced interface model; also keeps the mismatches on the board."""

    def __init__(self, board: Board, ports: Sequence[ReducedPort], active: Sequence[bool], lever: float) -> None:
        """A port that is not active counts as one that missed nothing."""
        self._board = board
        self.count = len(ports)
        self._norms = Norms([port.label for port in ports], lever)
        none = ("",) * 6
        rows = list(zip(ports, active, strict=True))
        self._reached = _places(board, [(port.owner, port.reached if on else none) for port, on in rows])
        self._predicted = _places(board, [(port.partner, port.predicted if on else none) for port, on in rows])
        self._missed = np.zeros(6 * len(ports))

    def reset(self) -> None:
        self._board.mismatch[:] = 0.0

    def measure(self) -> None:
        """After a pass: what was missed in it."""
        values = self._board.values
        np.subtract(values[self._reached], values[self._predicted], out=self._missed)

    def accumulate(self) -> None:
        """Hand what was missed to the next pass."""
        self._board.mismatch += self._missed

    def estimate(self, interval: float) -> tuple[float, str]:
        """m, and the port; NaN where there is no such port."""
        if not self.count:
            return nan, ""
        speed, label = self._norms.largest(self._missed)
        return interval * speed, label


class MotionEstimate:
    """Over the ports that give motion, between two passes."""

    def __init__(self, board: Board, ports: Sequence[MotionPort], lever: float) -> None:
        self._board = board
        self.count = len(ports)
        self._norms = Norms([port.label for port in ports], lever)
        self._places = _places(board, [(port.unit, port.names) for port in ports])
        self._before = np.zeros(6 * len(ports))

    def remember(self) -> None:
        """Before the last pass."""
        np.take(self._board.values, self._places, out=self._before, mode="clip")

    def estimate(self, interval: float) -> tuple[float, str]:
        if not self.count:
            return nan, ""
        speed, label = self._norms.largest(self._board.values[self._places] - self._before)
        return interval * speed, label


class HeldEstimate:
    """Over the ports whose motion is held over the interval, because a side cannot be repeated."""

    def __init__(self, board: Board, ports: Sequence[MotionPort], lever: float) -> None:
        self._board = board
        self.count = len(ports)
        self._norms = Norms([port.label for port in ports], lever)
        self._now = _places(board, [(port.unit, port.names) for port in ports])
        self._start = np.where(self._now == board.zero, board.zero, self._now - len(board.names))

    def estimate(self, interval: float) -> tuple[float, str]:
        if not self.count:
            return nan, ""
        speed, label = self._norms.largest(self._board.values[self._now] - self._board.values[self._start])
        return 0.5 * interval * speed, label


def larger(first: tuple[float, str], second: tuple[float, str]) -> tuple[float, str]:
    """The larger estimate; NaN counts as none."""
    if np.isnan(first[0]):
        return second
    return first if np.isnan(second[0]) or first[0] >= second[0] else second


def _places(board: Board, rows: Sequence[tuple[int, tuple[str, ...]]]) -> NDArray[np.intp]:
    flat = [board.now_at(unit, name) if name else board.zero for unit, names in rows for name in names]
    return np.array(flat, dtype=np.intp)
