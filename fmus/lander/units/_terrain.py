"""What units on the ground share: the relief's parameters, its file, and whether the map is whole where the pads stand."""

import zlib
from functools import lru_cache
from math import cos, hypot, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..laws.crater import Boulder, Crater
from ..laws.height_map import HeightMap
from ..laws.relief import Relief
from ..laws.surface import Surface
from ..shell import Unit, UnitError, parameter, state, text

Array = NDArray[np.float64]
ROOM = 8  # craters, and boulders
NO_MAP, NOT_YET = 0.0, -1.0

TERRAIN = (  # decision 12; null unless set
    text("terrain.map", "path of a .npy file: heights in m over the plane, rows to the north, columns to the east; empty: no map"),
    parameter("terrain.map_corner", (0.0, 0.0), "m", "of the map's first node from L's origin: to the north, to the east"),
    parameter("terrain.map_step", (1.0, 1.0), "m", "between the map's rows, between its columns", minimum=1e-4),
    parameter("terrain.heading", 0.0, "rad", "of L's +Z, clockwise from the map's north", minimum=-7.0, maximum=7.0),
    parameter("terrain.reach", 1.0, "m", "around each pad, within which the map must be whole at the start", minimum=0.0),
    parameter("terrain.craters", (0.0,) * 5 * ROOM, "m", f"{ROOM} of: Y, Z of the middle (L), diameter, depth, rim; diameter 0: none"),
    parameter("terrain.boulders", (0.0,) * 4 * ROOM, "m", f"{ROOM} of: Y, Z of the middle (L), radius, height; radius 0: none"),
    state("terrain.digest", NOT_YET, "of the map the unit was initialised with"),
)


def relief_of(unit: Unit) -> Relief | None:
    """The relief from a unit's parameters; None where there is a plane alone. UnitError where it cannot be."""
    craters = [Crater(*row) for row in unit["terrain.craters"].reshape(-1, 5).tolist() if row[2] != 0.0]
    boulders = [Boulder(*row) for row in unit["terrain.boulders"].reshape(-1, 4).tolist() if row[2] != 0.0]
    for crater in craters:
        refuse_crater(crater)
    for boulder in boulders:
        if not 0.0 < boulder.height <= 2.0 * boulder.radius:
            most = 2.0 * boulder.radius
            raise UnitError(f"terrain.boulders: a height of {boulder.height:g} m, expects more than 0 and at most {most:g} m")
    heights = map_of(unit)
    if heights is None and not craters and not boulders:
        return None
    return Relief(placed(unit, heights), np.array(craters).reshape(-1, 5), np.array(boulders).reshape(-1, 4))


def refuse_crater(crater: Crater) -> None:
    """UnitError for a shape that is no crater."""
    if crater.diameter < 0.0 or not 0.0 < crater.depth <= crater.diameter or not 0.0 <= crater.rim <= crater.depth:
        raise UnitError(
            f"terrain.craters: diameter {crater.diameter:g} m, depth {crater.depth:g} m, rim {crater.rim:g} m; expects"
            " 0 < depth <= diameter and 0 <= rim <= depth"
        )


def placed(unit: Unit, heights: Array | None) -> HeightMap:
    """The map where it lies in L; of no size where there is none."""
    north, east = unit["terrain.map_corner"].tolist()
    step_north, step_east = unit["terrain.map_step"].tolist()
    heading = unit.value("terrain.heading")
    return HeightMap(np.zeros((0, 0)) if heights is None else heights, north, east, step_north, step_east, cos(heading), sin(heading))


def map_of(unit: Unit) -> Array | None:
    """The heights, refused where a state was restored that began with others: the map is a constant, not in the state."""
    path = unit.text("terrain.map")
    heights, digest = (None, NO_MAP) if not path else read_once(path, *file_stamp(path))
    begun = unit.value("terrain.digest")
    if begun not in (NOT_YET, digest):
        was, now = ("no map" if it == NO_MAP else f"a map with digest {it:.0f}" for it in (begun, digest))
        raise UnitError(f"terrain.map: the state began with {was}, this is {now}; set the same map before restoring")
    return heights


def file_stamp(path: str) -> tuple[int, int]:
    """When a file was changed and how long it is; UnitError where there is none."""
    try:
        found = Path(path).stat()
    except OSError:
        raise UnitError(f"terrain.map: {path}: no such file") from None
    return found.st_mtime_ns, found.st_size


@lru_cache(maxsize=8)
def read_once(path: str, changed: int, size: int) -> tuple[Array, float]:
    """A file's heights and their digest, read again when the file has changed."""
    try:
        given = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise UnitError(f"terrain.map: {path}: cannot be read as .npy ({error})") from None
    if not isinstance(given, np.ndarray) or given.ndim != 2 or given.dtype.kind not in "fiu" or min(given.shape) < 4:
        shape, kind = getattr(given, "shape", None), getattr(given, "dtype", None)
        raise UnitError(f"terrain.map: {path}: holds {kind} of shape {shape}, expects numbers in rows and columns, at least 4 by 4")
    heights = np.ascontiguousarray(given, dtype=np.float64)
    return heights, 1.0 + zlib.crc32(heights.tobytes())


def note_map(unit: Unit) -> None:
    """Keep the digest of the map that the run begins with."""
    path = unit.text("terrain.map")
    unit["terrain.digest"] = read_once(path, *file_stamp(path))[1] if path else NO_MAP


def refuse_gaps(surface: Surface, y: float, z: float, reach: float, which: str) -> None:
    """UnitError where the map ends or has a missing node within `reach` (m) of (y, z), L."""
    if surface.relief is None or not surface.relief.map.heights.size:
        return
    m = surface.relief.map
    north, east = z * m.cos - y * m.sin, y * m.cos + z * m.sin
    rows, columns = m.heights.shape
    at = f"{which} at Y = {y:.3f} m, Z = {z:.3f} m"
    ends = (
        min(north - m.north, m.north + (rows - 1) * m.step_north - north) - m.step_north,
        min(east - m.east, m.east + (columns - 1) * m.step_east - east) - m.step_east,
    )
    if min(ends) < reach:
        where = f"{min(ends):.3g} m inside the edge" if min(ends) >= 0.0 else f"{-min(ends):.3g} m beyond the edge"
        raise UnitError(f"{at} is {where} of what the height map covers, expects at least {reach:g} m; give a larger map or another origin")
    i, j = np.nonzero(~np.isfinite(m.heights))
    if not i.size:
        return
    aside = np.maximum(np.abs(m.north + i * m.step_north - north) - 2.0 * m.step_north, 0.0)
    along = np.maximum(np.abs(m.east + j * m.step_east - east) - 2.0 * m.step_east, 0.0)
    away = np.hypot(aside, along)
    k = int(np.argmin(away))
    if away[k] < max(reach, 1e-9):
        hole_north, hole_east = m.north + i[k] * m.step_north, m.east + j[k] * m.step_east
        far = hypot(hole_north - north, hole_east - east)
        raise UnitError(
            f"{at}: the height map has no value {far:.3g} m away, {hole_north:.3f} m north and {hole_east:.3f} m east of the origin;"
            f" expects to be whole within {reach:g} m and two nodes more; fill the hole or choose another origin"
        )
