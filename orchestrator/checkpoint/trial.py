"""Which units can be kept in a checkpoint: claimed in the modelDescription, then tried at the start of the run."""

from __future__ import annotations

from collections.abc import Sequence

from orchestrator.checkpoint.snapshot import Serialises
from orchestrator.errors import UnitError
from orchestrator.master.master import Master
from orchestrator.master.settings import NANOSECONDS
from orchestrator.master.slave import Kind, Slave, Status, Vector
from orchestrator.master.system import System


def require_claims(slaves: Sequence[Slave]) -> None:
    """A UnitError that names the first unit that does not even claim it."""
    for slave in slaves:
        if not (slave.interface.claims("canSerializeFMUstate") and isinstance(slave, Serialises)):
            model = slave.interface.path.name if slave.interface.path else slave.interface.model_name
            raise UnitError(
                f"{slave.name} ({model}): cannot serialise its state (canSerializeFMUstate is false), checkpoints need it of every unit;"
                " leave --checkpoint-every out or export the unit with it"
            )


def require_numbers(system: System) -> None:
    """A UnitError that names the first connection whose values a checkpoint could not carry to another process."""
    for link in system.links:
        slave = system.slaves[link.source_unit]
        if slave.interface.variables[link.source].kind is Kind.STRING:
            target = f"{system.slaves[link.target_unit].name}.{link.target}"
            raise UnitError(f"{slave.name}.{link.source} -> {target}: a checkpoint cannot keep text; leave --checkpoint-every out")


def require_truth(master: Master) -> None:
    """A UnitError that names the first unit whose step from its bytes differs from the step from its state. Before the first step."""
    board, interval = master.plan.board, master.limits.maximum / NANOSECONDS
    ends = [*board.offset[1:], len(board.names)]
    for unit, slave in enumerate(master.system.slaves):
        y = board.now[board.offset[unit] : ends[unit]]
        if not (master.rollback[unit] and _same_from_bytes(slave, y, master.time / NANOSECONDS, interval)):
            raise UnitError(
                f"{slave.name}: claims to serialise its state but does not go on from it with the same bits, so a checkpoint would not"
                " repeat the run; leave --checkpoint-every out or mend the unit"
            )


def _same_from_bytes(slave: Slave, y: Vector, time: float, interval: float) -> bool:
    """Leaves the unit, its outputs and its counts as they were."""
    assert isinstance(slave, Serialises)
    at_start, steps, seconds = y.copy(), slave.steps, slave.seconds

    def outcome() -> tuple[Status, bytes]:
        status = slave.step(time, interval)
        bits = y.tobytes()
        slave.restore()
        y[:] = at_start
        return status, bits

    slave.save()
    data = slave.serialised_state()
    direct = outcome()
    slave.adopt_state(data)
    slave.restore()
    same = outcome() == direct
    slave.steps, slave.seconds = steps, seconds
    return same
