"""A campaign in its folder: begun, gone on with, finished.

    campaign.toml      as given                    scenario.toml    the base scenario, said out in full
    campaign.json      what the rows belong to     inputs.parquet   a row a landing, drawn before the first
    parts/             landings as they come       landings.parquet all of them in their order, when the last is flown
    cost.parquet       seconds and worker of each: the only thing that differs when the same campaign is flown again
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from orchestrator.blueprint import Blueprint
from orchestrator.campaign.crew import Crew
from orchestrator.campaign.data_set import COST, INDEX, VERDICT, DataSet, as_table, type_of
from orchestrator.campaign.design import drawn
from orchestrator.campaign.inputs import overrides, resolved
from orchestrator.campaign.landing import Base, Landing, blueprint
from orchestrator.campaign.model import CampaignTable, read_campaign
from orchestrator.campaign.outputs import NOT_FLOWN, chosen
from orchestrator.checkpoint.origin import made_with, sources
from orchestrator.errors import RunError, ScenarioError, UserError
from orchestrator.scenario.locate import find_scenario

Heard = Callable[[int, int, int], None]
"""Called with (flown, of, failed)."""
_SOURCES = ("campaign", "results", "scenario")


@dataclass(frozen=True)
class Cost:
    """Of this call."""

    landings: int
    seconds: float
    lost: float
    """Share of the workers' time that was spent outside landings, between the first that was asked for and the last that came."""


@dataclass(frozen=True)
class Campaign:
    """What to fly, whoever flies it."""

    where: str
    table: CampaignTable
    base: Base
    addresses: Mapping[str, Sequence[str]]
    inputs: pa.Table

    @classmethod
    def read(cls, path: Path) -> Campaign:
        """From a campaign's file, everything checked and drawn; or from the folder of one that was begun."""
        if path.is_dir():
            return cls._begun(path)
        table = read_campaign(path)
        beside = path.parent / table.scenario
        scenario = beside if beside.is_file() else find_scenario(table.scenario)
        base = Base.read(scenario, table.set, table.changes)
        return cls._of(path.name, table, base, as_table(drawn(table, path.parent)))

    @classmethod
    def _begun(cls, folder: Path) -> Campaign:
        try:
            about = json.loads((folder / "campaign.json").read_text(encoding="utf-8"))
            base = Base(about["where"], (folder / "scenario.toml").read_text(encoding="utf-8"))
            return cls._of(about["campaign"], CampaignTable.model_validate(about["table"]), base, pq.read_table(folder / "inputs.parquet"))
        except (OSError, ValueError, LookupError) as error:
            raise ScenarioError(f"{folder}: is not the folder of a campaign ({error}); give one, or a campaign's TOML file") from None

    @classmethod
    def _of(cls, where: str, table: CampaignTable, base: Base, inputs: pa.Table) -> Campaign:
        units = blueprint(base, ())
        names = [name for name in inputs.column_names if name != INDEX]
        for name in names:
            if name in (*VERDICT, *COST):
                raise ScenarioError(f'{where}: vary."{name}": is the name of a column of the results; give it another')
        asked = {name: (table.vary[name].addresses if name in table.vary else []) or [name] for name in names}
        return cls(where, table, base, {n: [a for one in its for a in resolved(one, units, where)] for n, its in asked.items()}, inputs)

    def overrides(self, index: int) -> list[str]:
        """Of one landing."""
        return overrides(self.addresses, self.inputs.slice(index, 1).to_pylist()[0])

    def fly(self, folder: Path, crew: Crew, heard: Heard | None = None) -> tuple[pa.Table, Cost]:
        """All landings that the folder does not have yet, each kept as it ends."""
        data = self._opened(folder, crew)
        kept, count, failed = data.begin(), self.inputs.num_rows, 0
        missing = [index for index in range(count) if index not in kept]
        began, busy = perf_counter(), 0.0
        if heard is not None:
            heard(len(kept), count, 0)
        for number, (index, landing) in enumerate(crew.fly(self.base, ((i, self.overrides(i)) for i in missing))):
            data.add([(index, landing)])
            failed += landing.outcome == NOT_FLOWN
            busy += landing.seconds
            if heard is not None:
                heard(len(kept) + number + 1, count, failed)
        seconds = perf_counter() - began
        return data.finish(), Cost(len(missing), seconds, 1.0 - busy / (seconds * crew.size) if missing else 0.0)

    def _opened(self, folder: Path, crew: Crew) -> DataSet:
        """The folder's data set; a new folder gets the base landing, which tells what outputs there are."""
        known = folder / "campaign.json"
        about = self._about()
        if known.is_file():
            then = json.loads(known.read_text(encoding="utf-8"))
            _require_same(folder, then, about)
            if not self.inputs.equals(pq.read_table(folder / "inputs.parquet")):
                raise UserError(f"{folder}: was begun with other inputs; give another --out, or go back to those it was begun with")
            return DataSet(folder, self.inputs, then["outputs"])
        if folder.is_dir() and any(folder.iterdir()):
            raise UserError(f"{folder}: holds something that is no campaign; give another --out")
        base = crew.fly_all(self.base, [()])[0]
        if base.outcome == NOT_FLOWN:
            raise RunError(f"{self.where}: the base scenario cannot be flown: {base.error}")
        names = chosen(list(base.outputs), self.table.outputs, self.where)
        twice = [name for name in names if name in self.inputs.column_names]
        if twice:
            raise ScenarioError(f'{self.where}: vary."{twice[0]}": is the name of an output too; give it another')
        about |= {"outputs": {name: type_of(base.outputs[name]) for name in names}, "base": _row(base)}
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scenario.toml").write_text(self.base.text, encoding="utf-8")
        pq.write_table(self.inputs, folder / "inputs.parquet")
        unfinished = folder / "campaign.json.unfinished"
        unfinished.write_text(json.dumps(about, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
        unfinished.replace(known)                       # last: with it the folder is a campaign's
        return DataSet(folder, self.inputs, about["outputs"])

    def _about(self) -> dict[str, Any]:
        units: Blueprint = blueprint(self.base, ())
        return {
            "campaign": self.where,
            "where": self.base.where,
            "table": self.table.model_dump(exclude_none=True),
            "scenario": self.base.text,
            "fmus": {name: interface.sha256 for name, interface in units.interfaces.items()},
            "made_with": made_with() | {"the results' sources": sources(_SOURCES)},
        }


def _require_same(folder: Path, then: Mapping[str, Any], now: Mapping[str, Any]) -> None:
    """A data set is of one campaign, one scenario, one set of FMUs and one version of this project."""
    said = {"table": "campaign", "scenario": "scenario", "fmus": "FMU", "made_with": "version"}
    for key, what in said.items():
        if then[key] == now[key]:
            continue
        other = "" if key == "scenario" else next((f" ({k})" for k in {**then[key], **now[key]} if then[key].get(k) != now[key].get(k)), "")
        raise UserError(f"{folder}: was begun with another {what}{other}; give another --out, or go back to what it was begun with")


def _row(landing: Landing) -> dict[str, Any]:
    return {"outcome": landing.outcome, "trusted": landing.trusted, "error": landing.error, **landing.outputs}
