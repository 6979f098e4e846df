"""What a Doghouse comes to: its boundaries beside the certified envelope, as data."""

from __future__ import annotations

import json
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from orchestrator.doghouse.flying import Scenario
from orchestrator.doghouse.landing import BOUNDARIES, UNITS, Inputs, Margins
from orchestrator.doghouse.model import Doghouse
from orchestrator.doghouse.search import Bracket, Ray, landings

Checked = Mapping[tuple[float, str], tuple[Margins, Margins]]
"""(ray, boundary) -> both landings of the bracket by the separate units."""


@dataclass(frozen=True)
class Outcome:
    """All of it; `rays` have every landing of the rungs."""

    doghouse: Doghouse
    search: Scenario
    check: Scenario
    rays: Sequence[Ray]
    checked: Checked
    audited: Sequence[tuple[Inputs, Margins]]
    cost: Mapping[str, float]

    def as_dict(self) -> dict[str, Any]:
        """doghouse.json."""
        points = {name: [self.point(ray, name) for ray in self.rays if name in ray.brackets] for name in BOUNDARIES}
        return {
            "title": self.doghouse.title,
            "certified": self.doghouse.certified.model_dump(),
            "all_outside": not self.inside() and not self.failed_audit(),
            "boundaries": points,
            "inside_certified": [point for name in BOUNDARIES for point in points[name] if not point["outside_certified"]],
            "not_reached": [self._not_reached(ray, name) for ray in self.rays for name in BOUNDARIES if name not in ray.brackets],
            "differ": [point for name in BOUNDARIES for point in points[name] if point["check"] and not point["check"]["agrees"]],
            "rungs": [self._rung(ray, speed) for ray in self.rays for speed in ray.rungs],
            "audit": self._audit(),
            "not_flown": [{"inputs": one.as_dict(), "error": margins.error} for one, margins in landings(self.rays) if margins.error],
            "not_trusted": sum(not margins.trusted for _, margins in landings(self.rays)),
            "varied": self.doghouse.varies.model_dump(),
            "cost": dict(self.cost),
        }

    def write(self, folder: Path) -> None:
        text = json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
        (folder / "doghouse.json").write_text(text + "\n", encoding="utf-8")

    def inside(self) -> list[tuple[str, Bracket]]:
        """Boundary points that do not lie outside the certified envelope."""
        points = [(ray, name) for ray in self.rays for name in BOUNDARIES if name in ray.brackets]
        return [(name, ray.brackets[name]) for ray, name in points if not self.outside(ray, name)]

    def outside(self, ray: Ray, name: str) -> bool:
        """The last landing that held was at least as fast as is certified."""
        held = ray.brackets[name].inside
        return held.horizontal_m_s**2 + held.vertical_m_s**2 >= ray.certified**2

    def failed_audit(self) -> list[tuple[Inputs, Margins]]:
        return [(one, margins) for one, margins in self.audited if margins.failed or margins.error]

    def agrees(self, ray: Ray, name: str) -> bool | None:
        """Whether both landings fall on the same side by the separate units; None where that was not asked or could not be flown."""
        pair = self.checked.get((ray.angle, name))
        if pair is None or any(margins.error for margins in pair):
            return None
        return not pair[0].fails(name) and pair[1].fails(name)

    def point(self, ray: Ray, name: str) -> dict[str, Any]:
        """The last landing that held, and beside it the first that failed."""
        bracket = ray.brackets[name]
        held, beyond = bracket.inside, bracket.beyond
        return {
            "horizontal_m_s": held.horizontal_m_s,
            "vertical_m_s": held.vertical_m_s,
            "inputs": held.as_dict(),
            "margin": bracket.inside_margins.left[name],
            "at_rest": bracket.inside_margins.stands,
            "clearance_m": bracket.inside_margins.clearance_m,
            "unit": UNITS[name],
            "where": bracket.beyond_margins.where.get(name, ""),
            "outside_certified": self.outside(ray, name),
            "times_certified": (held.horizontal_m_s**2 + held.vertical_m_s**2) ** 0.5 / ray.certified,
            "beyond": {"horizontal_m_s": beyond.horizontal_m_s, "vertical_m_s": beyond.vertical_m_s, "inputs": beyond.as_dict()}
            | {"margin": bracket.beyond_margins.left[name], "why": why(name, bracket.beyond_margins)},
            "commands": [command(self.search, one) for one in (held, beyond)],
            "check": self._check(ray, name),
        }

    def _check(self, ray: Ray, name: str) -> dict[str, Any] | None:
        pair = self.checked.get((ray.angle, name))
        if pair is None:
            return None
        held, beyond = pair
        bracket = ray.brackets[name]
        return {
            "agrees": self.agrees(ray, name),
            "margin": held.left[name],
            "beyond_margin": beyond.left[name],
            "errors": [margins.error for margins in pair if margins.error],
            "commands": [command(self.check, one) for one in (bracket.inside, bracket.beyond)],
        }

    def _rung(self, ray: Ray, speed: float) -> dict[str, Any]:
        """How many of all landings at one speed on a ray failed."""
        flown = ray.rungs[speed]
        fastest = ray.combinations[0].at(ray.angle, speed)
        return {
            "horizontal_m_s": fastest.horizontal_m_s,
            "vertical_m_s": fastest.vertical_m_s,
            "times_certified": speed / ray.certified,
            "landings": len(flown),
            "at_rest": sum(margins.stands for margins in flown),
            "failed": {name: sum(margins.fails(name) for margins in flown) for name in BOUNDARIES},
        }

    def _not_reached(self, ray: Ray, name: str) -> dict[str, Any]:
        fastest = ray.combinations[0].at(ray.angle, max(ray.rungs))
        return {"boundary": name, "horizontal_m_s": fastest.horizontal_m_s, "vertical_m_s": fastest.vertical_m_s}

    def _audit(self) -> dict[str, Any]:
        closest = {}
        for name in BOUNDARIES:
            known = [(margins.left[name], one) for one, margins in self.audited if margins.left[name] is not None]
            if known:
                margin, one = min(known, key=lambda pair: float(pair[0] or 0.0))
                closest[name] = {"margin": margin, "inputs": one.as_dict()}
        bad = [{"inputs": one.as_dict(), "failed": list(m.failed), "error": m.error} for one, m in self.failed_audit()]
        return {"landings": len(self.audited), "failed": bad, "closest": closest}


