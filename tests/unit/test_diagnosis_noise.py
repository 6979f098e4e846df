"""Noise: how large, which colour, and made white."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.stats import kstest

from orchestrator.diagnosis.adequacy import ljung_box
from orchestrator.diagnosis.noise import Noise, Whitening, colour_of, noise_of

Array = NDArray[np.float64]


def coloured(random: np.random.Generator, times: Array, noise: Noise) -> Array:
    """AR(1), its coefficient raised to the distance of the samples."""
    e = np.empty(len(times))
    e[0] = random.standard_normal()
    for k in range(1, len(times)):
        rho = noise.rho ** ((times[k] - times[k - 1]) / noise.interval) if noise.rho else 0.0
        e[k] = rho * e[k - 1] + np.sqrt(1.0 - rho**2) * random.standard_normal()
    return noise.sigma * e


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.9])
@pytest.mark.parametrize("irregular", [False, True])
def test_whitening_makes_coloured_noise_white_with_unit_variance(rho: float, irregular: bool) -> None:
    random = np.random.default_rng(5)
    times = np.sort(random.uniform(0.0, 40.0, 1000)) if irregular else np.arange(1000) * 0.04
    noise = Noise(0.3, rho, 0.04)
    p, variance = [], []
    for _ in range(60):
        white = Whitening(times, noise)(coloured(random, times, noise))
        p.append(ljung_box(white))
        variance.append(float(white.var()))
    assert np.mean(variance) == pytest.approx(1.0, abs=0.03)
    assert kstest(p, "uniform").pvalue > 1e-3


def test_whitening_is_linear_and_serves_columns_alike() -> None:
    random = np.random.default_rng(1)
    whitening = Whitening(np.arange(50) * 0.1, Noise(0.2, 0.7, 0.1))
    columns = random.standard_normal((50, 3))
    np.testing.assert_allclose(whitening(columns)[:, 1], whitening(columns[:, 1]))
    np.testing.assert_allclose(whitening(columns @ np.array([1.0, 2.0, 3.0])), whitening(columns) @ np.array([1.0, 2.0, 3.0]))


@pytest.mark.parametrize("rho", [0.0, 0.4, 0.8])
@pytest.mark.parametrize("count", [60, 200])
def test_level_and_colour_come_back_from_noise_on_a_slow_drift(rho: float, count: int) -> None:
    random = np.random.default_rng(2)
    times = np.arange(count) * 0.04
    found = np.array([colour_of(coloured(random, times, Noise(0.3, rho, 0.04)) + 0.2 + 0.1 * times) for _ in range(200)])
    spread = np.sqrt((1.0 - rho**2) / count) + (1.0 + 4.0 * rho) / count
    assert abs(np.median(found[:, 1]) - rho) < max(spread, 0.05)
    assert np.median(found[:, 0]) == pytest.approx(0.3, rel=0.08)


def test_a_stated_noise_stands_unless_the_rest_contradicts_it() -> None:
    random = np.random.default_rng(3)
    times = np.arange(200) * 0.04
    still = times > 2.0
    changed = [noise_of(times, 0.3 * random.standard_normal(200), still, 0.3, None).sigma != 0.3 for _ in range(200)]
    assert np.mean(changed) < 0.05
    louder = noise_of(times, 0.9 * random.standard_normal(200), still, 0.3, None)
    assert louder.sigma == pytest.approx(0.9, rel=0.2)
    silent = noise_of(times, 1e-3 * random.standard_normal(200), still, 0.3, None)
    assert silent.sigma == 0.15


def test_a_short_rest_or_a_stated_colour_leaves_things_as_they_are() -> None:
    times = np.arange(60) * 0.04
    residual = np.random.default_rng(4).standard_normal(60)
    assert noise_of(times, residual, times > 1.6, 0.3, None) == Noise(0.3, 0.0, pytest.approx(0.04))
    assert noise_of(times, residual, times >= 0.0, 0.3, 0.5).rho == 0.5
