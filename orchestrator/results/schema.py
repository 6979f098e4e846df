"""The `[results]` table of a scenario: what a run is to be summed up as, and beside which published numbers."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from orchestrator.errors import ScenarioError, nearest


class LegChannels(BaseModel):
    """Where one leg's columns are: the names before `.primary.stroke` and before `.penetration`.

    Usually two unit names (`leg+Z`, `soil+Z`); for a vehicle in one FMU `lander.leg1`, `lander.soil1`.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    leg: str
    soil: str


class LowestRing(BaseModel):
    """The lowest thing of the body that must stay clear of the ground, a ring about its axis: the nozzle's exit. Lengths in m."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    height_above_pads: float
    """Above the bases of the undeformed footpads."""
    radius: Annotated[float, Field(ge=0.0)]
    source: str = ""


class ReportEntry(BaseModel):
    """One number to print: a column's final (or least, or greatest) value beside what a source expects, both in `unit`."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    variable: str
    at: Literal["final", "min", "max"] = "final"
    expected: float | None = None
    unit: str = ""
    source: str = ""


class ResultsTable(BaseModel):
    """`[results]`. Everything has a default: a scenario without the table gets the generic summary."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    kind: Literal["touchdown", "generic"] | None = None
    body: str = "body"
    legs: dict[str, LegChannels] = Field(default_factory=dict)
    references: str | None = None
    compare: str | None = None
    measured: str | None = None
    work: list[str] | None = None
    lowest: LowestRing | None = None
    report: dict[str, ReportEntry] = Field(default_factory=dict)
    clock_offsets: dict[str, float] = Field(default_factory=dict)
    """Series of measured data -> s that a diagnosis found its clock ahead; nothing simulated moves by it."""

    @property
    def resolved_kind(self) -> Literal["touchdown", "generic"]:
        """`touchdown` as soon as legs are named, unless the scenario says otherwise."""
        return self.kind or ("touchdown" if self.legs else "generic")


def read(table: Mapping[str, Any], where: str = "results") -> ResultsTable:
    """The checked table, or a ScenarioError of one line. For whoever loads scenarios: before the run, not after it."""
    try:
        return ResultsTable.model_validate(table)
    except ValidationError as error:
        faults = sorted(error.errors(), key=lambda fault: fault["type"] != "extra_forbidden")
        raise ScenarioError(_one_line(faults[0]["loc"], faults[0]["type"], faults[0]["msg"], where)) from None


def _one_line(place: tuple[int | str, ...], kind: str, message: str, where: str) -> str:
    name = ".".join([where, *(str(part) for part in place)])
    if kind == "extra_forbidden":
        tables: dict[str, type[BaseModel]] = {"legs": LegChannels, "report": ReportEntry, "lowest": LowestRing}
        owner = tables.get(str(place[0]), ResultsTable) if len(place) > 1 else ResultsTable
        return f"{name}: unknown key; {nearest(str(place[-1]), owner.model_fields)}"
    if kind == "missing":
        return f"{name}: is missing; add it"
    return f"{name}: {message[0].lower()}{message[1:]}"
