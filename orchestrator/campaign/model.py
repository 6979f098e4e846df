"""The campaign file, key by key."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError, model_validator

from orchestrator.errors import ScenarioError
from orchestrator.scenario.faults import first_fault
from orchestrator.scenario.model import Scalar, Table

Finite = Annotated[float, Field(allow_inf_nan=False)]
DRAWN = ("latin", "sobol", "saltelli")


class Varied(Table):
    """One uncertain input. Of `uniform`, `normal`, `truncated` and `values` exactly one says how it varies."""

    addresses: list[str] = Field(default_factory=list)
    """`unit.parameter`s that all get the value, as in --set: the unit may be a glob, a vector's elements are `[2]` or all of them, `[*]`.
    Default: the table's own name."""
    uniform: Annotated[list[Finite], Field(min_length=2, max_length=2)] | None = None
    """[least, greatest]"""
    normal: Annotated[list[Finite], Field(min_length=2, max_length=2)] | None = None
    """[mean, standard deviation]"""
    truncated: Annotated[list[Finite], Field(min_length=4, max_length=4)] | None = None
    """[mean, standard deviation, least, greatest]: a normal distribution cut off on both sides."""
    values: Annotated[list[Scalar], Field(min_length=1)] | None = None
    """A grid's levels; in other designs equally likely."""
    levels: Annotated[int, Field(ge=1)] | None = None
    """In a grid: so many values of `uniform`, equally spaced, its ends among them."""
    unit: str = ""
    """Of measure; for axes and tables."""
    source: str = ""
    """Why these bounds."""

    @model_validator(mode="after")
    def _one_way(self) -> Varied:
        given = [name for name in ("uniform", "normal", "truncated", "values") if getattr(self, name) is not None]
        if len(given) > 1:
            raise ValueError(f"gives {' and '.join(given)}; keep one of uniform, normal, truncated, values")
        bounds = self.uniform or (self.truncated or [])[2:]
        if bounds and not bounds[0] < bounds[1]:
            raise ValueError(f"its least value {bounds[0]:g} is not below its greatest {bounds[1]:g}; exchange them")
        spread = (self.normal or self.truncated or [0.0, 1.0])[1]
        if not spread > 0.0:
            raise ValueError(f"its standard deviation {spread:g} is not above 0; give a positive one")
        return self

    @property
    def way(self) -> str:
        return next((name for name in ("uniform", "normal", "truncated", "values") if getattr(self, name) is not None), "")


class CampaignTable(Table):
    """A base scenario, what varies, how many landings, which outputs."""

    title: str = ""
    scenario: str
    """A scenario's name, or a file beside this one."""
    set: list[str] = Field(default_factory=list)
    """unit.parameter=value for all landings, as --set."""
    changes: dict[str, Any] = Field(default_factory=dict)
    """Merged over the scenario, e.g. {stop_time = 3.0, master = {tolerance = 1e-5}}."""
    design: Literal["latin", "sobol", "grid", "saltelli", "table"]
    """Latin hypercube, scrambled Sobol sequence, every combination of levels, Saltelli's scheme for Sobol indices, or a file's rows."""
    samples: Annotated[int, Field(ge=1)] | None = None
    """Landings of latin and sobol; of saltelli so many for each input and two over: samples x (inputs + 2) landings."""
    seed: Annotated[int, Field(ge=0)] = 0
    table: str | None = None
    """A CSV or Parquet file beside this one: a row a landing, columns by the names of [vary], else addresses."""
    vary: dict[str, Varied] = Field(default_factory=dict)
    outputs: Annotated[list[str], Field(min_length=1, default_factory=lambda: ["*"])]
    """Globs over the summary's names (`orchestrator.campaign.outputs`)."""

    @model_validator(mode="after")
    def _fits_its_design(self) -> CampaignTable:
        if (self.design == "table") != (self.table is not None):
            raise ValueError('design = "table" and table = "file.csv" go together; give both or neither')
        if (self.design in DRAWN) != (self.samples is not None):
            wanted = "needs" if self.design in DRAWN else "has no use for"
            raise ValueError(f'design = "{self.design}" {wanted} samples; {"add it" if self.samples is None else "remove it"}')
        if self.design != "table" and not self.vary:
            raise ValueError("nothing varies; add a [vary.\"unit.parameter\"] table")
        for name, varied in self.vary.items():
            if self.design == "grid" and varied.values is None and (varied.uniform is None or varied.levels is None):
                raise ValueError(f"vary.{name}: a grid needs values, or uniform and levels; add them")
            if self.design in DRAWN and not varied.way:
                raise ValueError(f"vary.{name}: is not told how it varies; add uniform, normal, truncated or values")
        return self


def read_campaign(path: Path) -> CampaignTable:
    """The checked file, or a ScenarioError of one line."""
    try:
        tree = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise ScenarioError(f"{path}: cannot be read ({error}); give a campaign's TOML file, or the folder of one begun") from None
    except tomllib.TOMLDecodeError as error:
        raise ScenarioError(f"{path}: not valid TOML: {error}; correct it there") from None
    try:
        return CampaignTable.model_validate(tree)
    except ValidationError as error:
        raise ScenarioError(f"{path.name}: {first_fault(error, _known_keys, 'the campaign')}") from None


def _known_keys(path: Sequence[int | str]) -> list[str]:
    return list(Varied.model_fields) if path[:1] == ("vary",) else list(CampaignTable.model_fields)
