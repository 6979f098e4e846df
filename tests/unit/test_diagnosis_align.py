"""Clocks and axes: when first contact was, and whether channels were swapped."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from orchestrator.diagnosis.align import STEP, first_contact, swapped
from orchestrator.diagnosis.landing import ATTITUDE, RATES, SPIN, Course
from orchestrator.diagnosis.observation import Observation, Reading, Track

Array = NDArray[np.float64]
GRID = np.arange(0.0, 4.0, 0.01)
SIGMA = 0.0017


def rates(t: Array) -> Array:
    """Three rates of a touchdown at 0, each with its own story; free flight before."""
    t = np.maximum(t, 0.0)
    return np.array([
        -0.011 - 0.03 * t * np.exp(-t / 0.4),
        0.20 * np.sin(9.0 * t) * np.exp(-t / 1.5),
        -0.05 + 0.25 * (1.0 - np.exp(-t / 0.05)) * np.exp(-t / 1.5) * np.cos(5.0 * t),
    ])  # fmt: skip


def course() -> Course:
    y = rates(GRID)
    spins = {name: np.gradient(row, GRID) for name, row in zip(SPIN, y, strict=True)}
    return Course(GRID, dict(zip(RATES, y, strict=True)) | spins, {})


Three = tuple[int, int, int]


def observation(start: float, offset: float, stretch: float = 1.0, order: Three = (0, 1, 2), signs: Three = (1, 1, 1)) -> Observation:
    """Rates from `start` before contact on, the clock showing `offset` at contact, a little other than the scenario's."""
    random = np.random.default_rng(6)
    own = np.arange(-start, 3.0, 0.04)
    y = stretch * rates(own) + SIGMA * random.standard_normal((3, len(own)))
    y = np.array([s * y[i] for i, s in zip(order, signs, strict=True)])
    return Observation([Track("rates", n, n, own + offset, row, SIGMA, 0.0) for n, row in zip(RATES, y, strict=True)], [])


@pytest.mark.parametrize("offset", [-2.0, 0.5, 7.3, 1000.0, 1.6e8])
@pytest.mark.parametrize("start", [0.0, 0.3])
@pytest.mark.parametrize("stretch", [1.0, 1.2])
def test_a_clock_that_does_not_start_at_contact_is_found(offset: float, start: float, stretch: float) -> None:
    assert first_contact(observation(start, offset, stretch), course()) == pytest.approx(offset, abs=2.0 * STEP)


@pytest.mark.parametrize("stretch", [0.8, 1.0, 1.3])
def test_a_clock_that_starts_at_contact_is_left_alone(stretch: float) -> None:
    assert first_contact(observation(0.0, 0.0, stretch), course()) == 0.0
    assert first_contact(observation(0.2, 0.0, stretch), course()) == 0.0


@pytest.mark.parametrize("offset", [4.5, 9.0])
def test_a_record_that_starts_after_the_landing_was_over_does_not_start_at_contact(offset: float) -> None:
    """However badly the scenario fits, part of the record lies within the landing flown; at zero, which fits no worse, none does."""
    rough = observation(0.0, offset, 3.0, (1, 2, 0), (-1, -1, 1))
    assert first_contact(rough, course()) > offset - GRID[-1]


def test_a_landing_without_series_has_its_contact_at_zero() -> None:
    assert first_contact(Observation([], []), course()) == 0.0


@pytest.mark.parametrize(
    ("order", "signs", "told"),
    [
        ((0, 2, 1), (1, 1, 1), "rates.yaw, rates.roll, rates.pitch"),
        ((2, 0, 1), (1, 1, 1), "rates.pitch, rates.roll, rates.yaw"),
        ((0, 1, 2), (1, 1, -1), "rates.yaw, rates.pitch, -rates.roll"),
    ],
)
def test_swapped_or_turned_axes_are_told_with_how_to_read_them(order: Three, signs: Three, told: str) -> None:
    assert told in swapped(observation(0.0, 0.0, 1.1, order, signs), course())


@pytest.mark.parametrize("stretch", [0.5, 0.8, 1.0, 1.3, 2.0])
def test_a_good_record_of_a_somewhat_other_landing_is_not_called_swapped(stretch: float) -> None:
    assert swapped(observation(0.0, 0.0, stretch), course()) == ""


def test_axes_are_looked_at_where_a_sample_is_missing_and_where_a_series_holds_more_than_three_channels() -> None:
    seen = observation(0.0, 0.0, 1.1, (0, 2, 1))
    short = replace(seen.tracks[1], times=np.delete(seen.tracks[1].times, 20), readings=np.delete(seen.tracks[1].readings, 20))
    assert "rates.yaw, rates.roll, rates.pitch" in swapped(Observation([seen.tracks[0], short, seen.tracks[2]], []), course())
    besides = [replace(t, channel=a, column=a, readings=np.zeros(len(t.times))) for t, a in zip(seen.tracks, ATTITUDE, strict=True)]
    flown = course()
    flown.columns.update({a: np.zeros(len(GRID)) for a in ATTITUDE})
    assert "rates.yaw, rates.roll, rates.pitch" in swapped(Observation([*seen.tracks, *besides], []), flown)


def test_three_channels_that_are_no_axes_may_stand_in_any_order() -> None:
    """Of loads of three legs the first and the second may well be exchanged: that is no fault of the data."""
    seen, loads = observation(0.0, 0.0, 1.1, (0, 2, 1)), tuple(f"leg{k}.primary.load" for k in (1, 2, 3))
    tracks = [replace(track, channel=load, column=load) for track, load in zip(seen.tracks, loads, strict=True)]
    flown = course()
    flown.columns.update({load: flown.columns[name] for load, name in zip(loads, RATES, strict=True)})
    assert swapped(Observation(tracks, []), flown) == ""


def test_instants_of_contact_tell_the_clock_where_there_is_no_series() -> None:
    seen = ((1, 369040.2), (2, 369040.51))
    times = [Reading(f"contact_time.{k}", f"soil{k}.contact_time", time, 0.01, kind="time") for k, time in seen]
    flown = Course(GRID, {}, {"soil1.contact_time": 0.0, "soil2.contact_time": 0.3})
    assert first_contact(Observation([], times), flown) == pytest.approx(369040.205)
    never = Course(GRID, {}, {"soil1.contact_time": -1.0, "soil2.contact_time": -1.0})
    assert first_contact(Observation([], times), never) == 0.0


def test_a_quiet_channel_that_is_off_does_not_hide_the_clock() -> None:
    """The first rate hardly moves and is off by 30 of its noise at every clock; the other two tell the time."""
    seen = observation(0.1, 0.85)
    quiet = seen.tracks[0]
    quiet.readings[:] = quiet.readings.mean() + 0.1 * (quiet.readings - quiet.readings.mean()) + 30.0 * SIGMA
    assert first_contact(seen, course()) == pytest.approx(0.85, abs=2.0 * STEP)
