"""One pass over an interval: every unit of it in order, blocks solved on the way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from orchestrator.master.block import Block
from orchestrator.master.coupling import Coupling
from orchestrator.master.plan import Job, Phase, Plan
from orchestrator.master.ports import MotionPort, motion_ports
from orchestrator.master.refusal import Refusal, refusal
from orchestrator.master.settings import NANOSECONDS, MasterSettings
from orchestrator.master.slave import Status, Vector
from orchestrator.master.start import assemble
from orchestrator.master.watchdog import Watchdog


@dataclass
class Stage:
    """A unit, or the units of a block."""

    jobs: list[Job]
    block: Block | None = None


class Sweep:
    """The stages of each phase. `time` (ns) is where they stand."""

    def __init__(self, plan: Plan, coupling: Coupling, settings: MasterSettings, watchdog: Watchdog) -> None:
        self._board = plan.board.values
        self._watchdog = watchdog
        self.time = 0
        self.blocks = [Block(plan, units, list(coupling.lines), _motion_in(plan, units), settings) for units in coupling.blocks]
        everyone = range(len(plan.system.slaves))
        order = _in_blocks([unit for unit in everyone if coupling.repeated[unit]], coupling.blocks)
        rest = [unit for unit in everyone if not coupling.repeated[unit]]
        self.first = self._stages(plan.jobs(Phase.FIRST, order, coupling.repeated, coupling.held))
        self.again = self._stages(plan.jobs(Phase.AGAIN, order, coupling.repeated, coupling.held))
        self.after = self._stages(plan.jobs(Phase.AFTER, rest, coupling.repeated, coupling.held))

    def _stages(self, jobs: list[Job]) -> list[Stage]:
        block_of = {unit: block for block in self.blocks for unit in block.units}
        stages: list[Stage] = []
        for job in jobs:
            block = block_of.get(job.unit)
            if block is not None and stages and stages[-1].block is block:
                stages[-1].jobs.append(job)
            else:
                stages.append(Stage([job], block))
        return stages

    def note_start(self) -> None:
        """Before an interval."""
        for block in self.blocks:
            block.note_start(self.time)

    def over(self, stages: list[Stage], interval: int) -> Refusal | None:
        """Step them all, ns."""
        self._half = 0.5 * interval / NANOSECONDS
        for stage in stages:
            if stage.block is not None:
                refused = stage.block.solve(stage.jobs, self._gather, self._step, interval, stages is self.first)
            else:
                self._gather(stage.jobs[0])
                refused = self._step(stage.jobs[0], interval)
            if refused is not None:
                return refused
        return None

    @property
    def iterations(self) -> int:
        """Of the block that took most in this interval."""
        return max((block.iterations for block in self.blocks), default=0)

    @property
    def memory(self) -> Vector:
        """What the blocks carry from one interval to the next."""
        return np.concatenate([np.zeros(0), *(block.memory for block in self.blocks)])

    @memory.setter
    def memory(self, values: Vector) -> None:
        at = 0
        for block in self.blocks:
            size = len(block.memory)
            block.memory = values[at : at + size]
            at += size

    def _gather(self, job: Job) -> None:
        assemble(self._board, job, self._half)

    def _step(self, job: Job, interval: int) -> Refusal | None:
        self._watchdog.enter(job.slave.name)
        status = job.slave.step(self.time / NANOSECONDS, interval / NANOSECONDS)
        self._watchdog.leave()
        return refusal(job, self.time, interval) if status is Status.DISCARD else None


def jobs_of(stages: list[Stage]) -> list[Job]:
    return [job for stage in stages for job in stage.jobs]


def _in_blocks(units: list[int], blocks: list[list[int]]) -> list[int]:
    """The order of stepping: as listed, a block where its first unit stands."""
    block_of = {unit: block for block in blocks for unit in block}
    order: dict[int, None] = {}
    for unit in units:
        order.update(dict.fromkeys(block_of.get(unit, [unit])))
    return list(order)


def _motion_in(plan: Plan, units: list[int]) -> list[MotionPort]:
    return motion_ports(plan.system, lambda source, target: source in units and target in units)
