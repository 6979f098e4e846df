"""Where an interval has to end: at times units announce, and just after changes of located outputs (docs/decisions/0007-events.md).

    scheduled   a unit's Real output `next_event_time` (s, any port prefix) as it stands at the start of the interval; not after now: none
    located     an output differs between start and end of an attempt longer than the tolerance: undone, and half of it tried. A half
                without the change is accepted, one with it is halved again, until a piece no longer than the tolerance ends just after it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from orchestrator.master.judge import StepLimits, fit_to_stop
from orchestrator.master.plan import Places, Plan
from orchestrator.master.settings import NANOSECONDS, in_ns

NOWHERE = -(2**62)
"""ns: a time before any run's."""


class Cut(NamedTuple):
    interval: int
    """ns"""
    why: str
    """For the log; empty where the interval is the controller's own."""


class Events:
    """Of one system. `aim` is the time (ns) up to which a change is known to happen, NOWHERE where none is."""

    MEMORY = ("aim", "sought")

    def __init__(self, plan: Plan, tolerance: float) -> None:
        """`tolerance` in s."""
        self._board, self._system = plan.board, plan.system
        self._tolerance = max(1, in_ns(tolerance))
        self._scheduled = [(plan.board.start_at(unit, name), unit) for unit, name in plan.scheduled]
        self._located = [(unit, name) for unit, names in enumerate(plan.system.located) for name in names]
        self.aim = NOWHERE
        self.sought = ""
        """The output whose change is aimed at."""
        self.warnings: list[str] = []

    def prepare(self, repeated: Sequence[bool], rollback: Sequence[bool], variable: bool) -> None:
        """Which outputs can be located: of repeated units, and of the others where all of them can be undone."""
        late = all(can or again for can, again in zip(rollback, repeated, strict=True))
        seen = [(unit, name) for unit, name in self._located if repeated[unit]] if variable else []
        after = [(unit, name) for unit, name in self._located if not repeated[unit]] if variable and late else []
        self._outputs = seen, after
        self._places = self._places_of(seen), self._places_of(after)
        self.warnings = [
            f"{self._label(unit, name)}: its changes are not located, because "
            + ("units that are stepped after it cannot roll back" if variable else "a unit takes one step size only")
            for unit, name in self._located
            if (unit, name) not in seen + after
        ]
        if not variable:
            names = [self._system.slaves[unit].name for _, unit in self._scheduled]
            self.warnings += [f"{name}: its scheduled times are not met, because a unit takes one step size only" for name in names]
            self._scheduled = []

    def cut(self, interval: int, time: int, limits: StepLimits, most: int) -> Cut:
        """The controller's interval, or less; never above `most`, which a refusal left."""
        why = ""
        instant, unit = self._next_scheduled(time)
        if unit >= 0:
            shorter = min(fit_to_stop(interval, instant - time, limits), most)
            if shorter != interval or time + shorter == instant:
                interval, why = shorter, f"scheduled {self._system.slaves[unit].name}"
        if self.aim > time:
            bracket = self.aim - time
            part = bracket if bracket <= self._tolerance else (bracket + 1) // 2
            if part <= interval:
                interval, why = part, f"event {self.sought}"
        return Cut(interval, why)

    def seen(self, interval: int, after: bool) -> str:
        """The first output that changed over an interval too long to let that pass; `after`: of the units stepped once."""
        places = self._places[after]
        if not places.size or interval <= self._tolerance:
            return ""
        changed = self._board.start[places] != self._board.now[places]
        return self._label(*self._outputs[after][int(changed.argmax())]) if changed.any() else ""

    def seek(self, sought: str, end: int) -> None:
        """It changes before this time, ns."""
        self.sought, self.aim = sought, end

    def pass_by(self, time: int) -> None:
        """A step to this time was accepted."""
        if time >= self.aim:
            self.sought, self.aim = "", NOWHERE

    def _next_scheduled(self, time: int) -> tuple[int, int]:
        """The earliest time announced, ns, and by whom; -1: by nobody."""
        earliest, who = 0, -1
        for place, unit in self._scheduled:
            announced = float(self._board.start[place])
            if abs(announced) < _FAR:
                instant = in_ns(announced)
                if instant > time and (who < 0 or instant < earliest):
                    earliest, who = instant, unit
        return earliest, who

    def _places_of(self, outputs: Sequence[tuple[int, str]]) -> Places:
        return np.array([self._board.start_at(unit, name) for unit, name in outputs], dtype=np.intp)

    def _label(self, unit: int, name: str) -> str:
        return f"{self._system.slaves[unit].name}.{name}"


_FAR = 9e18 / NANOSECONDS
"""s: later is never."""
