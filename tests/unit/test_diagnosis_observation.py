"""From a course to the numbers that were measured, and to white residuals."""

import numpy as np
import pytest
from diagnosis_samples import Line, Ringing, coordinate, one_landing, tracks

from orchestrator.diagnosis.landing import SPIN, Course
from orchestrator.diagnosis.noise import Noise
from orchestrator.diagnosis.observation import EDGE, ORIGIN, Observation, Reading, Track, sampled
from orchestrator.diagnosis.problem import Model

GRID = np.linspace(0.0, 2.0, 21)


def track(times: np.ndarray, column: str = "y", series: str = "s") -> Track:
    return Track(series, column, column, times, np.zeros(len(times)), 0.1, None)


def test_the_white_residual_changes_as_the_white_slopes_say() -> None:
    times = np.array([0.1, 0.2, 0.35, 0.9, 1.0])
    readings = [
        Reading("stroke", "a", 0.3, 0.02),
        Reading("below", "a", 0.5, 1.0, 0.4, 0.6, True),
        Reading("within", "a", 0.5, 1.0, -9.0, 9.0, True),
        Reading("at least", "a", np.nan, 1.0, 0.4, np.inf, True),
        Reading("at most", "a", np.nan, 1.0, -np.inf, 0.1, True),
        Reading("peak", "y", 0.5, 0.1, kind="peak"),
    ]
    landings = one_landing(tracks(Line(), {"a": 0.3, "b": 0.1}, ["y"], times, 0.1, 1), readings, {"a": 0.2, "b": 0.0})
    landings.observations[0].set_noise([Noise(0.1, 0.6, 0.1)])
    model = Model(landings, [coordinate("a"), coordinate("b")], Line())
    z = np.array([0.01, 0.02])
    at = model.predict(z)
    assert at is not None
    jacobian = model.whitened(model.slopes(z, at), at)
    for i, h in enumerate((1e-4, 1e-4)):
        moved = z.copy()
        moved[i] += h
        there = model.predict(moved)
        assert there is not None
        np.testing.assert_allclose((model.residual(at) - model.residual(there)) / h, jacobian[:, i], rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(
    ("low", "high", "value", "missed"),
    [
        (1.0, 2.0, 1.5, 0.0), (1.0, 2.0, 0.9, 0.1 / EDGE), (1.0, 2.0, 2.2, -0.2 / EDGE),
        (1.0, np.inf, 5.0, 0.0), (1.0, np.inf, 0.5, 0.5 / EDGE), (-np.inf, 2.0, 3.0, -1.0 / (2.0 * EDGE)), (-np.inf, 0.0, 2e-6, -2.0),
    ],
)  # fmt: skip
def test_an_interval_counts_outside_its_ends_only_and_so_does_a_single_bound(low: float, high: float, value: float, missed: float) -> None:
    one = Observation([], [Reading("r", "r", np.nan, 1.0, low, high, True)])
    assert one.residual(np.array([value]))[0] == pytest.approx(missed)


def test_the_grid_meets_every_sample_as_the_clocks_date_it() -> None:
    random = np.random.default_rng(0)
    times = np.sort(random.uniform(1000.0, 1001.9, 60))
    times = times[np.concatenate([[True], np.diff(times) > 2e-3])]
    one = Observation([track(times), track(times[::2] + 1e-4, "z", "other")], [])
    one.shift = 999.9
    values = {ORIGIN: 0.013, "clock.other": 0.05}
    grid = one.grid(2.0, values)
    assert (grid[0], grid[-1]) == (0.0, 2.0)
    assert (np.diff(grid) > 0.0).all()
    dated = times - 999.9 - 0.013
    assert max(np.abs(grid - t).min() for t in dated) < 1.1e-3
    assert sum(np.abs(grid - t).min() < 1e-9 for t in dated) > 0.9 * len(dated)


@pytest.mark.parametrize("rate", [1000.0, 2000.0, 20000.0])
def test_the_grid_of_fast_samples_is_thinned_and_not_emptied(rate: float) -> None:
    grid = Observation([track(np.arange(0.0, 1.0, 1.0 / rate))], []).grid(1.5, {})
    assert (grid[0], grid[-1]) == (0.0, 1.5)
    assert np.diff(grid[grid < 0.99]).max() < 3e-3
    assert np.diff(grid).min() > 0.99e-3


def test_a_clock_offset_moves_its_own_series_and_the_time_origin_all() -> None:
    times = np.linspace(0.2, 1.0, 9)
    one = Observation([track(times), track(times, "z", "other")], [])
    course = Course(GRID, {"y": GRID.copy(), "z": GRID.copy()}, {})
    both = one.predicted(course, {ORIGIN: 0.05, "clock.other": 0.1})
    np.testing.assert_allclose(both[:9], times - 0.05)
    np.testing.assert_allclose(both[9:], times - 0.15)


def test_several_datings_of_one_course_are_those_of_each() -> None:
    """To the bit: which dating a search takes must not depend on how many were asked for."""
    times = np.linspace(-0.3, 2.3, 11)
    readings = [Reading("r", "a", 0.0, 1.0), Reading("contact_time.+Y", "touch", 0.0, 1.0, kind="time")]
    one = Observation([track(times, "rates.roll"), track(times, "attitude.roll"), track(times, "y", "other")], readings)
    columns = {"rates.roll": np.sin(3.0 * GRID), SPIN[2]: 3.0 * np.cos(3.0 * GRID), "attitude.roll": GRID**2, "y": np.cos(GRID)}
    course = Course(GRID, columns, {"a": 0.7, "touch": 0.25})
    dated = [{ORIGIN: 0.03}, {ORIGIN: -0.2, "clock.other": 0.1}, {}]
    found = one.predicted_dated(course, dated)
    assert np.array_equal(found, [one.predicted(course, values) for values in dated])


def test_before_contact_the_vehicle_flies_free() -> None:
    rate = np.cos(GRID)
    course = {"rates.roll": rate, SPIN[2]: -np.sin(GRID), "attitude.roll": 0.3 + 0.7 * GRID}
    early = np.array([-0.5, -0.1])
    np.testing.assert_allclose(sampled(Course(GRID, course, {}), "rates.roll", early), 1.0)
    np.testing.assert_allclose(sampled(Course(GRID, course, {}), "attitude.roll", early), 0.3 + 0.7 * early)


def test_rates_are_interpolated_with_their_slopes() -> None:
    course = Course(GRID, {"rates.roll": np.sin(3.0 * GRID), SPIN[2]: 3.0 * np.cos(3.0 * GRID)}, {})
    between = GRID[:-1] + 0.05
    np.testing.assert_allclose(sampled(course, "rates.roll", between), np.sin(3.0 * between), atol=3e-5)


def test_a_peak_is_the_largest_magnitude_with_its_sign_and_an_instant_is_by_the_data_s_clock() -> None:
    one = Observation([], [Reading("peak.y", "y", 0.0, 1.0, kind="peak"), Reading("contact_time.+Y", "touch", 0.0, 1.0, kind="time")])
    one.shift = 100.0
    column = np.where(GRID[7] == GRID, -3.0, 2.0)
    got = one.predicted(Course(GRID, {"y": column}, {"touch": 0.25}), {ORIGIN: 0.5})
    np.testing.assert_allclose(got, [-3.0, 100.75])


def test_a_horizon_leaves_out_later_samples_and_what_is_read_at_rest() -> None:
    landings = one_landing([track(np.array([0.1, 0.5, 0.9]))], [Reading("r", "a", 0.0, 1.0)], {"a": 0.0, "b": 0.0})
    np.testing.assert_array_equal(Model(landings, (), Line(), 0.6).weights, [1, 1, 0, 0])
    np.testing.assert_array_equal(Model(landings, (), Line()).weights, [1, 1, 1, 1])


def test_a_series_without_samples_and_a_landing_without_series_are_no_trouble() -> None:
    none = one_landing([track(np.zeros(0))], [Reading("r", "a", 0.5, 0.1)], {"a": 0.0, "b": 0.0})
    only = one_landing([], [Reading("r", "a", 0.5, 0.1)], {"a": 0.0, "b": 0.0})
    for landings in (none, only):
        model = Model(landings, [coordinate("a")], Line())
        predicted = model.predict(np.zeros(1))
        assert predicted is not None
        np.testing.assert_allclose(model.residual(predicted), [5.0])


def test_a_slope_is_made_by_a_difference_that_is_felt() -> None:
    flown: list[float] = []

    class Watched(Ringing):
        def column(self, name, values, t):  # type: ignore[no-untyped-def]
            flown.append(values["v"])
            return super().column(name, values, t)

    from diagnosis_samples import RINGING, ringing_landing

    model = Model(ringing_landing({}, sigma=0.5), [coordinate("v", 0.5)], Watched())
    at = model.predict(np.zeros(1))
    assert at is not None
    model.slopes(np.zeros(1), at)
    assert max(flown) - RINGING["v"] == pytest.approx(0.25), "half a prior sigma is the widest"
