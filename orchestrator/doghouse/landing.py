"""One landing of the Doghouse: its inputs, what they are to a scenario, and the margins that came of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from orchestrator.doghouse.model import Varies

BOUNDARIES = ("tip_over", "primary_stroke", "secondary_compression", "secondary_tension")
UNITS = {"tip_over": "deg", "primary_stroke": "m", "secondary_compression": "m", "secondary_tension": "m"}
PLACES = 12
"""Digits after the point of an override: 1 pm/s, so that the same landing is the same text on every machine."""


@dataclass(frozen=True)
class Inputs:
    """Speeds in m/s, angles in deg; directions level in L, 0 up the slope, 90 across."""

    horizontal_m_s: float
    vertical_m_s: float
    heading_deg: float
    motion_deg: float
    tilt_deg: float
    tilt_toward_deg: float
    friction: float

    def at(self, ray: float, speed: float) -> Inputs:
        """The same landing at another speed (m/s) on a ray (rad from the vertical)."""
        return replace(self, horizontal_m_s=speed * math.sin(ray), vertical_m_s=speed * math.cos(ray))

    def as_dict(self) -> dict[str, float]:
        return asdict(self)


@dataclass(frozen=True)
class Margins:
    """What was left, positive inside: deg of tip-over, m of strokes. `error` where the landing could not be flown to its end."""

    left: Mapping[str, float | None]
    failed: tuple[str, ...]
    decided: bool
    """Tip-over: over, or no longer able to go over."""
    stands: bool
    """At rest at the end; else the strokes of what is still to come, as of falling back after a swing, are not in the margins."""
    where: Mapping[str, str] = field(default_factory=dict)
    """The edge it came nearest to going over, the struts that came nearest to their limits."""
    clearance_m: float | None = None
    error: str = ""
    trusted: bool = True
    """Whether it held its tolerance to the end; one that did not counts as it ended, and is counted."""

    def fails(self, boundary: str) -> bool:
        """One that could not be flown is held to fail: a boundary may then be too near, never too far."""
        return bool(self.error) or boundary in self.failed


def combinations(varies: Varies, without_motion: bool = False) -> list[Inputs]:
    """Every landing that is to be compared, at no speed; straight down there is no direction of motion."""
    attitudes = [(0.0, 0.0), *itertools.product(varies.tilt_deg, varies.tilt_toward_deg)]
    motions = varies.motion_deg[:1] if without_motion else varies.motion_deg
    return [
        Inputs(0.0, 0.0, heading, motion, tilt, toward, friction)
        for heading, motion, (tilt, toward), friction in itertools.product(varies.heading_deg, motions, attitudes, varies.friction)
    ]


def attitude(inputs: Inputs) -> Rotation:
    """B to L: turned to its heading about the vertical, then its axis tilted toward a level direction d about x̂ × d."""
    toward = math.radians(inputs.tilt_toward_deg)
    axis = np.cross([1.0, 0.0, 0.0], [0.0, math.sin(toward), math.cos(toward)])
    return Rotation.from_rotvec(math.radians(inputs.tilt_deg) * axis) * Rotation.from_rotvec([math.radians(inputs.heading_deg), 0.0, 0.0])


def start_values(inputs: Inputs) -> dict[str, list[float]]:
    """The inputs as a body's start takes them: velocity in B, the angles of the 321 sequence; SI."""
    turn = attitude(inputs)
    roll, pitch, yaw = turn.as_euler("ZYX").tolist()
    motion, across = math.radians(inputs.motion_deg), inputs.horizontal_m_s
    velocity = turn.inv().apply([-inputs.vertical_m_s, across * math.sin(motion), across * math.cos(motion)]).tolist()
    return {"velocity": velocity, "yaw": [yaw], "pitch": [pitch], "roll": [roll], "friction": [inputs.friction]}


def overrides(inputs: Inputs, addresses: Mapping[str, Sequence[str]]) -> list[str]:
    """As `orchestrator run --set` takes them; several addresses of one number all get it."""
    found = []
    for name, values in start_values(inputs).items():
        places = addresses[name]
        spread = values if len(values) == len(places) else values * len(places)
        found += [f"{place}={round(value, PLACES) + 0.0!r}" for place, value in zip(places, spread, strict=True)]
    return found


def margins_of(outputs: Mapping[str, Any], error: str, trusted: bool = True) -> Margins:
    """From a landing's flat summary; one that has none could not be flown."""
    if not outputs:
        return Margins(dict.fromkeys(BOUNDARIES), (), False, False, error=error or "not flown")
    left = {name: outputs.get(f"failure.{name}.margin_m") for name in BOUNDARIES}
    left["tip_over"] = outputs.get("failure.tip_over.least_angle_deg")
    failed = tuple(name for name in str(outputs.get("failure.failed") or "").split() if name in BOUNDARIES)
    if "tip_over" in failed and (left["tip_over"] or 0.0) > 0.0:
        left["tip_over"] = 0.0  # still inside, but turning too fast to stay so
    at = {name: str(outputs.get(f"failure.{name}.{'edge' if name == 'tip_over' else 'strut'}")) for name in BOUNDARIES}
    decided = bool(outputs.get("failure.tip_over.decided"))
    return Margins(left, failed, decided, bool(outputs.get("stable")), at, outputs.get("failure.clearance.margin_m"), trusted=trusted)
