"""From a landing's course to a white residual."""

import numpy as np
import pytest

from orchestrator.diagnosis.landing import RATES, SPIN, TELEMETRY, TELEMETRY_SLOPES, Course
from orchestrator.diagnosis.observation import EDGE, Observation, Reading, sampled

COURSE = Course(np.array([0.0, 1.0]), {}, {"skid": 0.2})


def missed(low: float, high: float) -> float:
    one = Observation([], [Reading("skid.+Y", "skid", np.nan, 1.0, low, high, True)])
    return float(one.residual(one.predicted(COURSE, {}))[0])


def test_an_interval_counts_outside_its_ends_only() -> None:
    assert missed(0.1, 0.3) == 0.0
    assert missed(0.0, 0.1) == pytest.approx(-0.1 / (EDGE * 0.1))
    assert missed(0.3, 0.5) == pytest.approx(0.1 / (EDGE * 0.2))


def test_an_interval_open_to_one_side_counts_too() -> None:
    assert missed(-np.inf, 0.1) == pytest.approx(-0.1 / (EDGE * 0.1))
    assert missed(0.3, np.inf) == pytest.approx(0.1 / (EDGE * 0.3))
    assert missed(0.1, np.inf) == 0.0


@pytest.mark.parametrize(("column", "slope"), [*zip(RATES, SPIN, strict=True), *zip(TELEMETRY, TELEMETRY_SLOPES, strict=True)])
def test_rates_between_the_points_of_a_course_follow_their_slopes(column: str, slope: str) -> None:
    """Telemetry read by straight lines moved a fit's φ by 11 where the data's clock moved by 1 ms."""
    grid = np.arange(0.0, 1.0, 0.02)
    course = Course(grid, {column: np.sin(8.0 * grid), slope: 8.0 * np.cos(8.0 * grid)}, {})
    times = grid[1:-1] + 0.001
    cubic = 8.0**4 * 0.02**4 / 384.0  # the bound of a cubic by values and slopes
    assert sampled(course, column, times) == pytest.approx(np.sin(8.0 * times), abs=cubic)
    straight = np.interp(times, grid, course.columns[column])
    assert np.abs(straight - np.sin(8.0 * times)).max() > 100.0 * cubic, "or the test sees nothing"
