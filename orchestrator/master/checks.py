"""What the master does not take on trust: values, and claims of rollback."""

from __future__ import annotations

import numpy as np

from orchestrator.errors import StepError
from orchestrator.master.plan import Plan
from orchestrator.master.settings import NANOSECONDS
from orchestrator.master.slave import Slave, Status, Vector


def check_finite(plan: Plan, time: int) -> None:
    """A StepError that names the first output that is not finite, if there is one; `time` in ns."""
    now = plan.board.now
    if np.isfinite(now.sum()):
        return
    for place in np.flatnonzero(~np.isfinite(now)):
        unit, name = plan.board.names[place]
        slave = plan.system.slaves[unit]
        said = f"it said: {slave.messages[-1]}" if slave.messages else "it gave no message"
        raise StepError(f"{slave.name}: {name} is {now[place]} near t = {time / NANOSECONDS:.9g} s, expects a finite number; {said}")


def truly_rolls_back(plan: Plan, unit: int, time: int, interval: int, warnings: list[str]) -> bool:
    """Whether a unit that claims rollback keeps its word over one step; a warning where it does not. Times in ns."""
    slave, board = plan.system.slaves[unit], plan.board
    if not slave.interface.claims("canGetAndSetFMUstate"):
        return False
    begin = board.offset[unit]
    y = board.now[begin : begin + sum(owner == unit for owner, _ in board.names)]
    if rolls_back(slave, y, time / NANOSECONDS, interval / NANOSECONDS):
        return True
    warnings.append(f"{slave.name}: claims rollback but does not return to the same bits; stepped once per accepted step instead")
    return False


def rolls_back(slave: Slave, y: Vector, time: float, interval: float) -> bool:
    """Save, step, restore, step again: the same bits each time? Leaves the unit as it was."""
    at_start = y.copy()

    def outcome() -> tuple[Status, bytes]:
        status = slave.step(time, interval)
        if status is not Status.DISCARD:
            slave.observe()
        bits = y.tobytes()
        slave.restore()
        y[:] = at_start
        return status, bits

    slave.save()
    return outcome() == outcome() == outcome()
