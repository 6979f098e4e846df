"""Why a finished run is not to be trusted. Never garbage with exit code 0."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

from orchestrator.master.judge import SAFETY
from orchestrator.master.master import Master
from orchestrator.master.result import Attempt, LedgerRow

_NEGLIGIBLE = 0.01
"""A connection that carried less than this share of the busiest one's work is judged against that share."""
_SHARE_OF_MOTION = 1e-3
"""A leak below this share of the kinetic energy at the start harms nothing."""
_MOTION = ".energy.kinetic"


def distrust(master: Master, where: str) -> str:
    """One line, or nothing when the tolerance held and the ledger closes."""
    accepted = [row for row in master.log if row.accepted]
    if master.unresolved > master.settings.unresolved_limit * len(accepted):
        return f"{where}: {_missed_tolerance(master, accepted)}"
    leaking = worst_leak(master.ledger.rows(), master.settings.ledger_limit, _SHARE_OF_MOTION * _motion(master))
    if leaking is not None:
        return (
            f"{where}: {leaking.first} <-> {leaking.second}: the coupling made {leaking.leak:.4g} J of {leaking.throughput:.4g} J"
            f" exchanged, at most {master.settings.ledger_limit:.1%} may; lower master.tolerance or master.max_interval"
            f" ({master.settings.max_interval:g} s)"
        )
    return ""


def _motion(master: Master) -> float:
    """Kinetic energy of all units at the start, J, as far as they report and the run recorded it."""
    columns = master.recorder.columns()
    return float(sum(abs(column[0]) for name, column in columns.items() if name.endswith(_MOTION) and len(column)))


def worst_leak(rows: Sequence[LedgerRow], limit: float, harmless: float = 0.0) -> LedgerRow | None:
    """The connection whose energy ledger closes worst, if it fails the limit by more than `harmless` (J)."""
    floor = _NEGLIGIBLE * max((row.throughput for row in rows), default=0.0)
    failing = [row for row in rows if abs(row.leak) > max(harmless, limit * max(row.throughput, floor))]
    return max(failing, key=lambda row: abs(row.leak)) if failing else None


def _missed_tolerance(master: Master, accepted: Sequence[Attempt]) -> str:
    settings = master.settings
    worst = max((row for row in accepted if row.estimate == row.estimate), key=lambda row: row.estimate)
    would_do = worst.interval * SAFETY * sqrt(settings.tolerance / worst.estimate)
    return (
        f"{master.unresolved} of {len(accepted)} steps missed the tolerance {settings.tolerance:g} m (worst {worst.estimate:.3g} m at"
        f" {worst.limit}, t = {worst.time:.6g} s, interval {worst.interval:.3g} s), at most {settings.unresolved_limit:.2%} may;"
        f" an interval of about {would_do:.2g} s would do there: set master.min_interval and max_interval to match, or raise the tolerance"
    )
