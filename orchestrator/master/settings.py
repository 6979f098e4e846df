"""Settings of the master, in SI, with the values that were measured to do (docs/decisions/0003-master.md)."""

from __future__ import annotations

from dataclasses import dataclass

NANOSECONDS = 1_000_000_000


def in_ns(seconds: float) -> int:
    """The master's clock counts integers; seconds exist at the FMI call only."""
    return round(seconds * NANOSECONDS)


@dataclass(frozen=True)
class MasterSettings:
    max_interval: float = 2e-3
    """s"""
    min_interval: float = 5e-5
    """s"""
    tolerance: float = 1e-5
    """m: what the estimate H·max(|Δv|, lever·|Δω|) may reach in one step."""
    passes: int = 2
    slopes: bool = True
    """Send a slope with a mean wherever both sides have one."""
    model_lever: float = 0.3
    """m: turns an angular velocity at a port with a reduced interface model, or under a quasi-Newton, into a velocity."""
    motion_lever: float = 4.0
    """m: the same for the other ports that give motion."""
    max_iterations: int = 20
    """Of a quasi-Newton in one interval."""
    interface_share: float = 0.02
    """A quasi-Newton has converged when its next correction would move the units by less than this share of the tolerance."""
    event_tolerance: float = 1e-4
    """s: the longest step in which an output that is located may change."""
    step_timeout: float = 60.0
    """s of wall time in one call of a unit, after which it is taken to hang; 0: wait for ever."""
    wall_limit: float = 0.0
    """s of wall time for the run, after which it ends with an error, its rows kept; 0: none. For campaigns, where no one watches."""
    unresolved_limit: float = 0.01
    """Share of accepted steps that may miss the tolerance at the smallest interval before the run is not trusted."""
    ledger_limit: float = 0.05
    """Share of the work exchanged over a connection that its two sides may disagree by before the run is not trusted."""
    record_interval: float = 0.0
    """s; rows are accepted steps, the first at or after each multiple; 0 records every accepted step."""
