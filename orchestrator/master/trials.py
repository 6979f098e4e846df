"""What each unit claims, tried before the first step: a claim that is not true is worse than none.

    rollback            save, step, restore, step: the same bits three times (which a unit that is not deterministic fails too); an error,
                        unless the scenario has the unit stepped once anyway
    serialisation       the state as bytes and back: the same bytes, and the same bits from there
    step-size           one step of H against two of H/2 with the same inputs: the largest relative difference, reported, not judged
"""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from orchestrator.master.plan import Plan, companion
from orchestrator.master.result import TrialRecord
from orchestrator.master.settings import NANOSECONDS
from orchestrator.master.slave import Slave, Status, Vector
from orchestrator.master.watchdog import Watchdog

Outcome = tuple[Status, bytes]


@runtime_checkable
class Serialises(Protocol):
    def serialised_state(self) -> bytes: ...
    def adopt_state(self, data: bytes) -> None: ...


class Trial:
    """Of one unit, at its start; what it finds stands in `record`."""

    def __init__(self, plan: Plan, unit: int, time: int, watchdog: Watchdog) -> None:
        self._slave: Slave = plan.system.slaves[unit]
        board, begin = plan.board, plan.board.offset[unit]
        self._y: Vector = board.now[begin : begin + sum(owner == unit for owner, _ in board.names)]
        self._names = [name for owner, name in board.names if owner == unit]
        self._at_start = self._y.copy()
        self._time, self._watchdog = time, watchdog
        interface = self._slave.interface
        linked = {link.target for link in plan.system.links if link.target_unit == unit}
        self.record = TrialRecord(
            rollback="not claimed",
            serialisation="claimed" if interface.claims("canSerializeFMUstate") else "not claimed",
            variable_step=interface.capabilities.get("canHandleVariableCommunicationStepSize", True),
            slopes=sum(companion(name, "_slope") in interface.variables for name in linked),
            interpolates=interface.claims("canInterpolateInputs"),
        )
        self.untrue = ""
        """What differed after going back, where rollback is claimed and not true."""
        self.spoilt = False
        """Whether the unit could not be put back to its start."""

    def run(self, longest: int, shortest: int) -> None:
        """`longest` and `shortest` interval in ns."""
        if not self._slave.interface.claims("canGetAndSetFMUstate"):
            return
        self._slave.save()
        interval = longest
        first = self._outcome(interval)
        while first[0] is Status.DISCARD and interval // 2 >= shortest:
            interval //= 2
            first = self._outcome(interval)
        for _ in range(2):
            again = self._outcome(interval)
            if again != first:
                self.record = self.record.but(rollback="claimed, not true")
                self.untrue = self._difference(first, again)
                self.spoilt = True
                return
        self.record = self.record.but(rollback="true")
        if first[0] is not Status.DISCARD and self.record.variable_step:
            self._halve(interval, np.frombuffer(first[1]))
        if self.record.serialisation == "claimed" and isinstance(self._slave, Serialises):
            self._serialise(self._slave, interval, first)

    def _difference(self, first: Outcome, again: Outcome) -> str:
        """The first output that is not the same."""
        before, after = np.frombuffer(first[1]), np.frombuffer(again[1])
        apart = np.flatnonzero(before.view(np.int64) != after.view(np.int64))
        if not len(apart):
            return f"a step is {first[0].name} and, repeated, {again[0].name}"
        at = int(apart[0])
        return f"{self._names[at]} is {before[at]:.9g} after a step and {after[at]:.9g} after going back and stepping again"

    def _halve(self, interval: int, whole: Vector) -> None:
        half = interval // 2
        status = self._step(self._time, half)
        if status is not Status.DISCARD:
            status = self._step(self._time + half, interval - half)
        if status is not Status.DISCARD:
            self._slave.observe()
            nominal = np.array([abs(self._slave.interface.variables[name].nominal) or 1.0 for name in self._names])
            scale = np.maximum(nominal, np.abs(whole))
            apart = np.abs(self._y - whole) / scale
            worst = int(apart.argmax()) if len(apart) else -1
            if worst >= 0:
                self.record = self.record.but(step_size_difference=float(apart[worst]), step_size_variable=self._names[worst])
        self._back()

    def _serialise(self, unit: Serialises, interval: int, first: Outcome) -> None:
        data = unit.serialised_state()
        self._step(self._time, interval)
        unit.adopt_state(data)
        self._back()
        self._slave.save()
        same = unit.serialised_state() == data and self._outcome(interval) == first
        self.spoilt = not same
        self.record = self.record.but(serialisation="true" if same else "claimed, not true")

    def _outcome(self, interval: int) -> Outcome:
        status = self._step(self._time, interval)
        if status is not Status.DISCARD:
            self._slave.observe()
        bits = self._y.tobytes()
        self._back()
        return status, bits

    def _step(self, time: int, interval: int) -> Status:
        self._watchdog.enter(self._slave.name)
        status = self._slave.step(time / NANOSECONDS, interval / NANOSECONDS)
        self._watchdog.leave()
        return status

    def _back(self) -> None:
        self._slave.restore()
        self._y[:] = self._at_start


def warnings_of(name: str, record: TrialRecord) -> list[str]:
    found = []
    if record.rollback == "claimed, not true":
        found.append(f"{name}: claims rollback but does not return to the same bits; it is never taken back")
    if record.serialisation == "claimed, not true":
        found.append(f"{name}: claims to serialise its state but does not go on from the bytes with the same bits; no checkpoints with it")
    return found
