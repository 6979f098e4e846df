"""What is read off a residual: is it only noise, and where is it not."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_samples import RINGING, Ringing, coordinate, ljung_box, ringing_landing
from scipy.stats import kstest

from orchestrator.diagnosis.adequacy import adequacy, portmanteau
from orchestrator.diagnosis.fit import Fit, seen_from
from orchestrator.diagnosis.locate import located
from orchestrator.diagnosis.observation import Observation
from orchestrator.diagnosis.problem import Landings, Model


def base_fit(landings: Landings) -> Fit:
    """The truth itself, with slopes by one nuisance that is known too well to follow anything."""
    model = Model(landings, [coordinate("v", 1e-6)], Ringing())
    predicted = model.predict(np.zeros(1))
    assert predicted is not None
    return seen_from(model, np.zeros(1), predicted, np.zeros((len(predicted), 1)))


def renewed(fit: Fit, random: np.random.Generator) -> Fit:
    return replace(fit, residual=random.standard_normal(len(fit.residual)))


def test_a_white_residual_is_adequate_as_often_as_its_p_value_says() -> None:
    landings = ringing_landing({})
    fit, random = base_fit(landings), np.random.default_rng(0)
    found = [adequacy(renewed(fit, random), landings) for _ in range(400)]
    assert kstest([it.size for it in found], "uniform").pvalue > 1e-3
    assert np.mean([it.p < 0.01 for it in found]) < 0.03
    assert np.mean([it.p < 0.1 for it in found]) < 0.15


def smooth(random: np.random.Generator, n: int, rho: float) -> np.ndarray:
    """An autoregression."""
    found = random.standard_normal(n)
    for i in range(1, n):
        found[i] = rho * found[i - 1] + np.sqrt(1.0 - rho**2) * found[i]
    return found


@pytest.mark.parametrize("n", [50, 165])
def test_white_noise_is_refused_no_oftener_than_its_p_value_says(n: int) -> None:
    """4,000 draws, three standard deviations: 0.0147 for 0.01. Autocorrelations of few samples are a little negative."""
    random = np.random.default_rng(2)
    p = np.array([portmanteau(random.standard_normal(n)) for _ in range(4000)])
    assert np.mean(p < 0.01) < 0.01 + 3.0 * np.sqrt(0.01 / 4000)
    assert np.mean(p < 0.1) < 0.1 + 3.0 * np.sqrt(0.1 / 4000)
    assert np.mean(p < 0.1) > 0.04


def test_what_is_smooth_is_refused_oftener_than_by_both_signs_and_what_alternates_is_not() -> None:
    random = np.random.default_rng(3)
    left = [smooth(random, 83, 0.3) for _ in range(600)]
    assert np.mean([portmanteau(it) < 0.01 for it in left]) > np.mean([ljung_box(it) < 0.01 for it in left]) + 0.03
    assert np.mean([portmanteau(smooth(random, 83, -0.3)) < 0.01 for _ in range(600)]) < 0.02
    assert portmanteau(np.zeros(20)) == 1.0


def test_what_a_fit_followed_is_taken_off_the_freedom() -> None:
    landings, random = ringing_landing({}), np.random.default_rng(1)
    fit, columns = base_fit(landings), random.standard_normal((198, 30))
    basis = np.linalg.qr(columns)[0]
    loose = replace(fit, z=np.zeros(30), jacobian=1e4 * basis, coordinates=(coordinate("v"),) * 30)
    found = []
    for _ in range(300):
        e = random.standard_normal(198)
        found.append(adequacy(replace(loose, residual=e - basis @ (basis.T @ e)), landings))
    assert found[0].freedom == pytest.approx(168.0, abs=0.01)
    assert kstest([it.size for it in found], "uniform").pvalue > 1e-3


@pytest.mark.parametrize("share", [0.15, 0.3, 0.7])
def test_a_noise_estimated_from_a_part_of_the_rows_makes_no_fit_inadequate(share: float) -> None:
    """The chi-square's own p-value would be below 0.01 in 22 % of the fits where 15 % of the rows told the noise."""
    landings = ringing_landing({})
    fit, random = base_fit(landings), np.random.default_rng(0)
    (observation,) = landings.observations
    known = int(share * 198)
    observation.set_noise([replace(noise, known=float(known)) for noise in observation.noises])
    found = []
    for _ in range(600):
        e = random.standard_normal(198)
        found.append(adequacy(replace(fit, residual=e / np.sqrt(np.mean(e[-known:] ** 2))), landings).size)
    assert (0.02 if share < 0.5 else 0.0) < np.mean(np.array(found) < 0.05) < 0.08
    assert np.mean(np.array(found) < 0.01) < 0.025


