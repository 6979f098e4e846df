"""doghouse.toml, key by key: what varies, what is certified, how it is searched."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from orchestrator.errors import ScenarioError, nearest

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Angle = Annotated[float, Field(ge=-360.0, le=360.0)]
Several = Annotated[list[Angle], Field(min_length=1)]


class Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Certified(Table):
    """The design envelope: 0 to a greatest horizontal speed, under a straight roof."""

    horizontal_limit_m_s: Positive
    vertical_at_zero_horizontal_m_s: Positive
    vertical_at_horizontal_limit_m_s: Positive

    def roof(self, horizontal: float) -> float:
        """Greatest certified vertical speed, m/s, at a horizontal speed within the limit."""
        high, low = self.vertical_at_zero_horizontal_m_s, self.vertical_at_horizontal_limit_m_s
        return high + (low - high) * horizontal / self.horizontal_limit_m_s

    def speed_along(self, ray: float) -> float:
        """Greatest certified speed, m/s, on a ray at `ray` rad from the vertical: v cos = roof(v sin), or the wall where that is nearer."""
        slope = (self.vertical_at_horizontal_limit_m_s - self.vertical_at_zero_horizontal_m_s) / self.horizontal_limit_m_s
        across = math.cos(ray) - slope * math.sin(ray)
        to_roof = self.vertical_at_zero_horizontal_m_s / across if across > 0.0 else math.inf
        return min(to_roof, self.horizontal_limit_m_s / math.sin(ray) if ray > 0.0 else math.inf)

    def holds(self, horizontal: float, vertical: float) -> bool:
        """Whether a pair of speeds is inside or on the envelope."""
        return horizontal <= self.horizontal_limit_m_s and vertical <= self.roof(horizontal)


class Varies(Table):
    """Every combination is flown; the upright vehicle comes besides the tilted ones."""

    heading_deg: Several
    motion_deg: Several
    tilt_deg: list[Annotated[float, Field(gt=0.0, le=45.0)]]
    tilt_toward_deg: list[Angle]
    friction: Annotated[list[Positive], Field(min_length=1)]


class Names(Table):
    """The scenario's parameters for the inputs, unit.parameter; `[*]`: all elements, three of the velocity in B."""

    velocity: str
    yaw: str
    pitch: str
    roll: str
    friction: str


class Flown(Table):
    """A scenario that flies the landings."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)
    scenario: str
    names: Names = Field(alias="set")


class Search(Flown):
    rays_deg: Annotated[list[Annotated[float, Field(ge=0.0, lt=90.0)]], Field(min_length=1)]
    rungs: Annotated[list[Positive], Field(min_length=1)]
    bracket_m_s: Positive

    @model_validator(mode="after")
    def _rising(self) -> Search:
        if sorted(set(self.rungs)) != self.rungs or sorted(set(self.rays_deg)) != self.rays_deg:
            raise ValueError("rungs and rays_deg must rise")
        return self


class Audit(Table):
    """Landings at random inside the certified envelope, with inputs between those of the grid."""

    landings: Annotated[int, Field(ge=0)] = 0
    seed: int = 0


class Doghouse(Table):
    title: str = "Doghouse"
    certified: Certified
    varies: Varies
    search: Search
    check: Flown
    audit: Audit = Audit()


def read(path: Path) -> Doghouse:
    """The checked file, or a ScenarioError of one line."""
    try:
        tree = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise ScenarioError(f"{path.name}: {error}; correct the TOML") from None
    try:
        return Doghouse.model_validate(tree)
    except ValidationError as error:
        faults = sorted(error.errors(), key=lambda fault: fault["type"] != "extra_forbidden")
        raise ScenarioError(_one_line(path.name, faults[0])) from None


def _one_line(where: str, fault: Any) -> str:
    place = [str(part) for part in fault["loc"]]
    name = f"{where}: {'.'.join(place)}"
    if fault["type"] == "extra_forbidden":
        tables: dict[str, type[Table]] = {"certified": Certified, "varies": Varies, "search": Search, "check": Flown, "audit": Audit}
        owner = Names if place[1:2] == ["set"] and len(place) > 2 else tables.get(place[0], Doghouse) if len(place) > 1 else Doghouse
        known = ["set" if key == "names" else key for key in owner.model_fields]
        return f"{name}: unknown key; {nearest(place[-1], known)}"
    if fault["type"] == "missing":
        return f"{name}: is missing; add it"
    return f"{name}: is {fault['input']!r}: {fault['msg'][0].lower()}{fault['msg'][1:]}"
