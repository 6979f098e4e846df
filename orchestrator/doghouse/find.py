"""From a plan to an outcome: search, random landings, and the brackets again by the separate units."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter

from orchestrator.campaign.crew import Crew
from orchestrator.doghouse.audit import drawn
from orchestrator.doghouse.flying import Flying, Heard, Logbook, Scenario
from orchestrator.doghouse.model import Doghouse
from orchestrator.doghouse.outcome import Checked, Outcome
from orchestrator.doghouse.search import Ray, search

LOGBOOK = "landings.jsonl"


def find(doghouse: Doghouse, path: Path, folder: Path, crew: Crew, heard: Heard | None = None, check: bool = True) -> Outcome:
    """`folder` keeps every landing flown; called again it goes on from there."""
    began = perf_counter()
    flown_by = Scenario.read(doghouse.search, path.parent, f"{path.name}: search")
    checked_by = Scenario.read(doghouse.check, path.parent, f"{path.name}: check")
    flying = Flying(crew, Logbook(folder / LOGBOOK), heard)
    rays = search(doghouse, flown_by, flying)
    random = drawn(doghouse)
    audited = list(zip(random, flying.fly(flown_by, random, "landings at random inside the envelope"), strict=True))
    checked = _checked(rays, checked_by, flying) if check else {}
    cost = {
        "landings": float(flying.asked),
        "flown_now": float(flying.flown),
        "cpu_s": flying.cpu_seconds,
        "wall_s": perf_counter() - began,
        "workers": float(crew.size),
    }
    return Outcome(doghouse, flown_by, checked_by, rays, checked, audited, cost)


def _checked(rays: list[Ray], scenario: Scenario, flying: Flying) -> Checked:
    """Both landings of every bracket."""
    names = [(ray, name) for ray in rays for name in ray.brackets]
    landings = [one for ray, name in names for one in (ray.brackets[name].inside, ray.brackets[name].beyond)]
    margins = flying.fly(scenario, landings, "brackets by the separate units")
    return {(ray.angle, name): (margins[2 * i], margins[2 * i + 1]) for i, (ray, name) in enumerate(names)}
