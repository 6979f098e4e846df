"""Failure measures from recorded columns: margins change sign exactly at the limit, and what was not recorded is left out."""

import math

import numpy as np
import pytest
from results_samples import LEGS, TABLE, landing
from rich.console import Console

from orchestrator.results.channels import Channels
from orchestrator.results.failure import failure
from orchestrator.results.geometry import ground_plane
from orchestrator.results.margins import margins
from orchestrator.results.schema import ResultsTable

NAMES = ResultsTable.model_validate(TABLE | {"lowest": {"height_above_pads": 0.5, "radius": 0.75}})
AZIMUTHS = {"+Z": 0.0, "+Y": 90.0, "-Z": 180.0, "-Y": 270.0}
LIMITS = {"primary_limit": 0.812, "compression_limit": 0.305, "tension_limit": 0.407, "origin_height": 3.62}


def parameters(slope: float = 0.0) -> dict[str, float]:
    given = {f"leg{leg}.{name}": value for leg in LEGS for name, value in LIMITS.items()}
    given |= {f"soil{leg}.{name}": value for leg in LEGS for name, value in (("ground_slope", slope), ("ground_azimuth", 0.0))}
    given |= {f"body.inertia[{i}]": value for i, value in ((1, 16492.0), (2, 17409.0), (3, 20800.0))}
    return given | {"body.mass": 7063.5, "body.gravity": 1.63}


def standing(height: float = 3.62, **changes: np.ndarray) -> Channels:
    """The made-up landing on a body that stands level, pads 4.242 m out."""
    result = landing()
    n = len(result.times)
    columns = dict(result.columns)
    for leg, azimuth in AZIMUTHS.items():
        place = (0.1, 4.242 * math.sin(math.radians(azimuth)), 4.242 * math.cos(math.radians(azimuth)))
        columns |= {f"leg{leg}.pad.position[{i + 1}]": np.full(n, x) for i, x in enumerate(place)}
    still = {"position": (height, 0.0, 0.0), "velocity": (0.0,) * 3, "quaternion": (1.0, 0.0, 0.0, 0.0), "angular_velocity": (0.0,) * 3}
    columns |= {f"body.body.{name}[{i + 1}]": np.full(n, x) for name, vector in still.items() for i, x in enumerate(vector)}
    return Channels(result.times, columns | changes)


def test_a_vehicle_that_stands_has_all_its_margins():
    found = failure(standing(), NAMES, parameters())
    assert found["failed"] == []
    assert found["tip_over"]["tipped"] is False
    assert found["tip_over"]["decided"] is True
    assert found["tip_over"]["least_angle_deg"] == pytest.approx(math.degrees(math.atan(4.242 / math.sqrt(2.0) / 3.52)))
    assert found["clearance"]["margin_m"] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("name", "strut", "sign", "limit"),
    [("primary_stroke", "primary", 1.0, 0.812), ("secondary_compression", "right", -1.0, 0.305), ("secondary_tension", "left", 1.0, 0.407)],
)
@pytest.mark.parametrize("beyond", [-1e-9, 1e-9])
def test_a_stroke_fails_exactly_at_its_limit(name, strut, sign, limit, beyond):
    times = landing().times
    course = np.where(times < 1.0, 0.0, sign * (limit + beyond))
    columns = {f"leg-Z.{strut}.stroke": course, f"leg-Z.{strut}.peak_stroke": np.maximum.accumulate(course)}
    found = failure(standing(**columns), NAMES, parameters())
    assert found[name]["strut"] == f"-Z.{strut}"
    assert found[name]["margin_m"] == pytest.approx(-beyond, abs=1e-12)
    assert (name in found["failed"]) is (beyond > 0.0)


def test_compression_of_a_secondary_is_not_taken_for_tension():
    times = landing().times
    both = {f"leg-Z.right.{name}": np.full_like(times, -0.2) for name in ("stroke", "peak_stroke")}
    found = failure(standing(**both), NAMES, parameters())
    assert found["secondary_compression"]["peak_m"] == 0.2
    assert found["secondary_tension"]["peak_m"] < 0.05


