"""What a landing comes down to: contacts, rates, attitude, penetration, skid, strokes, and whether it stands."""

import math
from typing import Any

import numpy as np

from orchestrator.results.channels import Channels
from orchestrator.results.schema import ResultsTable

DEGREES = math.degrees(1.0)
AXES = ("yaw", "pitch", "roll")
STRUTS = ("primary", "right", "left")
RESTING_RATE = math.radians(1.0)  # rad/s, about every axis
RESTING_SPEED = 0.05  # m/s, of the body's origin
TIPPED = math.radians(45.0)  # tilt of the body's axis from the vertical


def touchdown(channels: Channels, table: ResultsTable) -> dict[str, Any]:
    """The touchdown's keys of summary.json; strokes are those at rest, which a photograph shows.

    A value nobody recorded is None and its column named in `channels.missing`.
    """
    body, legs = table.body, table.legs
    return {
        "stable": is_stable(channels, table),
        "contact_times_s": {leg: contact_time(channels, names.soil) for leg, names in legs.items()},
        "peak_rates_deg_s": {axis: channels.span(f"{body}.rates.{axis}", DEGREES) for axis in AXES},
        "final_attitude_deg": {axis: channels.final(f"{body}.attitude.{axis}", DEGREES) for axis in AXES},
        "final_tilt_deg": _degrees(tilt(channels, body)),
        "penetration_m": {leg: channels.final(f"{names.soil}.penetration") for leg, names in legs.items()},
        "skid_m": {leg: channels.final(f"{names.soil}.skid") for leg, names in legs.items()},
        "strokes_m": {
            f"{leg}.{strut}": channels.final(f"{names.leg}.{strut}.stroke") for leg, names in legs.items() for strut in STRUTS
        },
        "peak_strokes_m": {
            f"{leg}.{strut}": channels.final(f"{names.leg}.{strut}.peak_stroke") for leg, names in legs.items() for strut in STRUTS
        },
        "bottomed": {leg: has_bottomed(channels, names.leg) for leg, names in legs.items()},
    }


def contact_time(channels: Channels, soil: str) -> float | None:
    """s, first contact of a footpad: the soil's own `contact_time` (-1 means never), else the first row with `gap` ≤ 0."""
    if f"{soil}.contact_time" in channels.columns:
        time = channels.final(f"{soil}.contact_time")
        return None if time is None or time < 0.0 else time
    gap = channels.series(f"{soil}.gap")
    if gap is None or not (gap <= 0.0).any():
        return None
    return float(channels.times[np.argmax(gap <= 0.0)])


def has_bottomed(channels: Channels, leg: str) -> bool | None:
    """Whether any strut of the leg was beyond its stroke limit at any recorded instant; None where the leg does not tell."""
    if f"{leg}.bottomed" not in channels.columns:
        return None
    return (channels.span(f"{leg}.bottomed")[1] or 0.0) > 0.0


def tilt(channels: Channels, body: str) -> float | None:
    """rad, angle between the body's axis +X and the vertical at the end: cos = cos(roll) cos(pitch)."""
    pitch, roll = (channels.final(f"{body}.attitude.{axis}") for axis in ("pitch", "roll"))
    if pitch is None or roll is None:
        return None
    return math.acos(max(-1.0, min(1.0, math.cos(roll) * math.cos(pitch))))


def is_stable(channels: Channels, table: ResultsTable) -> bool | None:
    """Whether the vehicle stands at the end of the run; None where attitude or rates were not recorded.

    It stands when (1) every recorded number is finite, (2) each body rate is below 1 deg/s, (3) its axis is within
    45 deg of the vertical, and (4) all pads are in contact, or else the body moves by less than 0.05 m/s, for a
    vehicle may rest on three pads.
    """
    rates = [channels.final(f"{table.body}.rates.{axis}") for axis in AXES]
    lean = tilt(channels, table.body)
    if not all(np.isfinite(column).all() for column in channels.columns.values()):
        return False
    if lean is None or any(rate is None for rate in rates):
        return None
    calm = all(rate is not None and abs(rate) < RESTING_RATE for rate in rates)
    return bool(calm and lean < TIPPED and (_all_in_contact(channels, table) or _at_rest(channels, table.body)))


def _all_in_contact(channels: Channels, table: ResultsTable) -> bool:
    return bool(table.legs) and all(channels.final(f"{names.soil}.contact") for names in table.legs.values())


def _at_rest(channels: Channels, body: str) -> bool:
    velocity = [channels.final(f"{body}.body.velocity[{i}]") for i in (1, 2, 3)]
    return math.hypot(*(math.inf if v is None else v for v in velocity)) < RESTING_SPEED


def _degrees(angle: float | None) -> float | None:
    return None if angle is None else math.degrees(angle)
