"""Noise: how large, which colour, and made white."""

import numpy as np
import pytest
from diagnosis_samples import ljung_box
from numpy.typing import NDArray
from scipy.stats import kstest

from orchestrator.diagnosis.noise import Noise, Stretch, Whitening, noise_of

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


def at_rest(rows: Array, times: Array, sigma: float, after: float = -1.0) -> list[Stretch]:
    return [Stretch(times, row, times > after, sigma) for row in rows]


@pytest.mark.parametrize("rho", [0.0, 0.4, 0.8])
@pytest.mark.parametrize("count", [40, 150])
def test_level_and_colour_of_a_series_come_back_from_its_rest_on_a_slow_drift(rho: float, count: int) -> None:
    random = np.random.default_rng(2)
    times = np.arange(count) * 0.04
    found = []
    for _ in range(200):
        rows = np.array([coloured(random, times, Noise(0.3, rho, 0.04)) + 0.2 + 0.1 * times for _ in range(3)])
        found.append(noise_of(at_rest(rows, times, 0.15), None)[0])
    assert abs(np.median([it.rho for it in found]) - rho) < max(2.0 / np.sqrt(3.0 * count), 0.06)
    innovations = [it.sigma * np.sqrt(1.0 - it.rho**2) for it in found]
    assert np.median(innovations) == pytest.approx(0.3 * np.sqrt(1.0 - rho**2), rel=0.06)


def heard(random: np.random.Generator, size: float, count: int = 200) -> Noise:
    """What is made of three rows of white noise stated as 0.3, the last three quarters of them at rest."""
    times = np.arange(count) * 0.04
    return noise_of(at_rest(size * random.standard_normal((3, count)), times, 0.3, 0.25 * times[-1]), None)[0]


def test_what_is_heard_and_what_is_stated_are_weighed() -> None:
    """Stated noise that is right to 10 %, heard from 100 samples (7 %): together it is known to 5.8 %, better than by either."""
    random = np.random.default_rng(3)
    sizes = 0.3 * np.exp(0.1 * random.standard_normal(400))
    found = [heard(random, float(size), 45) for size in sizes]
    errors = np.log([it.sigma for it in found] / sizes)
    assert float(np.sqrt(np.mean(errors**2))) == pytest.approx(1.0 / np.sqrt(2.0 * found[0].known), rel=0.12)
    assert found[0].known == pytest.approx(50.0 + 3.0 * (34.0 - 3.0), rel=0.03), "a parabola goes off each row"


def test_stated_noise_that_the_rest_contradicts_counts_for_nothing() -> None:
    random = np.random.default_rng(3)
    assert heard(random, 0.9).sigma == pytest.approx(0.9, rel=0.1)
    assert heard(random, 1e-3).sigma == 0.15, "data may be quieter than said, the model is not"


def test_the_stated_sigmas_of_a_series_keep_their_proportion() -> None:
    random = np.random.default_rng(4)
    times = np.arange(300) * 0.04
    rows = [Stretch(times, 2.0 * s * random.standard_normal(300), times >= 0.0, s) for s in (0.1, 0.3)]
    a, b = noise_of(rows, None)
    assert b.sigma / a.sigma == pytest.approx(3.0)
    assert a.sigma == pytest.approx(0.2, rel=0.1), "twice the stated noise: contradicted"


def test_a_short_rest_or_a_stated_colour_leaves_things_as_they_are() -> None:
    times = np.arange(60) * 0.04
    rows = np.random.default_rng(4).standard_normal((3, 60))
    assert noise_of(at_rest(rows, times, 0.3, 2.0), None)[0] == Noise(0.3, 0.0, pytest.approx(0.04), pytest.approx(50.0))
    assert noise_of(at_rest(rows, times, 0.3, 2.0), 0.5)[0].rho == 0.5
    assert noise_of(at_rest(rows, times, 0.3), 0.5)[1].rho == 0.5


FOLLOWED = 5


