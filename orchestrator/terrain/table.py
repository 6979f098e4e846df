"""`[terrain]`: what lies on the plane of the ground, key by key (SI). No physics: the units know what a crater is."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, model_validator

Length = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Place = Annotated[list[Finite], Field(min_length=2, max_length=2)]
FRESH_DEPTH, FRESH_RIM = 0.196, 0.036
"""Of the diameter: simple lunar craters, R. J. Pike in Impact and Explosion Cratering (1977), pp. 489-509."""


class Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class CraterTable(Part):
    center: Place
    """Y and Z in L, m."""
    diameter: Length
    """Crest to crest, m."""
    depth: Length | None = None
    """Floor below the crest, m; default: that of a fresh crater."""
    rim: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] | None = None
    """Crest above the ground around, m; default: that of a fresh crater."""

    @model_validator(mode="after")
    def _shape(self) -> CraterTable:
        _, _, diameter, depth, rim = self.numbers()
        if not (depth <= diameter and rim <= depth):
            raise ValueError(f"diameter {diameter:g} m, depth {depth:g} m, rim {rim:g} m; expects depth <= diameter and rim <= depth")
        return self

    def numbers(self) -> list[float]:
        depth = FRESH_DEPTH * self.diameter if self.depth is None else self.depth
        rim = FRESH_RIM * self.diameter if self.rim is None else self.rim
        return [*self.center, self.diameter, depth, rim]


class BoulderTable(Part):
    center: Place
    """Y and Z in L, m."""
    radius: Length
    """Of the ball, m."""
    height: Length | None = None
    """Of its top above the ground, m; default: half buried."""

    @model_validator(mode="after")
    def _shape(self) -> BoulderTable:
        if (self.height or 0.0) > 2.0 * self.radius:
            raise ValueError(f"height {self.height:g} m of a ball of radius {self.radius:g} m; expects at most {2.0 * self.radius:g} m")
        return self

    def numbers(self) -> list[float]:
        return [*self.center, self.radius, self.radius if self.height is None else self.height]


class TerrainTable(Part):
    file: str | None = None
    """GeoTIFF, or .npy: heights, first row northmost, first column westmost; relative to the scenario."""
    pixel: Length | Place | None = None
    """m between nodes of a .npy file, to the north and to the east where they differ."""
    unit: str | None = None
    """Of heights (and pixels), where the file does not say."""
    origin: Place | None = None
    """East and north of L's origin in the file's coordinates, m; a .npy file's start at its south-west node. Default: the middle."""
    heading: Annotated[float, Field(ge=-7.0, le=7.0)] = 0.0
    """rad, of L's +Z, clockwise from the map's north."""
    extent: Length = 30.0
    """m around the origin that is taken out of the file."""
    reach: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] = 1.0
    """m around each pad within which the map must be whole at the start."""
    craters: list[CraterTable] = []
    boulders: list[BoulderTable] = []

    @model_validator(mode="after")
    def _anything(self) -> TerrainTable:
        if self.file is None and (self.pixel or self.origin or self.unit):
            raise ValueError("has pixel, unit or origin but no file; name the height map's file")
        return self
