"""Faults of measured data: found where they are, and not where a landing only does what landings do."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from orchestrator.diagnosis.measured import Measured, Series, faults

Array = NDArray[np.float64]
SIGMA = 0.0017
NAMES = ("rates.yaw", "rates.pitch", "rates.roll")


def motion(times: Array) -> Array:
    """Rates of a touchdown at 0.5 s: they jump at contacts, ring, and come to rest."""
    after = np.maximum(times - 0.5, 0.0)
    second = np.maximum(times - 0.62, 0.0)
    rising, again = 1.0 - np.exp(-after / 4e-3), 1.0 - np.exp(-second / 2e-3)
    roll = -0.05 + rising * 0.2 * np.exp(-after / 0.3) * np.cos(20.0 * after) + rising * 0.05
    pitch = 0.1 * rising * np.exp(-after / 0.25) - 0.15 * again * np.exp(-second / 0.3)
    yaw = -0.011 * np.exp(-after / 0.5) - 0.02 * again * np.sin(8.0 * second) * np.exp(-second / 0.4)
    return np.column_stack([yaw, pitch, roll])


def series(rate: float = 100.0, noise: float = 1.0, colour: float = 0.0, irregular: bool = False, start: float = 0.0) -> Series:
    random = np.random.default_rng(3)
    n = int(4.0 * rate)
    times = np.sort(random.uniform(0.0, 4.0, n)) if irregular else np.arange(n) / rate
    e = random.normal(size=(n, 3))
    for i in range(1, n):
        e[i] = colour * e[i - 1] + np.sqrt(1.0 - colour**2) * e[i]
    values = motion(times) + noise * SIGMA * e
    return Series("rates", NAMES, times + start, values, np.full(3, SIGMA), None if colour else 0.0, ("rad/s",) * 3)


def found(one: Series, *more: Series) -> list[tuple[str, str]]:
    return [(fault.channel, fault.what) for fault in faults(Measured("", "", Path(), [one, *more]))]


@pytest.mark.parametrize("rate", [5.0, 10.0, 25.0, 50.0, 100.0, 500.0])
@pytest.mark.parametrize("noise", [0.0, 0.5, 1.0, 3.0])
@pytest.mark.parametrize("irregular", [False, True])
def test_a_good_landing_has_no_fault_at_any_rate_with_or_without_noise(rate: float, noise: float, irregular: bool) -> None:
    assert found(series(rate, noise, irregular=irregular)) == []


@pytest.mark.parametrize("colour", [0.3, 0.7, 0.95])
def test_coloured_noise_of_the_stated_sigma_is_no_fault(colour: float) -> None:
    assert found(series(colour=colour)) == []


def test_a_clock_that_starts_years_ago_is_no_fault() -> None:
    assert found(series(start=1.6e8)) == []


def test_gaps_marked_as_such_are_no_fault() -> None:
    one = series()
    one.values[100:180, 1] = np.nan
    one.values[::7, 2] = np.nan
    assert found(one) == []


@pytest.mark.parametrize("quantum", [0.5, 3.0, 10.0])
@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_a_quantised_channel_that_rests_within_one_step_is_no_fault(quantum: float, noise: float) -> None:
    one = series(noise=noise)
    step = quantum * SIGMA
    one.values[:] = step * np.round(one.values / step)
    assert found(one) == []


def test_a_vehicle_at_rest_without_noise_is_no_fault() -> None:
    one = series(noise=0.0)
    one.values[300:] = one.values[300]
    assert found(one) == []


def test_a_landing_without_any_yaw_is_no_fault() -> None:
    one = series(noise=0.0)
    one.values[:, 0] = 0.0
    assert found(one) == []


Spoil = Callable[[Series], None]


def freeze(one: Series) -> None:
    one.values[80:260, 2] = one.values[80, 2]


def freeze_from_the_start(one: Series) -> None:
    one.values[:, 2] = 0.031


def spike(one: Series) -> None:
    one.values[300, 1] += 60.0 * SIGMA


def two_spikes(one: Series) -> None:
    one.values[[45, 350], 1] -= 80.0 * SIGMA


def drop(one: Series) -> None:
    one.values[:, 0] += 0.05
    one.values[130:136, 0] = 0.0


def shout(one: Series) -> None:
    one.values[:, 0] += np.random.default_rng(9).normal(size=len(one.times)) * 10.0 * SIGMA


def copy(one: Series) -> None:
    one.values[:, 2] = one.values[:, 1]


@pytest.mark.parametrize(
    ("spoil", "channel", "what", "noise"),
    [
        (freeze, "rates.roll", "stands still", 1.0),
        (freeze, "rates.roll", "stands still", 0.0),
        (freeze_from_the_start, "rates.roll", "stands still", 1.0),
        (freeze_from_the_start, "rates.roll", "stands still", 0.0),
        (spike, "rates.pitch", "has a spike of", 1.0),
        (spike, "rates.pitch", "has a spike of", 0.0),
        (two_spikes, "rates.pitch", "has a spike of", 1.0),
        (drop, "rates.yaw", "drops to exactly zero for 6 samples", 1.0),
        (drop, "rates.yaw", "drops to exactly zero for 6 samples", 0.0),
        (shout, "rates.yaw", "has noise of", 1.0),
        (copy, "rates.roll", "holds the same numbers as rates.pitch", 1.0),
        (copy, "rates.roll", "holds the same numbers as rates.pitch", 0.0),
    ],
)
def test_a_fault_is_found_in_its_channel_and_nowhere_else(spoil: Spoil, channel: str, what: str, noise: float) -> None:
    one = series(noise=noise)
    spoil(one)
    hits = found(one)
    assert hits
    assert all(hit[0] == channel and what in hit[1] for hit in hits), hits


def test_noise_far_below_the_stated_sigma_is_a_fault() -> None:
    hits = found(series(noise=0.1))
    assert {channel for channel, _ in hits} == set(NAMES)
    assert all("has noise of" in what for _, what in hits)


def test_a_spike_and_a_dropout_are_found_where_they_are() -> None:
    one = series()
    spike(one)
    drop(one)
    times = {fault.what.partition(" ")[0]: (fault.from_s, fault.to_s) for fault in faults(Measured("", "", Path(), [one]))}
    assert times["has"] == (3.0, 3.0)
    assert times["drops"] == pytest.approx((1.3, 1.35))


def test_missing_samples_are_a_fault_when_nothing_marks_them() -> None:
    one = series()
    kept = np.r_[0:100, 180:400]
    cut = Series("rates", NAMES, one.times[kept], one.values[kept], one.sigma, 0.0)
    assert [(channel, what.partition(" s,")[0]) for channel, what in found(cut)] == [(", ".join(NAMES), "has no sample for 0.81")]


def test_legs_that_do_the_same_are_no_fault() -> None:
    one = series()
    load = Series("loads", ("leg+Z.primary.load", "leg-Z.primary.load"), one.times, one.values[:, [1, 1]], one.sigma[:2], 0.0, ("N", "N"))
    assert found(load) == []
