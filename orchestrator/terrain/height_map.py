"""A file of heights -> the tile around the landing site, checked: metres, regular, not turned, with something in it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.errors import ScenarioError
from orchestrator.terrain.table import TerrainTable

Array = NDArray[np.float64]
METRES = ("m", "metre", "metres", "meter", "meters")
FEWEST = 4
"""Rows and columns: the interpolation's stencil."""
_VERTICAL = re.compile(r'VERT_?(?:CS|CRS)\[.*?(?:LENGTH)?UNIT\["([^"]+)",\s*([0-9.eE+-]+)', re.IGNORECASE | re.DOTALL)


@dataclass(frozen=True)
class Raster:
    """Heights as a file has them: the first row northmost. `west`, `north`: of the first node, in the file's coordinates, m."""

    heights: Array
    west: float
    north: float
    pixel_north: float
    pixel_east: float


@dataclass(frozen=True)
class HeightMap:
    """Heights over that at the origin, m, the first row southmost; nan where there is none."""

    heights: Array
    north: float
    """Of the first node from the origin, m."""
    east: float
    step_north: float
    step_east: float


def read_height_map(table: TerrainTable, where: str) -> HeightMap:
    """The tile within `extent` of the origin; ScenarioError in one line for what cannot be used."""
    path = Path(table.file or "")
    place = f"{where}: terrain.file = {path.name}"
    if not path.is_file():
        raise ScenarioError(f"{place}: {path}: no such file; give a GeoTIFF or .npy file beside the scenario")
    raster = read_npy(path, table, place) if path.suffix.lower() == ".npy" else read_geotiff(path, table, place)
    return _tile(raster, table, place)


def read_npy(path: Path, table: TerrainTable, place: str) -> Raster:
    """A plain array knows neither pixel nor unit: the scenario must."""
    if table.pixel is None:
        raise ScenarioError(f"{place}: a .npy file does not say how far its nodes are apart; add terrain.pixel in m")
    _require_metres(table.unit, f"{place}: the heights", "a .npy file does not say")
    try:
        given = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        said = "" if "pickle" in str(error) else f" ({error})"
        raise ScenarioError(f"{place}: is no .npy file of numbers{said}; write it with numpy.save") from None
    if not isinstance(given, np.ndarray) or given.ndim != 2 or given.dtype.kind not in "fiu":
        shape = f"{given.dtype} of shape {given.shape}" if isinstance(given, np.ndarray) else "several arrays"
        raise ScenarioError(f"{place}: holds {shape}, expects numbers in rows and columns; save one array of heights")
    north, east = table.pixel if isinstance(table.pixel, list) else (table.pixel, table.pixel)
    if not min(north, east) > 0.0:
        raise ScenarioError(f"{place}: terrain.pixel = {table.pixel}: expects more than 0 m; give the distance between nodes")
    return Raster(given.astype(np.float64), 0.0, (given.shape[0] - 1) * north, north, east)


def read_geotiff(path: Path, table: TerrainTable, place: str) -> Raster:
    """One band of heights; georeference, unit, scale and missing values as rasterio understands them."""
    try:
        import rasterio
        from rasterio.errors import RasterioError
    except ImportError:
        raise ScenarioError(f"{place}: needs rasterio to be read: pip install 'rasterio>=1.4,<2', or give a .npy file") from None
    try:
        with rasterio.open(path) as source:
            return _geotiff(source, table, place)
    except RasterioError as error:
        raise ScenarioError(f"{place}: cannot be read ({' '.join(str(error).split())}); give a GeoTIFF or .npy file") from None


