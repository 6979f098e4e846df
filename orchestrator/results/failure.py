"""What can go wrong in a landing and how much was left: tip-over, the three strokes, clearance, loads (the paper's Figure 12).

All is taken from recorded outputs and from the parameters the units were given, by name. An extreme between two recorded rows is known
to the unit alone: `peak_stroke` keeps a primary's greatest stroke over the unit's own steps (the twin's: over the master's), every other
extreme here is over the recorded rows. At 10 ms between rows a stroke that turns under 20 m/s2 is missed by at most 0.25 mm.
Strokes, clearance and loads count up to the row with the centre of mass beyond an edge: afterwards they are those of a fall.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from orchestrator.results.channels import Array, Channels, finite
from orchestrator.results.geometry import Parameters, ground_plane, mass_properties, motion_of, pad_positions, touched
from orchestrator.results.schema import LegChannels, ResultsTable
from orchestrator.results.tip_over import Edges, Motion, edges

SECONDARIES = ("right", "left")
STROKES = ("primary_stroke", "secondary_compression", "secondary_tension")
LIMITS = {"primary_stroke": "primary_limit", "secondary_compression": "compression_limit", "secondary_tension": "tension_limit"}


def failure(channels: Channels, table: ResultsTable, parameters: Parameters) -> dict[str, Any]:
    """The key `failure` of summary.json: measures with the margin left (negative: failed), and the list of those that failed."""
    pads = pad_positions(channels, table)
    motion = motion_of(channels, table.body)
    found = tipping(channels, table, parameters, pads, motion)
    upright = channels if found is None else until(channels, found)
    measures = {
        "tip_over": None if found is None else tip_over(channels, table, found),
        **{name: stroke(upright, table, parameters, name) for name in STROKES},
        "clearance": clearance(upright, table, parameters, motion_of(upright, table.body)),
        "peak_loads": peak_loads(upright, table),
    }
    channels.missing += [name for name in upright.missing if name not in channels.missing]
    return {"failed": failed(measures), **measures}


def tipping(
    channels: Channels, table: ResultsTable, parameters: Parameters, pads: Array | None, motion: Motion | None
) -> Edges | None:
    """Angle and energy at every edge; None without positions or with less than three legs."""
    if pads is None or motion is None or len(channels.times) == 0 or pads.shape[1] < 3:
        return None
    return edges(pads, motion, mass_properties(table.body, parameters))


def until(channels: Channels, found: Edges) -> Channels:
    """The rows up to the first with the centre of mass beyond an edge."""
    over = found.angle.min(axis=1) < 0.0
    if not over.any():
        return channels
    rows = int(np.argmax(over)) + 1
    return Channels(channels.times[:rows], {name: column[:rows] for name, column in channels.columns.items()})


def failed(found: Mapping[str, Any]) -> list[str]:
    """Names of the measures whose margin is used up."""
    tipped = ["tip_over"] if (found["tip_over"] or {}).get("tipped") else []
    return tipped + [name for name in (*STROKES, "clearance") if ((found[name] or {}).get("margin_m") or 0.0) < 0.0]


def tip_over(channels: Channels, table: ResultsTable, found: Edges) -> dict[str, Any]:
    """Least angle and energy margin over any edge from first contact on; orchestrator.results.tip_over has the physics.

    `tipped`: the centre of mass was beyond an edge, or turns too fast to stay inside at the end. `decided`: it was beyond, or all the
    kinetic energy there is at the end would not lift it over. Where it went over, `least_*` are those of the first row beyond.
    """
    since = touched(channels, table)
    over = found.angle.min(axis=1) < 0.0
    rows = slice(since, max(since, int(np.argmax(over))) + 1 if over.any() else None)
    row, edge = np.unravel_index(np.argmin(found.angle[rows]), found.angle[rows].shape)
    names = list(table.legs)
    first, second = found.pads[int(edge)]
    energy = None if found.energy is None else found.energy[rows].min(axis=1)
    end = None if found.energy is None else float(found.energy[-1].min())
    secure = bool(over.any()) or (found.secure is not None and bool(found.secure[-1].min() > 0.0))
    return {
        "tipped": bool(over.any()) or (end is not None and end < 0.0),
        "decided": secure,
        "least_angle_deg": finite(np.degrees(found.angle[since + row, edge])),
        "at_s": finite(channels.times[since + row]),
        "edge": f"{names[first]} | {names[second]}",
        "final_angle_deg": finite(np.degrees(found.angle[-1].min())),
        "least_energy_margin_J": None if energy is None else finite(energy.min()),
        "least_energy_margin_at_s": None if energy is None else finite(channels.times[since + int(np.argmin(energy))]),
        "final_energy_margin_J": None if end is None else finite(end),
    }


def stroke(channels: Channels, table: ResultsTable, parameters: Parameters, name: str) -> dict[str, Any] | None:
    """Of all struts that have such a stroke the one with the least margin: peak, limit (the leg's own), what is left, all in m."""
    rows = []
    for leg, names in table.legs.items():
        limit = parameters.get(f"{names.leg.partition('.')[0]}.{LIMITS[name]}")
        for strut, peak in strokes_of(channels, names, name).items():
            if peak is not None and limit is not None:
                rows.append({"margin_m": limit - peak, "peak_m": peak, "limit_m": limit, "strut": f"{leg}.{strut}"})
    return min(rows, key=lambda row: float(str(row["margin_m"])), default=None)


def strokes_of(channels: Channels, names: LegChannels, name: str) -> dict[str, float | None]:
    """Strut -> greatest stroke of this kind, m, never below 0."""
    if name == "primary_stroke":
        return {"primary": _greatest(channels, f"{names.leg}.primary", +1.0)}
    sign = 1.0 if name == "secondary_tension" else -1.0
    return {strut: _greatest(channels, f"{names.leg}.{strut}", sign) for strut in SECONDARIES}


def _greatest(channels: Channels, strut: str, sign: float) -> float | None:
    low, high = channels.span(f"{strut}.stroke")
    if low is None or high is None:
        return None
    peak = high if sign > 0.0 else -low
    kept = channels.final(f"{strut}.peak_stroke") if sign > 0.0 and f"{strut}.peak_stroke" in channels.columns else None
    return max(0.0, peak, kept or 0.0)


def clearance(channels: Channels, table: ResultsTable, parameters: Parameters, motion: Motion | None) -> dict[str, Any] | None:
    """Least distance of the lowest ring of the body (the nozzle's exit) from the ground plane, m; negative: it struck.

    d = n·(x + h b̂ − o) − r √(1 − (n·b̂)²)   with n the ground's normal, o a point of it, b̂ the body's axis +X in L, h the ring's height
    over B's origin (negative) and r its radius. None where the scenario names no ring or the soils do not lie in one known plane.
    """
    ring, plane = table.lowest, ground_plane(table, parameters)
    heights = {parameters.get(f"{names.leg.partition('.')[0]}.origin_height") for names in table.legs.values()}
    if ring is None or plane is None or motion is None or len(heights) != 1 or len(channels.times) == 0:
        return None
    (origin_height,) = heights
    if origin_height is None:
        return None
    origin, normal = plane
    w, x, y, z = motion.quaternion.T
    axis = np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=1)
    centre = motion.position + (ring.height_above_pads - origin_height) * axis - origin
    lean = np.clip(1.0 - (axis @ normal) ** 2, 0.0, 1.0)
    distance = centre @ normal - ring.radius * np.sqrt(lean)
    row = int(np.argmin(distance))
    return {
        "margin_m": finite(distance[row]),
        "at_s": finite(channels.times[row]),
        "final_m": finite(distance[-1]),
        "undeformed_m": ring.height_above_pads,
    }


def peak_loads(channels: Channels, table: ResultsTable) -> dict[str, Any]:
    """Greatest axial load of each kind of strut (without bearing friction) and greatest normal force on a pad, N, and where."""
    struts = {
        f"{leg}.{strut}": _largest(channels, f"{names.leg}.{strut}.load")
        for leg, names in table.legs.items()
        for strut in ("primary", *SECONDARIES)
    }
    pads = {leg: _largest(channels, f"{names.soil}.normal_force") for leg, names in table.legs.items()}
    kinds = {
        "primary": {name: load for name, load in struts.items() if name.endswith(".primary")},
        "secondary": {name: load for name, load in struts.items() if not name.endswith(".primary")},
        "pad": pads,
    }
    return {kind: _worst(loads) for kind, loads in kinds.items()}


def _largest(channels: Channels, name: str) -> float | None:
    low, high = channels.span(name)
    return None if low is None or high is None else max(-low, high)


def _worst(loads: Mapping[str, float | None]) -> dict[str, Any] | None:
    known = {name: load for name, load in loads.items() if load is not None}
    if not known:
        return None
    where = max(known, key=lambda name: known[name])
    return {"load_N": known[where], "at": where}
