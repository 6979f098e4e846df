"""Where the boundaries are: on each ray of the plane of speeds the slowest landing of all combinations that fails, for each failure.

1. Rungs. All combinations are flown at a few multiples of the certified speed, from the lowest up, until every failure has been seen.
2. Brackets. Between the rung where none failed and the next, the combination nearest to failing is bisected to the asked width. Then all
   others that failed at the rung above are flown where it still held; the nearest of those that fail there is bisected next, below, until
   none fails. The last bracket is the boundary: its lower end holds in every combination, its upper end fails in one.

Assumed: a combination that fails at one speed fails at every higher one on the same ray. What that leaves open is asked by `audit`:
landings anywhere in the certified envelope, at random, with inputs between those of the grid.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, field

from orchestrator.doghouse.flying import Flying, Scenario
from orchestrator.doghouse.landing import BOUNDARIES, Inputs, Margins, combinations
from orchestrator.doghouse.model import Doghouse

Asked = Generator[list[Inputs], list[Margins], "Bracket | None"]


@dataclass(frozen=True)
class Bracket:
    """Two landings of one combination, the one before the failure and the one after it."""

    inside: Inputs
    inside_margins: Margins
    beyond: Inputs
    beyond_margins: Margins


@dataclass
class Ray:
    """What was flown along one ray: speed -> margin of each combination."""

    angle: float
    """rad from the vertical."""
    certified: float
    """m/s."""
    combinations: list[Inputs]
    rungs: dict[float, list[Margins]] = field(default_factory=dict)
    brackets: dict[str, Bracket] = field(default_factory=dict)

    def failing(self, boundary: str) -> list[bool]:
        """By rung, from the lowest, whether any combination fails."""
        return [any(margins.fails(boundary) for margins in rung) for rung in self.rungs.values()]

    def found(self) -> bool:
        return all(any(self.failing(boundary)) for boundary in BOUNDARIES)


def search(doghouse: Doghouse, scenario: Scenario, flying: Flying) -> list[Ray]:
    """Every ray with its brackets; a boundary that no rung reached has none."""
    rays = [_ray(doghouse, angle) for angle in doghouse.search.rays_deg]
    for rung in doghouse.search.rungs:
        open_ = [ray for ray in rays if not ray.found()]
        landings = [one.at(ray.angle, rung * ray.certified) for ray in open_ for one in ray.combinations]
        margins = iter(flying.fly(scenario, landings, f"all landings at {rung:g} times the certified speed"))
        for ray in open_:
            ray.rungs[rung * ray.certified] = [next(margins) for _ in ray.combinations]
    asked = {(ray.angle, name): bracketed(ray, name, doghouse.search.bracket_m_s) for ray in rays for name in BOUNDARIES}
    found = _together(asked, scenario, flying)
    for ray in rays:
        ray.brackets = {name: bracket for name in BOUNDARIES if (bracket := found[ray.angle, name]) is not None}
    return rays


def _ray(doghouse: Doghouse, degrees: float) -> Ray:
    angle = math.radians(degrees)
    return Ray(angle, doghouse.certified.speed_along(angle), combinations(doghouse.varies, without_motion=degrees == 0.0))


def _together(asked: Mapping[tuple[float, str], Asked], scenario: Scenario, flying: Flying) -> dict[tuple[float, str], Bracket | None]:
    """Run all searches at once: each round flies what every one of them wants to know next."""
    found: dict[tuple[float, str], Bracket | None] = {}
    wanted: dict[tuple[float, str], list[Inputs]] = {}
    answers: dict[tuple[float, str], list[Margins]] = {}
    while True:
        for name, one in asked.items():
            if name in found:
                continue
            try:
                wanted[name] = one.send(answers[name]) if name in answers else next(one)
            except StopIteration as end:
                found[name] = end.value
                wanted.pop(name, None)
        if not wanted:
            return found
        landings = [landing for one in wanted.values() for landing in one]
        margins = iter(flying.fly(scenario, landings, f"bisecting, {len(wanted)} of {len(asked)} boundary points open"))
        answers = {name: [next(margins) for _ in one] for name, one in wanted.items()}


def bracketed(ray: Ray, boundary: str, width: float) -> Asked:
    """The boundary on a ray; yields landings to fly and is sent their margins."""
    failing = ray.failing(boundary)
    if not any(failing):
        return None
    speeds = list(ray.rungs)
    at = failing.index(True)
    high, low = speeds[at], speeds[at - 1] if at else 0.0
    left = [one for one, margins in zip(ray.combinations, ray.rungs[high], strict=True) if margins.fails(boundary)]
    order = _nearest(ray, boundary, speeds[at - 1] if at else high)
    left.sort(key=lambda one: order[one])
    bracket: Bracket | None = None
    while left:
        worst, others = left[0], left[1:]
        bracket = yield from bisected(ray, worst, boundary, (low, high), width)
        high = _speed(bracket.inside)
        margins = yield [one.at(ray.angle, high) for one in others]
        still = [(one, found) for one, found in zip(others, margins, strict=True) if found.fails(boundary)]
        left = [one for one, found in sorted(still, key=lambda pair: _margin(pair[1], boundary))]
    return bracket


def bisected(
    ray: Ray, one: Inputs, boundary: str, between: tuple[float, float], width: float
) -> Generator[list[Inputs], list[Margins], Bracket]:
    """Halve until the last speed at which the combination holds and the first at which it fails are `width` apart, m/s."""
    low, high = between
    inside, beyond = yield [one.at(ray.angle, low), one.at(ray.angle, high)]
    while high - low > width:
        middle = 0.5 * (low + high)
        (found,) = yield [one.at(ray.angle, middle)]
        if found.fails(boundary):
            high, beyond = middle, found
        else:
            low, inside = middle, found
    return Bracket(one.at(ray.angle, low), inside, one.at(ray.angle, high), beyond)


def _nearest(ray: Ray, boundary: str, speed: float) -> dict[Inputs, float]:
    """Margin of each combination at a rung: the order in which they are tried."""
    return {one: _margin(margins, boundary) for one, margins in zip(ray.combinations, ray.rungs[speed], strict=True)}


def _margin(margins: Margins, boundary: str) -> float:
    left = margins.left.get(boundary)
    return -math.inf if left is None else left


def _speed(inputs: Inputs) -> float:
    return math.hypot(inputs.horizontal_m_s, inputs.vertical_m_s)


def landings(rays: Sequence[Ray]) -> list[tuple[Inputs, Margins]]:
    """All of the rungs."""
    return [
        (one.at(ray.angle, speed), margins)
        for ray in rays
        for speed, rung in ray.rungs.items()
        for one, margins in zip(ray.combinations, rung, strict=True)
    ]
