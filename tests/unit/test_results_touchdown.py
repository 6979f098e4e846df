"""The landing's numbers from recorded columns, and what happens where columns are missing."""

import math

import numpy as np
import pytest
from results_samples import LEGS, TABLE, landing

from orchestrator.results.channels import Channels
from orchestrator.results.schema import ResultsTable
from orchestrator.results.touchdown import contact_time, touchdown

NAMES = ResultsTable.model_validate(TABLE)


def summed_up(columns=None, **changes):
    result = landing()
    channels = Channels(result.times, (result.columns if columns is None else columns) | changes)
    return touchdown(channels, NAMES), channels


def test_contacts_are_the_times_the_soils_report():
    summary, _ = summed_up()
    assert summary["contact_times_s"] == LEGS


def test_a_soil_that_was_never_touched_has_no_contact_time():
    result = landing()
    never = {"soil-Y.contact_time": np.full_like(result.times, -1.0)}
    assert contact_time(Channels(result.times, result.columns | never), "soil-Y") is None


def test_without_contact_times_the_gap_tells():
    times = np.array([0.0, 0.1, 0.2])
    assert contact_time(Channels(times, {"soil.gap": np.array([0.2, 0.0, -0.1])}), "soil") == 0.1


def test_rates_and_angles_come_out_in_degrees():
    summary, _ = summed_up()
    assert summary["final_attitude_deg"] == pytest.approx({"yaw": 13.0, "pitch": 4.0, "roll": -1.0}, abs=1e-3)
    low, high = summary["peak_rates_deg_s"]["roll"]
    moment = math.atan2(6.0, 3.0) / 6.0  # where sin(6 t) exp(-3 t) is greatest
    assert low == pytest.approx(-8.5 * math.sin(6.0 * moment) * math.exp(-3.0 * moment), rel=1e-5)
    assert high > 0.0


def test_strokes_are_those_at_rest_and_peaks_stand_beside_them():
    times = landing().times
    springs_back = np.where(times < times[-1], 0.05, 0.03)
    summary, _ = summed_up(**{"leg+Z.left.stroke": springs_back, "leg+Z.left.peak_stroke": np.full_like(times, 0.051)})
    assert summary["strokes_m"]["+Z.left"] == 0.03
    assert summary["peak_strokes_m"]["+Z.left"] == 0.051


def test_keys_name_legs_and_struts():
    summary, _ = summed_up()
    assert list(summary["strokes_m"])[:3] == ["+Z.primary", "+Z.right", "+Z.left"]
    assert len(summary["strokes_m"]) == 12


def test_a_vehicle_that_came_to_rest_on_its_pads_stands():
    assert summed_up()[0]["stable"] is True


@pytest.mark.parametrize(
    ("column", "value"),
    [("body.rates.yaw", math.radians(1.1)), ("body.attitude.pitch", math.radians(46.0)), ("leg+Z.left.load", math.nan)],
    ids=["still turning", "tipped", "not finite"],
)
def test_a_vehicle_does_not_stand_that_is(column, value):
    times = landing().times
    assert summed_up(**{column: np.full_like(times, value)})[0]["stable"] is False


def test_a_vehicle_at_rest_on_three_pads_stands_and_a_moving_one_does_not():
    times = landing().times
    lifted = {"soil-Y.contact": np.zeros_like(times)}
    moving = lifted | {"body.body.velocity[2]": np.full_like(times, 0.06)}
    assert summed_up(**lifted)[0]["stable"] is True
    assert summed_up(**moving)[0]["stable"] is False


def test_missing_columns_give_none_and_are_named():
    columns = landing().columns
    kept = {name: column for name, column in columns.items() if not name.startswith(("soil-Z.", "body.rates."))}
    summary, channels = summed_up(kept)
    assert summary["penetration_m"]["-Z"] is None
    assert summary["contact_times_s"]["-Z"] is None
    assert summary["peak_rates_deg_s"]["pitch"] == [None, None]
    assert summary["stable"] is None
    assert {"soil-Z.penetration", "soil-Z.skid", "body.rates.pitch"} <= set(channels.missing)


def test_a_strut_that_reached_its_limit_once_has_bottomed():
    times = landing().times
    summary, _ = summed_up(**{"leg+Z.bottomed": (times > 0.1) & (times < 0.2), "leg-Z.bottomed": times < 0.0})
    assert summary["bottomed"] == {"+Z": True, "-Z": False, "+Y": None, "-Y": None}


def test_a_vehicle_in_one_fmu_is_summed_up_like_one_in_many():
    result, apart = landing(), summed_up()[0]
    numbers = {leg: i for i, leg in enumerate(LEGS, 1)}
    renamed = {}
    for name, column in result.columns.items():
        unit, _, variable = name.partition(".")
        leg = unit[-2:]
        renamed["lander." + (variable if unit == "body" else f"{unit[:-2]}{numbers[leg]}.{variable}")] = column
    legs = {leg: {"leg": f"lander.leg{i}", "soil": f"lander.soil{i}"} for leg, i in numbers.items()}
    together = touchdown(Channels(result.times, renamed), ResultsTable.model_validate({"body": "lander", "legs": legs}))
    assert together == apart