def test_a_primary_that_stroked_further_between_rows_is_believed():
    times = landing().times
    found = failure(standing(**{"leg-Z.primary.peak_stroke": np.full_like(times, 0.7)}), NAMES, parameters())
    assert found["primary_stroke"]["margin_m"] == pytest.approx(0.112)


@pytest.mark.parametrize("slope", [0.0, math.radians(12.0)])
def test_the_nozzle_strikes_where_its_rim_meets_the_ground(slope):
    """Over ground that rises toward +Z by the slope, under an upright body: the rim's +Z point is nearest."""
    touching = 3.62 - 0.5 + 0.75 * math.tan(slope)
    for above in (1e-9, -1e-9):
        found = failure(standing(touching + above), NAMES, parameters(slope))
        assert found["clearance"]["margin_m"] == pytest.approx(above * math.cos(slope), abs=1e-12)
        assert ("clearance" in found["failed"]) is (above < 0.0)


def test_soils_in_different_planes_have_no_ground_plane():
    assert ground_plane(NAMES, parameters() | {"soil+Z.ground_slope": 0.1}) is None
    assert failure(standing(), NAMES, parameters() | {"soil+Z.ground_slope": 0.1})["clearance"] is None


@pytest.mark.parametrize("name", ["terrain.map", "terrain.craters[3]", "terrain.boulders[3]"])
def test_over_a_relief_no_clearance_is_claimed(name):
    assert failure(standing(), NAMES, parameters() | {f"soil+Z.{name}": 1.0})["clearance"] is None
    assert failure(standing(), NAMES, parameters() | {f"soil+Z.{name}": 0.0})["clearance"] is not None


def test_the_twins_parameters_are_one_element_a_leg():
    legs = {leg: {"leg": f"lander.leg{k}", "soil": f"lander.soil{k}"} for k, leg in enumerate(LEGS, start=1)}
    given = {f"lander.soil.ground_{name}[{k}]": value for k in range(1, 5) for name, value in (("slope", 0.2), ("azimuth", 0.0))}
    plane = ground_plane(ResultsTable.model_validate({"body": "lander", "legs": legs}), given)
    assert plane is not None
    assert plane[1] == pytest.approx([math.cos(0.2), 0.0, -math.sin(0.2)])


def test_peak_loads_name_where_they_were():
    loads = failure(standing(), NAMES, parameters())["peak_loads"]
    assert loads["secondary"]["load_N"] == pytest.approx(6000.0, rel=1e-3)
    assert loads["secondary"]["at"].endswith(".left")
    assert loads["pad"]["load_N"] == pytest.approx(landing().columns[f"soil{loads['pad']['at']}.normal_force"].max())


def test_without_positions_there_is_no_tip_over_and_without_parameters_no_energy():
    result = landing()
    assert failure(Channels(result.times, result.columns), NAMES, parameters())["tip_over"] is None
    found = failure(standing(), NAMES, {})
    assert found["tip_over"]["least_energy_margin_J"] is None
    assert found["tip_over"]["tipped"] is False
    assert found["primary_stroke"] is None
    assert found["failed"] == []


def test_a_run_without_rows_fails_at_nothing():
    empty = landing(rows=0)
    assert failure(Channels(empty.times, empty.columns), NAMES, parameters())["failed"] == []


def test_a_person_reads_what_is_left():
    console = Console(width=120, record=True)
    console.print(margins(failure(standing(), NAMES, parameters())))
    text = console.export_text()
    assert "secondary compression" in text
    assert "40.4 deg" in text


def test_where_it_goes_over_the_first_row_beyond_counts_and_strokes_afterwards_do_not():
    times = landing().times
    outward = np.where(times < 1.0, 0.0, 8.0)  # m, all of a sudden far beyond the edges at +Y
    late = np.where(times < 2.0, 0.0, 0.9)
    changed = {"body.body.position[2]": outward, "leg-Z.primary.stroke": late, "leg-Z.primary.peak_stroke": late}
    found = failure(standing(**changed), NAMES, parameters())
    assert found["failed"] == ["tip_over"]
    assert found["tip_over"]["at_s"] == pytest.approx(1.0, abs=0.003)
    assert found["tip_over"]["decided"] is True
    assert "+Y" in found["tip_over"]["edge"]
    assert found["primary_stroke"]["peak_m"] < 0.1