@pytest.mark.parametrize("what", ["larger", "coloured"])
def test_a_residual_that_is_too_large_or_coloured_is_not_adequate(what: str) -> None:
    landings = ringing_landing({})
    e = np.random.default_rng(2).standard_normal(198)
    e = 1.4 * e if what == "larger" else (e + np.roll(e, 1)) / np.sqrt(2.0)
    assert adequacy(replace(base_fit(landings), residual=e), landings).p < 1e-3


def test_a_residual_as_large_as_the_noise_that_it_told_is_judged_by_what_is_known_without_it() -> None:
    """White numbers of unit variance, but by a σ 1.4 times what rest and statement say, which are known to 5 %."""
    landings = ringing_landing({})
    fit = renewed(base_fit(landings), np.random.default_rng(2))
    (observation,) = landings.observations
    for size, low, high in ((1.0, 0.1, 1.0), (1.4, 0.0, 1e-3)):
        observation.set_noise([replace(noise, known=200.0, reference=noise.sigma / size) for noise in observation.noises])
        assert low <= adequacy(fit, landings).size <= high


def test_a_bump_in_one_channel_is_found_there_and_then_and_given_to_the_port_that_explains_it() -> None:
    landings = ringing_landing({"hump": 0.04})
    fit = base_fit(landings)
    model = Model(landings, [coordinate("hump", 0.04)], Ringing())
    predicted = model.predict(np.ones(1))
    assert predicted is not None
    right = seen_from(model, np.ones(1), predicted, np.zeros((len(predicted), 1)))
    found = located(fit, landings, {"hump": right, "other": fit}, {"hump": ("strut", "gear"), "other": ("sensor", "sensor")})
    assert found[0].channel == "x"
    assert found[0].from_s < 0.9 < found[0].to_s
    assert found[0].to_s - found[0].from_s <= 0.4
    assert (found[0].port, found[0].unit) == ("strut", "gear")
    assert all(one.channel == "x" for one in found)


def test_of_several_landings_each_has_its_own_places_of_disagreement() -> None:
    one = ringing_landing({"hump": 0.04})
    both = Landings([one.observations[0], one.observations[0]], one.bases * 2, one.stop * 2)
    found = located(base_fit(both), both, {}, {}, ["first", "second"])
    assert {where.landing for where in found if where.from_s < 0.9 < where.to_s} == {"first", "second"}


def test_times_are_since_first_contact_whatever_the_data_s_clock_says() -> None:
    landings = ringing_landing({"hump": 0.04})
    fit = base_fit(landings)
    late = Observation([replace(t, times=t.times + 500.0) for t in landings.observations[0].tracks], [])
    late.shift = 500.0
    found = located(fit, replace(landings, observations=[late]), {}, {})
    assert found[0].from_s < 0.9 < found[0].to_s
    assert found[0].port == ""


def test_white_noise_has_no_place_of_disagreement() -> None:
    landings = ringing_landing({})
    fit, random = base_fit(landings), np.random.default_rng(3)
    alarms = [bool(located(renewed(fit, random), landings, {}, {})) for _ in range(200)]
    assert np.mean(alarms) <= 0.05


def test_a_channel_without_samples_disagrees_nowhere() -> None:
    landings = ringing_landing({})
    x, y = landings.observations[0].tracks
    landings = Landings([Observation([x, replace(y, times=y.times[:0], readings=y.readings[:0])], [])], [dict(RINGING)], landings.stop)
    assert located(base_fit(landings), landings, {}, {}) == []
