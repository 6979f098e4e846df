"""Master and units at one accepted step, taken out and put back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from orchestrator.checkpoint.memory import Memory, adopt, recall
from orchestrator.master.master import Master
from orchestrator.master.result import Attempt
from orchestrator.master.slave import Slave


@runtime_checkable
class Serialises(Protocol):
    """A unit whose kept state can leave the process."""

    def serialised_state(self) -> bytes:
        """The kept state."""

    def adopt_state(self, data: bytes) -> None:
        """Keep this state instead; `restore` then goes there."""


@dataclass(frozen=True)
class UnitState:
    state: bytes
    steps: int
    seconds: float
    messages: list[str]


@dataclass(frozen=True)
class Snapshot:
    master: Memory
    units: dict[str, UnitState]


def take(master: Master) -> Snapshot:
    """Between two steps; changes nothing."""
    return Snapshot(recall(master), {slave.name: _unit_state(slave) for slave in master.system.slaves})


def put(master: Master, snapshot: Snapshot) -> None:
    """Into a master that is prepared and has not run."""
    adopt(master, snapshot.master)
    master.log = [Attempt(*row) for row in master.log]
    for slave in master.system.slaves:
        kept = snapshot.units[slave.name]
        _serialising(slave).adopt_state(kept.state)
        slave.restore()
        slave.steps, slave.seconds = kept.steps, kept.seconds
        slave.messages[:] = kept.messages


def _unit_state(slave: Slave) -> UnitState:
    slave.save()
    return UnitState(_serialising(slave).serialised_state(), slave.steps, slave.seconds, list(slave.messages))


def _serialising(slave: Slave) -> Serialises:
    assert isinstance(slave, Serialises), f"{slave.name} passed the check before the run"
    return slave
