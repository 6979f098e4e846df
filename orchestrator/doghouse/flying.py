"""Who flies the landings of a Doghouse, and what is kept of them: a line a landing, so that an interrupted search goes on."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.campaign.crew import Crew
from orchestrator.campaign.inputs import resolved
from orchestrator.campaign.landing import Base
from orchestrator.checkpoint.origin import made_with, sources
from orchestrator.doghouse.landing import Inputs, Margins, margins_of, overrides
from orchestrator.doghouse.model import Flown
from orchestrator.errors import ScenarioError

PLACES = re.compile(r'^(fmu|references) = ".*"$', re.MULTILINE)
"""Lines of a scenario that say where files lie, by which its landings are no others."""
SOURCES = ("results", "campaign", "doghouse")
"""Folders of the orchestrator that margins are computed in; the master's are in `made_with`."""
Heard = Callable[[str, int, int], None]
"""Called with the stage, how many of its landings are done, and of how many."""


@dataclass(frozen=True)
class Scenario:
    """A scenario ready to be flown, and what the inputs are called in it."""

    path: Path
    base: Base
    addresses: Mapping[str, Sequence[str]]
    made_of: str
    """Of what its landings follow from: text, FMUs, versions."""

    @classmethod
    def read(cls, flown: Flown, folder: Path, where: str) -> Scenario:
        path = folder / flown.scenario
        if not path.is_file():
            raise ScenarioError(f"{where}: no file {path}; give the name of a scenario beside it")
        drawn = draw_up(read_scenario(path), path)
        addresses = {name: resolved(address, drawn, f"{where}.set.{name}") for name, address in flown.names.model_dump().items()}
        if len(addresses["velocity"]) != 3:
            raise ScenarioError(f"{where}.set.velocity: has {len(addresses['velocity'])} elements, expects 3; name a vector with [*]")
        base = Base.read(path)
        units = sorted({interface.sha256 for interface in drawn.interfaces.values()})
        text = PLACES.sub("", base.text)
        made = [sources(SOURCES), *(f"{name} {version}" for name, version in sorted(made_with().items()))]
        return cls(path, base, addresses, hashlib.sha256("\n".join([text, *units, *made]).encode()).hexdigest())

    def overrides(self, inputs: Inputs) -> list[str]:
        return overrides(inputs, self.addresses)


class Logbook:
    """Landings flown before, by scenario and overrides, in a file that only grows."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._known: dict[str, Margins] = {}
        self.cost: dict[str, float] = {}
        """s of computing."""
        if path.is_file():
            for line in path.read_text(encoding="utf-8").splitlines():
                self._learn(line)

    def get(self, key: str) -> Margins | None:
        return self._known.get(key)

    def put(self, key: str, margins: Margins, cpu_seconds: float) -> None:
        self._known[key], self.cost[key] = margins, cpu_seconds
        if margins.error:  # a worker that died or a time limit is no property of the landing: it is flown again by another call
            return
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"key": key, "cpu_seconds": cpu_seconds, **asdict(margins)}) + "\n")

    def _learn(self, line: str) -> None:
        """A line half written when the machine went down is passed over: that landing is flown again."""
        try:
            row = json.loads(line)
            key, cpu_seconds = row.pop("key"), row.pop("cpu_seconds", 0.0)
            row["failed"] = tuple(row["failed"])
            self._known[key], self.cost[key] = Margins(**row), cpu_seconds
        except (ValueError, KeyError, TypeError):
            return


class Flying:
    """Landings by a crew, those in the logbook taken from there."""

    def __init__(self, crew: Crew, logbook: Logbook, heard: Heard | None = None) -> None:
        self.crew, self.logbook, self.heard = crew, logbook, heard
        self.asked = self.flown = 0
        self.cpu_seconds = 0.0

    def fly(self, scenario: Scenario, landings: Sequence[Inputs], stage: str) -> list[Margins]:
        """Margins in the order of the landings."""
        wanted = [(self._key(scenario, text), text) for text in map(scenario.overrides, landings)]
        left = {key: text for key, text in wanted if self.logbook.get(key) is None}
        self.asked += len(landings)
        self._tell(stage, len(wanted) - len(left), len(wanted))
        for done, (key, landing) in enumerate(self.crew.fly(scenario.base, left.items()), start=len(wanted) - len(left) + 1):
            self.flown += 1
            self.logbook.put(key, margins_of(landing.outputs, landing.error, landing.trusted), landing.cpu_seconds)
            self._tell(stage, done, len(wanted))
        self.cpu_seconds += sum(self.logbook.cost.get(key, 0.0) for key in dict(wanted))
        return [found for key, _ in wanted if (found := self.logbook.get(key)) is not None]

    def _key(self, scenario: Scenario, text: Sequence[str]) -> str:
        return hashlib.sha256("\n".join([scenario.made_of, *text]).encode()).hexdigest()[:32]

    def _tell(self, stage: str, done: int, of: int) -> None:
        if self.heard is not None:
            self.heard(stage, done, of)
