"""`[terrain]`: what is taken from a GeoTIFF or NumPy file, and one line for each that cannot be used."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from orchestrator.errors import ScenarioError
from orchestrator.master.slave import Interface, Kind, Variable
from orchestrator.scenario.read import check_table
from orchestrator.terrain.hand_over import terrain_values
from orchestrator.terrain.height_map import HeightMap, read_height_map
from orchestrator.terrain.table import TerrainTable

MOON = "+proj=eqc +lat_ts=0 +lat_0=0 +lon_0=0 +x_0=0 +y_0=0 +a=1737400 +b=1737400 +units=m +no_defs"
FEET = MOON.replace("units=m", "units=us-ft")
DEGREES = "+proj=longlat +a=1737400 +b=1737400 +no_defs"
HEIGHTS = np.arange(12.0 * 9.0).reshape(12, 9)


def geotiff(path: Path, crs: str | None = MOON, unit: str | None = "metre", heights: Any = HEIGHTS, **profile: Any) -> Path:
    """Pixels of 2 m, the corner of the north-westmost at (1000, 5000)."""
    rasterio = pytest.importorskip("rasterio")
    transform = profile.pop("transform", None) or rasterio.transform.from_origin(1000.0, 5000.0, 2.0, 2.0)
    system = None if crs is None else rasterio.crs.CRS.from_string(crs)
    shape = {"height": heights.shape[0], "width": heights.shape[1], "count": 1, "dtype": "float64"}
    with rasterio.open(path, "w", driver="GTiff", crs=system, transform=transform, **(shape | profile)) as file:
        file.write(heights, 1)
        if unit:
            file.units = (unit,) * file.count
    return path


def read(path: Path, **keys: Any) -> HeightMap:
    return read_height_map(TerrainTable(file=str(path), **keys), "case.toml")


def npy(folder: Path, heights: Any = HEIGHTS) -> Path:
    np.save(folder / "map.npy", heights)
    return folder / "map.npy"


def test_a_geotiff_and_a_numpy_file_of_the_same_heights_are_the_same_map(tmp_path: Path) -> None:
    """The first node is the south-westmost; heights are over the origin's; nodes are the pixels' middles."""
    of_tiff = read(geotiff(tmp_path / "site.tif"), origin=[1009.0, 4987.0])
    of_array = read(npy(tmp_path), pixel=2.0, unit="m", origin=[8.0, 10.0])
    for one in (of_tiff, of_array):
        assert (one.north, one.east, one.step_north, one.step_east) == (-10.0, -8.0, 2.0, 2.0)
        assert np.array_equal(one.heights, HEIGHTS[::-1] - HEIGHTS[6, 4])


def test_without_an_origin_the_middle_is_taken_and_only_its_surroundings_are_kept(tmp_path: Path) -> None:
    cut = read(npy(tmp_path, np.zeros((101, 201))), pixel=[1.0, 2.0], unit="m", extent=10.0)
    assert cut.heights.shape == (29, 15)
    assert (cut.north, cut.east) == (-14.0, -14.0)


def test_missing_values_scale_and_offset_of_a_geotiff_are_heeded(tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    path = geotiff(tmp_path / "site.tif", heights=np.where(HEIGHTS == 14.0, -9999.0, HEIGHTS), nodata=-9999.0)
    with rasterio.open(path, "r+") as file:
        file.scales, file.offsets = (0.5,), (100.0,)
    heights = read(path).heights
    assert np.isnan(heights[10, 5])
    assert np.isnan(heights).sum() == 1
    assert heights[0, 1] - heights[0, 0] == 0.5


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"crs": DEGREES}, "its pixels are in degrees, expects metres"),
        ({"crs": FEET}, "its pixels are in US survey foot (0.304801 m), expects metres"),
        ({"unit": "ft"}, 'the heights are in "ft", expects "m"'),
        ({"unit": None}, 'the heights may be in any unit, the file does not say; add terrain.unit = "m"'),
        ({"crs": None}, "the pixels may be in any unit, the file has no coordinate system"),
        ({"heights": HEIGHTS[:3]}, "has 3 rows and 9 columns, expects at least 4 of each"),
        ({"heights": np.full((9, 9), np.nan)}, "has no value within 30 m of the origin"),
        ({"count": 2}, "has 2 bands, expects 1"),
    ],
)
def test_a_geotiff_that_cannot_be_used_is_refused_in_one_line(tmp_path: Path, given: dict[str, Any], told: str) -> None:
    with pytest.raises(ScenarioError, match=r"terrain\.file = site\.tif") as error:
        read(geotiff(tmp_path / "site.tif", **given))
    assert told in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("keys", "told"),
    [
        ({"unit": "m"}, "a .npy file does not say how far its nodes are apart; add terrain.pixel in m"),
        ({"pixel": 1.0}, 'the heights may be in any unit, a .npy file does not say; add terrain.unit = "m"'),
        ({"pixel": 1.0, "unit": "ft"}, 'the heights are in "ft", expects "m"'),
        ({"pixel": 1.0, "unit": "m", "origin": [50.0, 3.0]}, "origin = [50, 3] is outside the map, which reaches from 0 to 8 m east"),
    ],
)
def test_a_numpy_file_that_cannot_be_used_is_refused_in_one_line(tmp_path: Path, keys: dict[str, Any], told: str) -> None:
    with pytest.raises(ScenarioError) as error:
        read(npy(tmp_path), **keys)
    assert told in str(error.value)


@pytest.mark.parametrize("content", [np.zeros(5), np.array([["a"]]), np.zeros((3, 4, 5))])
def test_an_array_that_is_no_table_of_numbers_is_refused(tmp_path: Path, content: Any) -> None:
    with pytest.raises(ScenarioError, match="expects numbers in rows and columns"):
        read(npy(tmp_path, content), pixel=1.0, unit="m")


def ground_unit() -> Interface:
    names = ["terrain.heading", "terrain.reach", *(f"terrain.craters[{i}]" for i in range(1, 11))]
    variables = {name: Variable(name, causality="parameter", unit="m") for name in names}
    return Interface("Soil", variables | {"terrain.map": Variable("terrain.map", Kind.STRING, "parameter")})


def test_craters_reach_every_unit_on_the_ground_with_the_depth_of_a_fresh_one() -> None:
    table = TerrainTable.model_validate({"craters": [{"center": [1.0, 2.0], "diameter": 10.0}]})
    values = terrain_values(table, {"a": ground_unit(), "b": Interface("Body", {}), "c": ground_unit()}, "case.toml")
    assert list(values) == ["a", "c"]
    assert [values["a"][f"terrain.craters[{i}]"] for i in range(1, 6)] == pytest.approx([1.0, 2.0, 10.0, 1.96, 0.36])
    assert "terrain.map" not in values["a"]


def test_more_craters_than_a_unit_has_room_for_are_refused() -> None:
    table = TerrainTable.model_validate({"craters": [{"center": [1.0, 2.0], "diameter": 10.0}] * 3})
    with pytest.raises(ScenarioError, match=r"terrain.craters: 3 of them, Soil has room for 2"):
        terrain_values(table, {"a": ground_unit()}, "case.toml")


def test_a_terrain_without_a_unit_to_stand_on_it_is_refused() -> None:
    with pytest.raises(ScenarioError, match=r"no unit has a parameter terrain.map"):
        terrain_values(TerrainTable(), {"b": Interface("Body", {})}, "case.toml")


@pytest.mark.parametrize(
    ("terrain", "told"),
    [
        ({"fil": "a.tif"}, 'terrain.fil: unknown key; did you mean "file"?'),
        ({"craters": [{"center": [0.0, 0.0], "diametre": 1.0}]}, 'did you mean "diameter"?'),
        ({"craters": [{"center": [0.0, 0.0], "diameter": 1.0, "depth": 2.0}]}, "diameter 1 m, depth 2 m, rim 0.036 m; expects depth <="),
        ({"boulders": [{"center": [0.0, 0.0], "radius": 1.0, "height": 3.0}]}, "height 3 m of a ball of radius 1 m; expects at most 2 m"),
        ({"pixel": 1.0}, "has pixel, unit or origin but no file"),
    ],
)
def test_a_terrain_table_that_is_wrong_is_told_in_one_line(terrain: dict[str, Any], told: str) -> None:
    tree = {"stop_time": 1.0, "units": {"a": {"fmu": "A"}}, "terrain": terrain}
    with pytest.raises(ScenarioError) as error:
        check_table(tree, "case.toml")
    assert told in str(error.value)
