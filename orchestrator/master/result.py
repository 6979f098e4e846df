"""What a run leaves behind, in memory: everything the results need and nothing that was not measured."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import nan
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


class Attempt(NamedTuple):
    """One row of the solver log: one attempt to step over one interval."""

    time: float
    """Start of the interval, s."""
    interval: float
    """Its length, s."""
    passes: int
    """Passes made over it."""
    estimate: float
    """The error estimate, m; NaN where the system offers none."""
    accepted: bool
    limit: str
    """What kept the next interval from being longer: a port ("soil+Z.pad"), "max interval", "stop time", or "discard by UNIT"; where an
    event ended this one, "scheduled UNIT" or "event UNIT.OUTPUT" (not accepted: it happened in it, and a shorter one follows)."""


@dataclass(frozen=True)
class LedgerRow:
    """Work exchanged over one connection since the start, J.

    Each side reports the work done ON ITSELF, so a perfect coupling sums to zero.
    """

    first: str
    """`unit.port`, e.g. "leg+Z.pad"."""
    second: str
    work_first: float
    work_second: float
    throughput: float
    """Sum over the accepted steps of the larger |change of work| of the two sides, J: the scale the leak is judged against."""

    @property
    def leak(self) -> float:
        """Energy the coupling made (+) or lost (-), J."""
        return self.work_first + self.work_second


@dataclass(frozen=True)
class ConnectionRecord:
    """How a connection was coupled."""

    first: str
    """`unit.port`, or the unit's name where variables are connected one by one."""
    second: str
    scheme: str
    """See orchestrator.master.system.Scheme."""
    detail: str = ""
    """E.g. iterations per interval, or why it is not what was asked for."""


@dataclass(frozen=True)
class TrialRecord:
    """What a unit can do: "true" where a claim was tried and held, "claimed", "claimed, not true" or "not claimed"."""

    rollback: str
    serialisation: str
    variable_step: bool
    """As claimed."""
    slopes: int
    """Connected inputs that have a slope input beside them."""
    interpolates: bool
    """Takes slopes by the standard call."""
    step_size_difference: float = nan
    """Largest difference between one step and two of half its length, by the larger of value and nominal; NaN: not tried."""
    step_size_variable: str = ""
    """The output it was found at."""

    def but(self, **changes: Any) -> TrialRecord:
        return replace(self, **changes)


@dataclass(frozen=True)
class UnitRecord:
    """What a unit is, what it can do, how it was stepped and what that cost."""

    name: str
    fmu: str
    """File name of the FMU (or a description, for a unit that is not one)."""
    sha256: str
    """Of the FMU file; empty for a unit that is not one."""
    model_name: str
    guid: str
    fmi_version: str
    generation_tool: str
    capabilities: dict[str, bool]
    """As the modelDescription claims them, e.g. canGetAndSetFMUstate."""
    rollback: bool
    """Claimed AND found bit-exact at the start."""
    stepped: str
    """E.g. "2 passes, rolled back between" or "once per accepted step"."""
    steps: int
    """doStep calls, rejected and repeated ones included."""
    seconds: float
    """Wall time inside the unit (doStep, get, set, states), s."""
    parameters: dict[str, float | int | bool | str]
    """Parameters the run set, variable name -> value."""
    trial: TrialRecord | None = None
    """What it was found able to do before the first step."""


@dataclass
class RunResult:
    """A finished (or interrupted, or failed) run."""

    name: str
    """Of the scenario file, without its ending."""
    title: str
    scenario: dict[str, Any]
    """The scenario as run: overlays merged, `--set` applied, `each` expanded."""
    scenario_path: Path | None
    scenario_sha256: str | None
    """Of the file when the run was drawn up; it may have been edited since."""
    start_time: float
    stop_time: float
    """As asked, s; the run reached times[-1]."""
    times: Vector
    """Times of the recorded rows, s."""
    columns: dict[str, Vector]
    """"unit.variable", e.g. "soil+Z.pad.force[1]" -> its value at each of `times`. Booleans are 0 and 1."""
    units: dict[str, str]
    """"unit.variable" -> unit of measure as the FMU declares it, "" if none."""
    descriptions: dict[str, str]
    """"unit.variable" -> description from the FMU."""
    log: list[Attempt]
    ledger: list[LedgerRow]
    unit_records: list[UnitRecord]
    accepted: int
    rejected: int
    unresolved: int
    """Accepted steps whose estimate exceeded the tolerance because the interval could not shrink further."""
    wall_time: float
    """Of the stepping, s (loading and initialising not included)."""
    wall_time_units: float
    """Part of it inside the units, s."""
    complete: bool
    """Reached the stop time."""
    trusted: bool
    """Complete, and the tolerance held."""
    interrupted: bool = False
    message: str = ""
    """One line: why it is not complete or not trusted; empty when all is well."""
    warnings: list[str] = field(default_factory=list)
    """One line each, e.g. a unit whose claimed rollback is not true."""
    unit_messages: list[str] = field(default_factory=list)
    """What the units logged, "unit: message"."""
    connections: list[ConnectionRecord] = field(default_factory=list)
    """How each was coupled."""
    paper: dict[str, Any] = field(default_factory=dict)
    """The scenario's [paper] table, unchanged."""
    results: dict[str, Any] = field(default_factory=dict)
    """The scenario's [results] table, unchanged."""
    parameters: dict[str, float] = field(default_factory=dict)
    """"unit.parameter" -> number it ran with, those left at the unit's own start value among them; of a text, 1 where there is any."""
    variant: str = ""
    """Which system of an .ssp, where it was not the default one."""
