"""One landing on a worker: the scenario with some values changed, flown by units the worker keeps, its summary as a row."""

from __future__ import annotations

import os
import threading
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

from orchestrator.blueprint import Blueprint, draw_up, read_scenario
from orchestrator.campaign.outputs import NOT_FLOWN, Output, flat, outcome
from orchestrator.errors import OrchestratorError, RunError
from orchestrator.loaded_units import LoadedUnits
from orchestrator.master.result import RunResult
from orchestrator.results import references
from orchestrator.results.channels import Channels
from orchestrator.results.energy import account_of
from orchestrator.results.provenance import scenario_text
from orchestrator.results.schema import read as read_results_table
from orchestrator.scenario.expand import Scenario, expand
from orchestrator.scenario.locate import find_fmu, fmu_folder
from orchestrator.scenario.read import Tree, check_table
from orchestrator.simulation import fault


@dataclass(frozen=True)
class Base:
    """A scenario said out in full, for workers that have no scenario files: only the FMUs must be where it says."""

    where: str
    """The scenario's name in messages."""
    text: str
    """TOML that `orchestrator run` takes."""

    @classmethod
    def read(cls, path: Path, overrides: Sequence[str] = (), changes: Tree | None = None) -> Base:
        """Checked as a run would check it. `changes` are merged over the file, `overrides` are those of --set."""
        scenario = read_scenario(path, overrides, changes)
        draw_up(scenario, path)
        tree = scenario.as_run()
        folder = fmu_folder(scenario.table.fmus, path)
        for unit in scenario.units:
            tree["units"][unit.name]["fmu"] = str(find_fmu(unit.fmu, folder, unit.name).resolve())
        named = tree["results"].get("references")
        beside = references.find(named, [*path.resolve().parents, Path("scenarios").resolve()])
        if beside is not None:
            tree["results"] = {**tree["results"], "references": str(beside)}
        return cls(path.name, scenario_text(tree))

    def scenario(self, overrides: Sequence[str] = ()) -> Scenario:
        return expand(check_table(_tree(self), self.where), self.where, overrides)


@dataclass(frozen=True)
class Landing:
    """What came of one. Everything but the last three is the same whoever flies it, to the bit."""

    overrides: tuple[str, ...]
    """What `orchestrator run --set` needs to fly it alone."""
    outcome: str
    """stands, tipped, unsettled, unknown; not flown: `error` says why."""
    trusted: bool
    error: str
    """One line: why it could not be flown to the end, or why it is not to be trusted."""
    outputs: Mapping[str, Output] = field(default_factory=dict)
    """The summary, flat (`orchestrator.campaign.outputs`); empty where it was not flown."""
    seconds: float = 0.0
    """Wall time on the worker."""
    cpu_seconds: float = 0.0
    worker: int = 0
    """Its process."""


def land(base: Base, overrides: Sequence[str]) -> Landing:
    """Fly it in this process. Never raises for what lies in the landing: a campaign goes on without it."""
    with _ONE_AT_A_TIME:
        began, cpu = perf_counter(), process_time()
        try:
            result, summary = _flown(base, overrides)
            error = fault(result)
            found = (outcome(summary), result.trusted, "" if error is None else str(error), flat(summary))
        except OrchestratorError as error:
            found = (NOT_FLOWN, False, str(error), {})
        except Exception as error:  # a bug, or a foreign unit's: this landing's alone until it is shown otherwise
            found = (NOT_FLOWN, False, f"{base.where}: {type(error).__name__}: {error}", {})
        return Landing(tuple(overrides), *found, perf_counter() - began, process_time() - cpu, os.getpid())


_ONE_AT_A_TIME = threading.Lock()
"""The units of a process fly one landing at a time, whatever number of threads a worker has."""
_UNITS = LoadedUnits()
_tree = lru_cache(maxsize=4)(lambda base: tomllib.loads(base.text))


def blueprint(base: Base, overrides: Sequence[str]) -> Blueprint:
    """As for a run of its own."""
    return draw_up(base.scenario(overrides), None)


def _flown(base: Base, overrides: Sequence[str]) -> tuple[RunResult, dict[str, Any]]:
    from orchestrator.results.writer import summarise  # slow to import: scipy

    result = _UNITS.run(blueprint(base, overrides), on_hang=lambda _: os._exit(RunError.exit_code))
    if not result.complete:
        raise RunError(result.message)
    table = read_results_table(result.results, f"{base.where}: results")
    path = references.find(table.references, [Path()])
    published = references.parse(result.paper) if path is None else references.load(path)
    channels = Channels(result.times, result.columns)
    return result, summarise(result, channels, table, account_of(channels, table), published)
