"""`[terrain]` -> start values of the units that stand on it."""

from __future__ import annotations

import hashlib
import io
import uuid
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from orchestrator.errors import ScenarioError
from orchestrator.fmi.unpack import private_folder
from orchestrator.master.slave import Interface, Value
from orchestrator.terrain.height_map import HeightMap, read_height_map
from orchestrator.terrain.table import TerrainTable

MAP = "terrain.map"


def terrain_values(table: TerrainTable | None, interfaces: Mapping[str, Interface], where: str) -> dict[str, dict[str, Value]]:
    """Unit -> variable -> value, for every unit that declares `terrain.map`; nothing without the table."""
    if table is None:
        return {}
    taking = [unit for unit, interface in interfaces.items() if MAP in interface.variables]
    if not taking:
        raise ScenarioError(f"{where}: terrain: no unit has a parameter {MAP}; use RegolithContact or LunarLander, or remove the table")
    values: dict[str, Value] = {"terrain.heading": table.heading, "terrain.reach": table.reach}
    if table.file is not None:
        values |= _of_map(read_height_map(table, where))
    found = {}
    for unit in taking:
        own = dict(values)
        own |= _listed("craters", [it.numbers() for it in table.craters], interfaces[unit], where)
        own |= _listed("boulders", [it.numbers() for it in table.boulders], interfaces[unit], where)
        found[unit] = own
    return found


def _of_map(height_map: HeightMap) -> dict[str, Value]:
    return {
        MAP: str(kept(height_map)),
        "terrain.map_corner[1]": height_map.north,
        "terrain.map_corner[2]": height_map.east,
        "terrain.map_step[1]": height_map.step_north,
        "terrain.map_step[2]": height_map.step_east,
    }


def _listed(name: str, rows: list[list[float]], interface: Interface, where: str) -> dict[str, Value]:
    """Rows of numbers one after the other in a vector, which must have room for them."""
    elements = interface.vectors.get(f"terrain.{name}", [])
    numbers = [number for row in rows for number in row]
    if len(numbers) > len(elements):
        room = len(elements) // len(rows[0])
        given = f"{where}: terrain.{name}: {len(rows)} of them"
        raise ScenarioError(f"{given}, {interface.model_name} has room for {room}; put the others into the map")
    return {element.name: number for element, number in zip(elements, numbers, strict=False)}


def kept(height_map: HeightMap) -> Path:
    """The tile as a file of its own, named by its content: the same for all runs and processes that use it."""
    buffer = io.BytesIO()
    np.save(buffer, height_map.heights)
    content = buffer.getvalue()
    path = private_folder() / f"terrain-{hashlib.sha256(content).hexdigest()[:24]}.npy"
    if not path.is_file():
        unfinished = path.with_suffix(f".{uuid.uuid4().hex}")
        unfinished.write_bytes(content)
        unfinished.replace(path)
    return path
