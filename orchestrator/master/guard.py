"""Explicit coupling beyond its limit shows as values that swing faster than the steps can tell, ever wider: the run then stops at once.

Where values held at the start of the interval go round a loop, errors grow with a factor γ a step. If both sides take the other's value at
the start, as here, the errors of a damper between masses grow as γ² = H/H₀, H₀ = m/C being the limit. Swings that do not grow (a force
that never pulls cuts them off) count too when they last.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.errors import TrustError
from orchestrator.master.coupling import UnitPair, pair_of
from orchestrator.master.plan import Plan
from orchestrator.master.settings import NANOSECONDS
from orchestrator.master.slave import Vector

SWINGS, LASTING = 4, 40
"""Swings in a row: growing tenfold within them, or without growth."""
FAST = 4
"""Steps: what takes longer from one turn to the next is motion that the steps resolve."""
SEEN = 0.02
"""Swings below this share of the largest value met do no harm."""


class Guard:
    """Over everything that travels on explicit connections."""

    MEMORY = ("memory",)

    def __init__(self, plan: Plan, explicit: Collection[UnitPair]) -> None:
        self._plan = plan
        links = [link for link in plan.system.links if pair_of(link) in explicit]
        self._sources = list(dict.fromkeys((link.source_unit, link.source) for link in links))
        self._pairs = {(link.source_unit, link.source): pair_of(link) for link in links}
        self._now = np.array([plan.board.now_at(*source) for source in self._sources], dtype=np.intp)
        self._start = np.array([plan.board.start_at(*source) for source in self._sources], dtype=np.intp)
        size = len(self._sources)
        self._direction, self._turn = np.zeros(size), plan.board.values[self._start].copy()
        self._largest, self._before, self._first = np.zeros(size), np.zeros(size), np.zeros(size)
        self._swings, self._since, self._steps = (np.zeros(size, dtype=np.intp) for _ in range(3))

    @property
    def memory(self) -> Vector:
        """What passes from one step to the next, for checkpoints."""
        return np.concatenate([np.asarray(it, dtype=np.float64) for it in self._arrays])

    @memory.setter
    def memory(self, values: Vector) -> None:
        for kept, mine in zip(np.split(values, len(self._arrays)), self._arrays, strict=True):
            mine[:] = kept

    @property
    def _arrays(self) -> tuple[NDArray[Any], ...]:
        return (self._direction, self._turn, self._largest, self._before, self._first, self._swings, self._since, self._steps)

    def check(self, time: int, interval: int) -> None:
        """After each step, before the board moves on; ns."""
        if not self._sources:
            return
        start, now = self._plan.board.values[self._start], self._plan.board.values[self._now]
        np.maximum(self._largest, np.abs(now), out=self._largest)
        self._since += 1
        self._steps += 1
        turned = (now - start) * self._direction < 0.0
        width = np.abs(start - self._turn)
        swings = turned & (self._since <= FAST) & (width > 0.5 * self._before) & (width > SEEN * self._largest)
        over = (turned & ~swings) | (self._since > FAST)
        self._swings[:] = np.where(over, 0, self._swings + swings)
        self._steps[self._swings <= 1] = 0
        self._first[:] = np.where(self._swings <= 1, width, self._first)
        growing = swings & (self._swings >= SWINGS) & (width > 10.0 * self._first)
        self._before[turned], self._turn[turned], self._since[turned] = width[turned], start[turned], 0
        self._direction[:] = np.where(now == start, self._direction, np.sign(now - start))
        beyond = np.flatnonzero(growing | (self._swings >= LASTING))
        if beyond.size:
            worst = int(beyond[0])
            growth = float(width[worst] / self._first[worst]) ** (1.0 / max(1, int(self._steps[worst])))
            self._stop(worst, time, interval, 0.5 / max(1.0, growth) ** 2)

    def _stop(self, worst: int, time: int, interval: int, share: float) -> None:
        source = self._sources[worst]
        names = " <-> ".join(self._plan.system.slaves[unit].name for unit in sorted(self._pairs[source]))
        variable = f"{self._plan.system.slaves[source[0]].name}.{source[1]}"
        raise TrustError(
            f"{names}: explicit coupling is beyond its stability limit at t = {time / NANOSECONDS:.6g} s: {variable} swings to and fro"
            f" within a few steps of {interval / NANOSECONDS:.3g} s; an interval of about {share * interval / NANOSECONDS:.2g} s would do:"
            " set master.max_interval and min_interval to it, or use units that can roll back"
        )
