"""Where the vehicle, its pads and the ground were, by the names of recorded outputs and of the units' parameters."""

import re
from collections.abc import Mapping

import numpy as np

from orchestrator.results.channels import Array, Channels
from orchestrator.results.schema import ResultsTable
from orchestrator.results.tip_over import MassProperties, Motion

Parameters = Mapping[str, float]
"""`unit.parameter` -> number, defaults included; of a text, whether there is any."""
RELIEF = re.compile(r"\.terrain\.(map|craters\[\d+\]|boulders\[\d+\])$")


def mass_properties(body: str, parameters: Parameters) -> MassProperties | None:
    """As the unit that is the body was given them."""
    names = [f"{body}.mass", f"{body}.gravity", *(f"{body}.inertia[{i}]" for i in (1, 2, 3))]
    if any(name not in parameters for name in names):
        return None
    mass, gravity, xx, yy, zz = (parameters[name] for name in names)
    xy, xz, yz = (parameters.get(f"{body}.inertia_products[{i}]", 0.0) for i in (1, 2, 3))
    return MassProperties(mass, np.array([[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]), gravity)


def motion_of(channels: Channels, body: str) -> Motion | None:
    """The body's motion; None where part of it was not recorded."""
    parts = [
        _vector(channels, f"{body}.body.{name}", size)
        for name, size in (("position", 3), ("velocity", 3), ("quaternion", 4), ("angular_velocity", 3))
    ]
    known = [part for part in parts if part is not None]
    return Motion(*known) if len(known) == len(parts) else None


def pad_positions(channels: Channels, table: ResultsTable) -> Array | None:
    """(n, legs, 3): the ball joints in L; None where one was not recorded."""
    parts = [_vector(channels, f"{names.leg}.pad.position", 3) for names in table.legs.values()]
    known = [part for part in parts if part is not None]
    return np.stack(known, axis=1) if known and len(known) == len(parts) else None


def ground_plane(table: ResultsTable, parameters: Parameters) -> tuple[Array, Array] | None:
    """A point and the unit normal of the one plane all soils lie in, N = Rx(azimuth) Ry(slope) x̂ as docs/physics.md has it.

    None where there are several, or a relief on it.
    """
    units = {names.soil.partition(".")[0] for names in table.legs.values()}
    if any(value != 0.0 for name, value in parameters.items() if name.partition(".")[0] in units and RELIEF.search(name)):
        return None
    planes = set()
    for k, names in enumerate(table.legs.values(), start=1):
        unit, _, inner = names.soil.partition(".")
        prefix, of = (f"{unit}.soil.", f"[{k}]") if inner else (f"{unit}.", "")
        slope, azimuth = parameters.get(f"{prefix}ground_slope{of}"), parameters.get(f"{prefix}ground_azimuth{of}")
        first = 3 * (k - 1) if inner else 0
        origin = tuple(parameters.get(f"{prefix}ground_origin[{first + i}]", 0.0) for i in (1, 2, 3))
        planes.add((slope, azimuth, origin))
    if len(planes) != 1:
        return None
    ((slope, azimuth, origin),) = planes
    if slope is None or azimuth is None:
        return None
    return np.array(origin), np.array([np.cos(slope), np.sin(slope) * np.sin(azimuth), -np.sin(slope) * np.cos(azimuth)])


def touched(channels: Channels, table: ResultsTable) -> int:
    """Row of the first contact of any pad; the first row where none is told."""
    contacts = [channels.columns.get(f"{names.soil}.contact") for names in table.legs.values()]
    rows = [int(np.argmax(contact > 0.5)) for contact in contacts if contact is not None and (contact > 0.5).any()]
    return min(rows, default=0)


def _vector(channels: Channels, name: str, size: int) -> Array | None:
    """(n, size), without complaint where it was not recorded: a unit of another make need not have it."""
    names = [f"{name}[{i}]" for i in range(1, size + 1)]
    if any(one not in channels.columns or len(channels.columns[one]) == 0 for one in names):
        return None
    return np.stack([np.asarray(channels.columns[one], dtype=np.float64) for one in names], axis=1)