def why(name: str, margins: Margins) -> str:
    """What went wrong, in words."""
    if margins.error:
        return margins.error
    where = margins.where.get(name, "")
    if name == "tip_over":
        return f"goes over the edge between {where.replace(' | ', ' and ')}"
    return f"{where} reaches the end of its {name.replace('_', ' ')}"


def command(scenario: Scenario, inputs: Inputs) -> str:
    """The landing alone."""
    sets = " ".join(f"--set {shlex.quote(text)}" for text in scenario.overrides(inputs))
    return f"orchestrator run {scenario.path.stem} {sets}"


def words(inputs: Inputs) -> str:
    """A landing in one line."""
    names = {0.0: "up the slope", 90.0: "across it", 180.0: "down the slope", 270.0: "across it, against +Y"}
    motion = names.get(inputs.motion_deg % 360.0, f"toward {inputs.motion_deg:g} deg")
    tilt = "upright"
    if inputs.tilt_deg:
        tilt = f"tilted {inputs.tilt_deg:g} deg {names.get(inputs.tilt_toward_deg % 360.0, f'toward {inputs.tilt_toward_deg:g} deg')}"
    drift = "no drift" if inputs.horizontal_m_s < 1e-9 else f"moving {motion}"
    return f"heading {inputs.heading_deg:g} deg, {drift}, {tilt}, friction {inputs.friction:g}"
