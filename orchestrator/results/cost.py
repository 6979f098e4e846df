"""How the run was stepped, what that cost, and whether the connections kept the energy they carried."""

from dataclasses import asdict
from typing import Any

from orchestrator.master.result import LedgerRow, RunResult, TrialRecord
from orchestrator.results.channels import finite

LEAK_OF_THROUGHPUT = 0.01
LEAK_OF_INITIAL = 0.001


def master(result: RunResult) -> dict[str, Any]:
    """Steps, seconds and, for each unit, how it was stepped."""
    outside = 1.0 - result.wall_time_units / result.wall_time if result.wall_time > 0.0 else None
    return {
        "steps": result.accepted,
        "rejected": result.rejected,
        "unresolved": result.unresolved,
        "unit_steps": sum(record.steps for record in result.unit_records),
        "wall_s": result.wall_time,
        "simulated_s": float(result.times[-1] - result.start_time) if len(result.times) else 0.0,
        "asked_s": result.stop_time - result.start_time,
        "share_outside_units": outside,
        "units": {record.name: record.stepped for record in result.unit_records},
        "unit_steps_each": {record.name: record.steps for record in result.unit_records},
        "unit_seconds_each": {record.name: record.seconds for record in result.unit_records},
        "rollback": {record.name: record.rollback for record in result.unit_records},
        "trials": {record.name: _trial(record.trial) for record in result.unit_records if record.trial is not None},
        "connections": [asdict(record) for record in result.connections],
    }


def _trial(record: TrialRecord) -> dict[str, Any]:
    return asdict(record) | {"step_size_difference": finite(record.step_size_difference)}


def ledger(rows: list[LedgerRow], initial: float | None) -> list[dict[str, Any]]:
    """Each connection's works in J and `passed`: |leak| ≤ 1 % of what it carried, or ≤ 0.1 % of the initial energy.

    The second bound is for connections that carried next to nothing. `passed` is None where a side reports no work.
    """
    return [_row(row, LEAK_OF_INITIAL * (initial or 0.0)) for row in rows]


def _row(row: LedgerRow, negligible: float) -> dict[str, Any]:
    leak = finite(row.leak)
    bound = max(LEAK_OF_THROUGHPUT * row.throughput, negligible)
    return {
        "first": row.first,
        "second": row.second,
        "work_first_J": finite(row.work_first),
        "work_second_J": finite(row.work_second),
        "throughput_J": finite(row.throughput),
        "leak_J": leak,
        "passed": None if leak is None else abs(leak) <= bound,
    }
