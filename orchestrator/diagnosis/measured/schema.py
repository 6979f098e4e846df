"""landing.toml, key by key."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]


class Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class SeriesTable(Table):
    file: str
    """CSV in the same folder: a column time_s, and one for each channel."""
    unit: str | dict[str, str]
    """Of all columns, or a table by column."""
    sigma: Positive | dict[str, Positive]
    """Standard deviation of the noise in `unit`, of all columns or by column."""
    colour: Annotated[float, Field(gt=-1.0, lt=1.0)] | Literal["estimate"] = "estimate"
    """AR(1) coefficient from one sample to the next."""
    columns: list[str] | None = None
    """The columns to use; without it all of them."""


class ValueTable(Table):
    value: Finite | None = None
    sigma: Positive | None = None
    low: Finite | None = None
    high: Finite | None = None
    unit: str

    @model_validator(mode="after")
    def _one_of_two_forms(self) -> ValueTable:
        bounds = self.low is not None or self.high is not None
        if bounds == (self.value is not None) or (self.value is None) != (self.sigma is None):
            raise ValueError("give either value and sigma, or low and high")
        if self.low is not None and self.high is not None and not self.low < self.high:
            raise ValueError(f"low {self.low:g} is not below high {self.high:g}; exchange or widen them")
        return self


class PriorTable(Table):
    mean: Finite | list[Finite]
    sigma: Positive | list[Positive] | None = None
    sigma_log: Positive | list[Positive] | None = None
    """Standard deviation of the logarithm, for a parameter that is a positive scale."""
    unit: str | None = None

    @model_validator(mode="after")
    def _one_spread(self) -> PriorTable:
        if (self.sigma is None) == (self.sigma_log is None):
            raise ValueError("give either sigma or sigma_log")
        means = self.mean if isinstance(self.mean, list) else [self.mean]
        spread = self.sigma if self.sigma is not None else self.sigma_log
        if isinstance(spread, list) and len(spread) != len(means):
            raise ValueError(f"gives {len(spread)} sigmas for {len(means)} means; give one, or one for each")
        if not means:
            raise ValueError("gives no mean; give at least one number")
        if self.sigma_log is not None and not all(mean > 0.0 for mean in means):
            raise ValueError(f"sigma_log needs a mean above zero, has {min(means, default=math.nan):g}; give sigma instead")
        return self


class LandingTable(Table):
    title: str = ""
    source: str = ""
    series: dict[str, SeriesTable] = {}
    values: dict[str, ValueTable] = {}
    prior: dict[str, PriorTable] = {}


def known_keys(path: tuple[int | str, ...]) -> list[str]:
    """Keys allowed in the table at this path of landing.toml."""
    match path:
        case ():
            return list(LandingTable.model_fields)
        case ("series", _):
            return list(SeriesTable.model_fields)
        case ("values", _):
            return list(ValueTable.model_fields)
        case ("prior", _):
            return list(PriorTable.model_fields)
    return []
