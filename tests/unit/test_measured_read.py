"""A folder of measured data: read as written, and refused in one line."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from orchestrator.diagnosis.measured import Measured, Prior, Scalar, Series, read_measured, write_measured
from orchestrator.errors import MeasuredError

TOML = """
title = "A landing"
source = "a test"
[series.rates]
file = "rates.csv"
unit = "deg/s"
sigma = 0.1
colour = 0.3
[series.attitude]
file = "attitude.csv"
unit = "rad"
sigma = 0.0009
[values]
"stroke.+Z.left" = { value = 4.0, sigma = 0.25, unit = "in" }
"penetration.+Y" = { low = 0.020, high = 0.0762, unit = "m" }
"skid.+Y" = { low = 1.0, unit = "cm" }
"peak.rates.roll" = { value = -3.0, sigma = 0.5, unit = "deg/s" }
[prior]
attitude = { mean = [0.26, 0.01, 0.04], sigma = 0.0035, unit = "rad" }
"soil.bearing_strength" = { mean = 350254.0, sigma_log = 0.12 }
"""
RATES = "roll_rate, time_s ,pitch_rate,yaw_rate\n# a remark\n3,0.0,2,1\n6,0.1,,4\n9,0.25,nan,7\n"
ATTITUDE = "time_s,yaw,pitch,roll\n5e7,0.1,0.2,0.3\n50000000.5,0.4,0.5,0.6\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "landing.toml").write_text(TOML)
    (tmp_path / "rates.csv").write_text(RATES)
    (tmp_path / "attitude.csv").write_text(ATTITUDE)
    return tmp_path


def test_columns_in_any_order_become_channels_in_SI(folder: Path) -> None:
    rates = read_measured(folder).series[0]
    assert rates.channels == ("rates.yaw", "rates.pitch", "rates.roll")
    np.testing.assert_allclose(np.degrees(rates.values[:, [0, 2]]), [[1, 3], [4, 6], [7, 9]])
    np.testing.assert_allclose(rates.sigma, np.radians(0.1))
    assert rates.colour == 0.3
    assert rates.times.tolist() == [0.0, 0.1, 0.25]


def test_a_gap_is_masked(folder: Path) -> None:
    rates = read_measured(folder).series[0]
    assert rates.mask.tolist() == [[True, True, True], [True, False, True], [True, False, True]]


def test_a_colour_that_is_not_stated_is_to_be_estimated_and_times_stay_as_they_are(folder: Path) -> None:
    attitude = read_measured(folder).series[1]
    assert attitude.colour is None
    assert attitude.times.tolist() == [5e7, 5e7 + 0.5]


def test_values_are_points_or_intervals_in_SI(folder: Path) -> None:
    stroke, penetration, skid, peak = read_measured(folder).values
    assert (stroke.kind, stroke.value, stroke.unit) == ("value", pytest.approx(0.1016), "m")
    assert stroke.sigma == pytest.approx(0.00635)
    assert (penetration.kind, penetration.low, penetration.high) == ("interval", 0.020, 0.0762)
    assert (skid.low, skid.high) == (0.01, np.inf)
    assert peak.value == pytest.approx(np.radians(-3.0))


def test_a_prior_has_a_sigma_or_a_sigma_of_its_logarithm(folder: Path) -> None:
    attitude, strength = read_measured(folder).prior
    assert attitude.sigma is not None
    assert attitude.sigma.tolist() == [0.0035] * 3
    assert attitude.sigma_log is None
    assert strength.sigma is None
    assert strength.sigma_log is not None
    assert strength.sigma_log.tolist() == [0.12]


def test_any_output_of_a_unit_may_be_a_channel(folder: Path) -> None:
    table = '[series.struts]\nfile = "struts.csv"\nunit = { "leg+Z.primary.load" = "lbf", "body.body.position[1]" = "ft" }\nsigma = 1.0\n'
    (folder / "landing.toml").write_text(table)
    (folder / "struts.csv").write_text("time_s,leg+Z.primary.load,body.body.position[1]\n0,1000,10\n")
    struts = read_measured(folder).series[0]
    assert struts.channels == ("leg+Z.primary.load", "body.body.position[1]")
    np.testing.assert_allclose(struts.values[0], [4448.2216152605, 3.048])
    assert struts.unit == ("N", "m")


def test_columns_say_which_of_the_file_are_used(folder: Path) -> None:
    (folder / "landing.toml").write_text(TOML.replace('"rates.csv"', '"rates.csv"\ncolumns = ["roll_rate"]'))
    assert read_measured(folder).series[0].channels == ("rates.roll",)


def test_what_is_written_is_read_back_to_the_last_bit(tmp_path: Path) -> None:
    values = np.random.default_rng(1).normal(size=(5, 2))
    values[2, 1] = np.nan
    series = Series("rates", ("rates.yaw", "rates.roll"), np.cumsum(np.full(5, 0.1)), values, np.array([1e-3, 2e-3]), None, ("rad/s",) * 2)
    load = Series("loads", ("leg+Z.primary.load",), np.arange(5.0), values[:, :1], np.array([3.0]), 0.5, ("N",))
    scalars = [Scalar("stroke.+Z.left", "value", 0.1, 0.01, 0.1, 0.1, "m"), Scalar("skid.-Y", "interval", 0.375, 0.0, 0.25, 0.5, "m")]
    rates = Prior("rates", np.array([0.1, 0.2, 0.3]), np.full(3, 0.01), None, "rad/s")
    priors = [rates, Prior("mass", np.array([7e3]), None, np.array([0.1]))]
    written = Measured("a title", "a source", tmp_path, [series, load], scalars, priors)
    write_measured(tmp_path, written)
    read = read_measured(tmp_path)
    for one, other in zip(read.series, written.series, strict=True):
        assert replace(one, times=0, values=0, sigma=0) == replace(other, times=0, values=0, sigma=0)  # type: ignore[arg-type]
        np.testing.assert_array_equal(one.times, other.times)
        np.testing.assert_array_equal(one.values, other.values)
        np.testing.assert_array_equal(one.sigma, other.sigma)
    assert read.values == written.values
    assert [str(p) for p in read.prior] == [str(p) for p in written.prior]


LANDING, RATES_FILE, ATTITUDE_FILE = "landing.toml", "rates.csv", "attitude.csv"


@pytest.mark.parametrize(
    ("file", "old", "new", "says"),
    [
        (LANDING, 'file = "rates.csv"', 'file = "rate.csv"', "rate.csv: no such file"),
        (RATES_FILE, "pitch_rate", "pich_rate", 'has no column "pitch_rate"; did you mean "pich_rate"?'),
        (RATES_FILE, "roll_rate,", "rol,", 'has no column "roll_rate"'),
        (RATES_FILE, "time_s", "seconds", 'has no column "time_s"'),
        (ATTITUDE_FILE, ",roll", ",pitch", 'column "pitch" stands there 2 times'),
        (ATTITUDE_FILE, ",roll\n", ",roll,extra\n", "holds 4 cells, the header 5"),
        (LANDING, '"deg/s"\nsigma', '"dge/s"\nsigma', 'unit "dge/s" is not known; did you mean "deg/s"?'),
        (LANDING, '"deg/s"\nsigma', '"furlong"\nsigma', 'unit "furlong" is not known; known here: deg/s, rad/s'),
        (LANDING, '"deg/s"\nsigma', '"deg"\nsigma', "is in deg, expects rad/s"),
        (RATES_FILE, "0.25", "0.1", "goes from 0.1 s to 0.1 s at sample 3, expects rising times"),
        (RATES_FILE, "0.25", "", "sample 3: time_s is empty"),
        (LANDING, "sigma = 0.1", "sigma = 0.0", "series.rates.sigma = 0.0: input should be greater than 0"),
        (LANDING, "sigma = 0.1", "sigma = -1.0", "series.rates.sigma = -1.0"),
        (LANDING, "sigma = 0.1", "sigma = nan", "series.rates.sigma = nan"),
        (LANDING, "sigma = 0.25", "sigma = 0.0", "values.stroke.+Z.left.sigma = 0.0"),
        (LANDING, "high = 0.0762", "high = 0.01", "values.penetration.+Y: low 0.02 is not below high 0.01"),
        (LANDING, "high = 0.0762", "value = 0.01", "values.penetration.+Y: give either value and sigma, or low and high"),
        (LANDING, "colour", "color", 'series.rates.color: unknown key; did you mean "colour"?'),
        (LANDING, "source", "sources", 'sources: unknown key; did you mean "source"?'),
        (LANDING, "[prior]", "[priors]", 'priors: unknown key; did you mean "prior"?'),
        (LANDING, "colour = 0.3", "colour = 1.0", "series.rates.colour"),
        (LANDING, "colour = 0.3", "colour = ", "not valid TOML"),
        (LANDING, "sigma_log = 0.12", "sigma_log = 0.12, sigma = 1.0", "give either sigma or sigma_log"),
        (LANDING, "mean = 350254.0", "mean = -1.0", "sigma_log needs a mean above zero"),
        (LANDING, "stroke.+Z.left", "stroke.+Z.lift", "expects stroke.LEG.STRUT"),
        (LANDING, "penetration.+Y", "penetraton", "is no scalar; did you mean"),
        (RATES_FILE, "6,0.1,,4", "6,0.1,,x4", 'rates.csv line 4: yaw_rate = "x4": is no number'),
        (RATES_FILE, "6,0.1,,4", "6,0.1,,inf", 'rates.csv line 4: yaw_rate = "inf": is not finite'),
        (RATES_FILE, "3,0.0,2,1", "3,0.0,,1", "column pitch_rate holds no number at all"),
        (RATES_FILE, RATES, "time_s\n", "holds 1 lines, expects a header and samples"),
        (LANDING, TOML, 'title = "nothing"', "holds no data"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_in_one_line(folder: Path, file: str, old: str, new: str, says: str) -> None:
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new, 1))
    with pytest.raises(MeasuredError) as error:
        read_measured(folder)
    message = str(error.value)
    assert says in message
    assert "\n" not in message
    assert error.value.exit_code == 2


def test_a_folder_that_is_not_there_or_has_no_landing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MeasuredError, match="no such folder"):
        read_measured(tmp_path / "nowhere")
    with pytest.raises(MeasuredError, match=r"holds no landing\.toml"):
        read_measured(tmp_path)


def test_one_channel_stands_in_one_series_only(folder: Path) -> None:
    (folder / LANDING).write_text(TOML + '[series.again]\nfile = "rates.csv"\nunit = "rad/s"\nsigma = 1.0\n')
    with pytest.raises(MeasuredError, match=r"rates\.yaw is also in series\.rates"):
        read_measured(folder)
