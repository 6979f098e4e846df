"""The scenario file, key by key (SI throughout)."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from orchestrator.master.settings import MasterSettings
from orchestrator.terrain.table import BoulderTable, CraterTable, TerrainTable

Scalar = bool | int | float | str
Finite = Annotated[float, Field(allow_inf_nan=False)]
Numbers = Finite | Annotated[list[Finite], Field(min_length=1)]
Rows = list[list[Finite]]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
_DEFAULT = MasterSettings()


class Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class UnitTable(Table):
    fmu: str
    """Name looked up in the scenario's `fmus` folder, or a path to an .fmu relative to the scenario."""
    once: bool = False
    """Step it once per accepted step, whatever it can do: sampled guidance, telemetry."""
    isolate: bool = False
    """In a process of its own, which it may crash: safe, and dearer by a message a call."""
    parameters: dict[str, Any] = {}
    """Number, truth value, string, list (name[1], name[2] ...), or, in a unit expanded by [each], a table of these by instance."""


class ConnectionTable(Table):
    """Either two `ports`, joined both ways by member name, or one variable or vector `from` to another, `to`."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)
    ports: Annotated[list[str], Field(min_length=2, max_length=2)] | None = None
    source: str | None = Field(default=None, alias="from")
    target: str | None = Field(default=None, alias="to")
    slope: bool = True
    """Send slopes with means on this connection."""
    scheme: Literal["fixed-point", "quasi-newton", "explicit"] | None = None
    """How to couple it, instead of what the master would choose."""
    frame: Rows | None = None
    """Matrix that turns vectors of `from` (of the first port) into the frame of `to` (of the second)."""
    scale: Numbers | None = None
    """Factor, or one for each element; -1 changes the sign. After units of measure and frame."""
    offset: Numbers | None = None
    """Added last, in the unit of measure of `to`."""

    @model_validator(mode="after")
    def _one_of_two_forms(self) -> ConnectionTable:
        by_variable = self.source is not None and self.target is not None
        if (self.ports is None) == (not by_variable) or (self.ports is not None and (self.source or self.target)):
            raise ValueError("give either ports = [a, b] or both from and to")
        if self.ports is not None and (self.scale is not None or self.offset is not None):
            raise ValueError("scale and offset belong to from and to; ports, which are joined both ways, take a frame only")
        return self

    @field_validator("frame")
    @classmethod
    def _a_frame(cls, rows: list[list[float]] | None) -> list[list[float]] | None:
        if rows is not None and not _orthogonal(rows):
            raise ValueError("expects three rows of three, orthogonal and of length 1, e.g. [[0, 0, 1], [1, 0, 0], [0, 1, 0]]")
        return rows


class StartTable(Table):
    """Before the start, solve the parameter `vary` so that the smallest of the outputs `zero` is `value`."""

    vary: str
    zero: str | list[str]
    """Outputs by name or glob, e.g. "soil{leg}.gap"."""
    value: float = 0.0


class MasterTable(Table):
    """Step control; the meaning of each key stands in MasterSettings."""

    order: list[str] = []
    max_interval: Positive = _DEFAULT.max_interval
    min_interval: Positive = _DEFAULT.min_interval
    tolerance: Positive = _DEFAULT.tolerance
    passes: Annotated[int, Field(ge=1, le=20)] = _DEFAULT.passes
    slopes: bool = _DEFAULT.slopes
    model_lever: Positive = _DEFAULT.model_lever
    motion_lever: Positive = _DEFAULT.motion_lever
    max_iterations: Annotated[int, Field(ge=2, le=200)] = _DEFAULT.max_iterations
    interface_share: Positive = _DEFAULT.interface_share
    locate: list[str] = []
    """Globs over Boolean and Integer outputs, "soil*.contact": a step ends just after each of their changes."""
    event_tolerance: Annotated[float, Field(ge=1e-9, allow_inf_nan=False)] = _DEFAULT.event_tolerance
    step_timeout: Annotated[float, Field(ge=0.0)] = _DEFAULT.step_timeout
    wall_limit: Annotated[float, Field(ge=0.0)] = _DEFAULT.wall_limit
    unresolved_limit: Annotated[float, Field(ge=0.0, le=1.0)] = _DEFAULT.unresolved_limit
    ledger_limit: Annotated[float, Field(ge=0.0)] = _DEFAULT.ledger_limit

    @model_validator(mode="after")
    def _ordered(self) -> MasterTable:
        if self.min_interval > self.max_interval:
            raise ValueError(f"min_interval {self.min_interval:g} s exceeds max_interval {self.max_interval:g} s")
        return self


class UntilTable(Table):
    """End before the stop time: at the first recorded instant at which all of this has held for `hold`. At rest, for instance."""

    hold: Positive
    """s"""
    below: dict[str, Positive] = {}
    """Globs over outputs -> what their magnitude must be below, each element for itself."""
    above: dict[str, Positive] = {}
    """... and what it must not be below; a Boolean that is true counts 1."""
    beyond: dict[str, Positive] = {}
    """... and what ends the run at once where a single one is not below it: the vehicle lies on its side, for instance."""

    @model_validator(mode="after")
    def _says_something(self) -> UntilTable:
        if not self.below and not self.above and not self.beyond:
            raise ValueError("holds no condition; add below or above")
        return self


class RecordTable(Table):
    interval: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] = 0.0
    """s; 0 records every accepted step."""
    variables: list[str] = ["*"]
    """Globs over "unit.variable"; a vector is matched with or without its index."""


class ScenarioTable(Table):
    title: str = ""
    start_time: Annotated[float, Field(allow_inf_nan=False)] = 0.0
    stop_time: Annotated[float, Field(allow_inf_nan=False)]
    fmus: str | None = None
    each: dict[str, list[str]] = {}
    units: Annotated[dict[str, UnitTable], Field(min_length=1)]
    connections: list[ConnectionTable] = []
    terrain: TerrainTable | None = None
    start: StartTable | None = None
    until: UntilTable | None = None
    master: MasterTable = MasterTable()
    record: RecordTable = RecordTable()
    paper: dict[str, Any] = {}
    results: dict[str, Any] = {}


def _orthogonal(rows: list[list[float]]) -> bool:
    if [len(row) for row in rows] != [3, 3, 3]:
        return False
    products = {(i, j): sum(a * b for a, b in zip(rows[i], rows[j], strict=True)) for i in range(3) for j in range(3)}
    return all(abs(product - (i == j)) < 1e-6 for (i, j), product in products.items())


def known_keys(path: tuple[int | str, ...]) -> list[str]:
    """Keys allowed in the table at this path of a scenario."""
    tables: dict[str, type[BaseModel]] = {
        "terrain": TerrainTable, "master": MasterTable, "record": RecordTable, "start": StartTable, "until": UntilTable,
    }  # fmt: skip
    match path:
        case ():
            return [*ScenarioTable.model_fields, "extends", "disconnect"]
        case ("units", _):
            return list(UnitTable.model_fields)
        case ("terrain", "craters", _):
            return list(CraterTable.model_fields)
        case ("terrain", "boulders", _):
            return list(BoulderTable.model_fields)
        case ("connections", _):
            return ["ports", "from", "to", *(key for key in ConnectionTable.model_fields if key not in ("ports", "source", "target"))]
        case (str(name),) if name in tables:
            return list(tables[name].model_fields)
    return []
