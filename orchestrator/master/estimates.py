"""All there is to judge a step by, in one place: see `estimate` and `block` for the single ones."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan

from orchestrator.master.block import Block
from orchestrator.master.coupling import Coupling, pair_of
from orchestrator.master.estimate import HeldEstimate, ModelEstimate, MotionEstimate, larger
from orchestrator.master.plan import Plan
from orchestrator.master.ports import motion_ports
from orchestrator.master.settings import MasterSettings

Estimate = tuple[float, str]


class Estimates:
    """Of one system, coupled one way."""

    def __init__(self, plan: Plan, coupling: Coupling, blocks: Sequence[Block], passes: int, settings: MasterSettings) -> None:
        system, board, reduced, repeated = plan.system, plan.board, plan.reduced, coupling.repeated
        self.warnings: list[str] = []
        self._blocks, self._passes = blocks, passes
        inner = [repeated[p.owner] and repeated[p.partner] for p in reduced]
        # With no repeated port at all, the models are still measured, after the units that are stepped once.
        self.model_is_late = not any(inner) and bool(inner)
        self.model = ModelEstimate(board, reduced, inner if any(inner) else [True] * len(inner), settings.model_lever)
        if any(inner) and not all(inner):
            label = reduced[inner.index(False)].label
            self.warnings.append(f"{label}: a unit there is stepped once per accepted step, so its model gives no estimate")
        solved = {pair_of(link) for link in coupling.lines}
        asked = [slave.name in system.once for slave in system.slaves]

        def passed(source: int, target: int) -> bool:
            pair = frozenset((source, target))
            return repeated[source] and repeated[target] and pair not in solved and pair not in coupling.explicit

        def held(source: int, target: int) -> bool:
            looped = coupling.in_loop[source] and coupling.in_loop[target] and not asked[source] and not asked[target]
            return looped and not (repeated[source] and repeated[target] and frozenset((source, target)) not in coupling.explicit)

        self.motion = MotionEstimate(board, motion_ports(system, passed), settings.motion_lever)
        self.held = HeldEstimate(board, motion_ports(system, held), settings.motion_lever)
        judged = self.model.count or self.held.count or blocks or (self.motion.count and passes > 1)
        looped = [slave.name in system.once for slave, loop in zip(system.slaves, coupling.in_loop, strict=True) if loop]
        if looped and not judged and not all(looped):
            self.warnings.append("no port gives an error estimate: every interval is max_interval; check by halving it")

    @property
    def late(self) -> bool:
        """Whether something can be said only after the units that are stepped once."""
        return bool(self.model_is_late or self.held.count)

    def before_pass(self) -> None:
        """Between two passes."""
        if not self.model_is_late:
            self.model.measure()
            self.model.accumulate()
        self.motion.remember()

    def after_passes(self) -> None:
        if not self.model_is_late:
            self.model.measure()

    def of_passes(self, interval: float) -> Estimate:
        """m, and where; `interval` in s."""
        estimate = self.motion.estimate(interval) if self._passes > 1 else (nan, "")
        for block in self._blocks:
            estimate = larger(estimate, block.estimate(interval))
        return estimate if self.model_is_late else larger(self.model.estimate(interval), estimate)

    def of_everything(self, interval: float) -> Estimate:
        """After the units that are stepped once."""
        estimate = larger(self.of_passes(interval), self.held.estimate(interval))
        if not self.model_is_late:
            return estimate
        self.model.measure()
        return larger(self.model.estimate(interval), estimate)
