"""What the master does not take on trust: values."""

from __future__ import annotations

import numpy as np

from orchestrator.errors import StepError
from orchestrator.master.plan import Plan
from orchestrator.master.settings import NANOSECONDS


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
