"""The `[results]` table of a scenario: what a run is to be summed up as, and beside which published numbers."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class LegChannels(BaseModel):
    """Where one leg's columns are: the names before `.primary.stroke` and before `.penetration`.

    Usually two unit names (`leg+Z`, `soil+Z`); for a vehicle in one FMU `lander.leg1`, `lander.soil1`.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    leg: str
    soil: str


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
    report: dict[str, ReportEntry] = Field(default_factory=dict)

    @property
    def resolved_kind(self) -> Literal["touchdown", "generic"]:
        """`touchdown` as soon as legs are named, unless the scenario says otherwise."""
        return self.kind or ("touchdown" if self.legs else "generic")