def _geotiff(source: Any, table: TerrainTable, place: str) -> Raster:
    if table.pixel is not None:
        raise ScenarioError(f"{place}: terrain.pixel is for .npy files, this one says itself; remove it")
    if source.count != 1:
        raise ScenarioError(f"{place}: has {source.count} bands, expects 1; write the heights as a file of their own")
    _check_coordinates(source.crs, table, place)
    t = source.transform
    if t.b != 0.0 or t.d != 0.0 or not (t.a > 0.0 > t.e):
        raise ScenarioError(f"{place}: its rows do not run from north to south and its columns from west to east; rewrite it so (gdalwarp)")
    _require_metres(_height_unit(source, table), f"{place}: the heights", "the file does not say")
    values = source.read(1, masked=True).astype(np.float64) * source.scales[0] + source.offsets[0]
    return Raster(np.ma.filled(values, np.nan), t.c + 0.5 * t.a, t.f + 0.5 * t.e, -t.e, t.a)


def _check_coordinates(crs: Any, table: TerrainTable, place: str) -> None:
    if crs is None:
        _require_metres(table.unit, f"{place}: the pixels", "the file has no coordinate system")
        return
    if crs.is_geographic:
        raise ScenarioError(f"{place}: its pixels are in degrees, expects metres; project it first (gdalwarp -t_srs ...)")
    name, factor = crs.linear_units_factor
    if factor != 1.0:
        raise ScenarioError(f"{place}: its pixels are in {name} ({factor:g} m), expects metres; project it to metres (gdalwarp -t_srs ...)")


def _height_unit(source: Any, table: TerrainTable) -> str | None:
    """The band's own unit, else that of the vertical coordinate system, else what the scenario says."""
    vertical = _VERTICAL.search(source.crs.to_wkt()) if source.crs is not None else None
    of_system = None if vertical is None else "m" if float(vertical[2]) == 1.0 else vertical[1]
    return source.units[0] or of_system or table.unit


def _require_metres(unit: str | None, what: str, silent: str) -> None:
    if unit is None:
        raise ScenarioError(f'{what} may be in any unit, {silent}; add terrain.unit = "m" if they are in metres')
    if unit.strip().lower() not in METRES:
        raise ScenarioError(f'{what} are in "{unit}", expects "m"; convert them to metres')


def _tile(raster: Raster, table: TerrainTable, place: str) -> HeightMap:
    """What lies within `extent` of the origin, first row southmost, heights over that of the node nearest to the origin that has one."""
    rows, columns = raster.heights.shape
    south = raster.north - (rows - 1) * raster.pixel_north
    far = raster.west + (columns - 1) * raster.pixel_east
    if min(rows, columns) < FEWEST:
        raise ScenarioError(f"{place}: has {rows} rows and {columns} columns, expects at least {FEWEST} of each; give a larger map")
    east, north = table.origin or (0.5 * (raster.west + far), 0.5 * (south + raster.north))
    if not (raster.west <= east <= far and south <= north <= raster.north):
        raise ScenarioError(
            f"{place}: terrain.origin = [{east:g}, {north:g}] is outside the map, which reaches from {raster.west:g} to {far:g} m east and"
            f" from {south:g} to {raster.north:g} m north; choose a place on it"
        )
    norths = south + raster.pixel_north * np.arange(rows) - north
    easts = raster.west + raster.pixel_east * np.arange(columns) - east
    margin = table.extent + 2.0 * max(raster.pixel_north, raster.pixel_east)
    i, j = np.nonzero(np.abs(norths) <= margin)[0], np.nonzero(np.abs(easts) <= margin)[0]
    heights = raster.heights[::-1][i[0] : i[-1] + 1, j[0] : j[-1] + 1].copy()
    heights[~np.isfinite(heights)] = np.nan
    if min(heights.shape) < FEWEST:
        raise ScenarioError(f"{place}: has {heights.shape} nodes within terrain.extent = {table.extent:g} m; give a finer map")
    if np.isnan(heights).all():
        raise ScenarioError(f"{place}: has no value within {table.extent:g} m of the origin; choose another origin")
    away = np.where(np.isnan(heights), np.inf, np.hypot(norths[i][:, None], easts[j]).round(9))  # so that a tie is one
    datum = heights.flat[int(np.argmin(away))]
    return HeightMap(heights - datum, float(norths[i[0]]), float(easts[j[0]]), raster.pixel_north, raster.pixel_east)