def never_at_rest(random: np.random.Generator, rho: float) -> list[Stretch]:
    """Three rows of 72 samples in motion: what a fit with five smooth columns a row leaves of noise stated as 0.3."""
    times = np.arange(72) * 0.05
    basis, _ = np.linalg.qr(np.cos(np.outer(times, np.arange(FOLLOWED)) * np.pi / times[-1]))
    rows = [coloured(random, times, Noise(0.3, rho, 0.05)) for _ in range(3)]
    return [Stretch(times, row - basis @ (basis.T @ row), times > times[-1], 0.3) for row in rows]


@pytest.mark.parametrize("rho", [0.0, 0.4, 0.8])
def test_the_colour_of_what_never_rests_is_judged_by_what_an_adequate_fit_leaves(rho: float) -> None:
    """216 samples tell ρ to sqrt((1 - ρ²)/216), 0.06 at most; what the fit's 15 numbers hide of it is corrected for to 0.05."""
    random = np.random.default_rng(6)
    found, p = [], []
    for _ in range(100):
        rows = never_at_rest(random, rho)
        noise = noise_of(rows, None, FOLLOWED)[0]
        found.append(noise.rho)
        p.append(ljung_box(Whitening(rows[0].times, noise)(rows[0].residual)))
    assert np.mean(found) == pytest.approx(rho, abs=0.05)
    assert np.mean(np.array(p) < 0.001) < 0.05, "white enough: a tenth of a per cent is due, and five columns are taken out"


@pytest.mark.parametrize("followed", [None, FOLLOWED])
def test_a_short_rest_does_not_make_white_noise_coloured(followed: float | None) -> None:
    """Twenty samples a row at rest. Their autocorrelation, once corrected for the parabola and significant, is above 0.3 in 6 %."""
    random = np.random.default_rng(8)
    times = np.arange(90) * 0.04
    rows = [at_rest(0.3 * random.standard_normal((3, 90)), times, 0.3, times[-21]) for _ in range(300)]
    found = np.array([noise_of(it, None, followed)[0].rho for it in rows])
    assert np.mean(found > 0.3) < 0.03
    assert np.mean(found > 0.0) < 0.08, "two in log-likelihood by chance: 2 %, of few samples more"


def test_noise_that_a_fit_told_keeps_what_rest_and_statement_say_for_reference() -> None:
    """In motion 1.25 times as large as stated, at rest as stated."""
    random = np.random.default_rng(9)
    times = np.arange(300) * 0.04
    rows = 0.3 * np.where(times > 8.0, 1.0, 1.25) * random.standard_normal((3, 300))
    alone, told = noise_of(at_rest(rows, times, 0.3, 8.0), None)[0], noise_of(at_rest(rows, times, 0.3, 8.0), None, FOLLOWED)[0]
    assert alone.understated == 1.0
    assert told.sigma == pytest.approx(0.3 * np.sqrt((200 * 1.25**2 + 100) / 300), rel=0.05)
    assert told.reference == pytest.approx(alone.sigma, rel=1e-6)
    assert told.known == alone.known


def test_what_a_fit_leaves_that_does_not_explain_the_data_tells_no_colour() -> None:
    assert noise_of(never_at_rest(np.random.default_rng(6), 0.8), None)[0].rho == 0.0


def test_a_short_rest_under_the_colour_of_the_whole_does_not_make_noise_larger_than_known() -> None:
    """Noise of one size and colour throughout, 1.18 times as large as stated; 41 samples a row at rest tell its size and colour together.
    Under the whole's colour alone the variance seems 1.2 times too large in 12 % of such data, under the rest's alone in 14 %.
    """
    random = np.random.default_rng(3)
    times = np.arange(106) * 0.03
    rows = [[coloured(random, times, Noise(0.3 * 1.18, 0.5, 0.03)) for _ in range(3)] for _ in range(300)]
    found = [noise_of(at_rest(np.array(it), times, 0.3, times[-42]), None, FOLLOWED)[0].understated for it in rows]
    assert np.mean(np.array(found) > 1.2) < 0.1
