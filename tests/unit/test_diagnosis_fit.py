"""Fits: the posterior and the evidence of models for which both are known."""

from collections.abc import Mapping, Sequence
from math import exp, pi, sqrt

import numpy as np
import pytest
from diagnosis_samples import RINGING, Line, Ringing, coordinate, one_landing, ringing_landing, tracks
from numpy.typing import NDArray
from scipy.integrate import dblquad, quad

from orchestrator.diagnosis.fit import HOPE, broyden, fitted, gauss_newton_step, objective, refined, seen_from, settled
from orchestrator.diagnosis.landing import Course
from orchestrator.diagnosis.observation import Reading
from orchestrator.diagnosis.problem import ABOUT, HERE, Model

Array = NDArray[np.float64]


def density_of(x: float) -> float:
    """Of a standard normal distribution; scipy's takes most of an integral's time."""
    return exp(-0.5 * x * x) / sqrt(2.0 * pi)


TIMES = np.linspace(0.1, 1.9, 12)


def line(sigmas: tuple[float, float], sigma: float, positive: tuple[bool, bool] = (False, False), truth=(0.4, -0.3)) -> Model:  # type: ignore[no-untyped-def]
    readings = [Reading("at rest", "c", truth[0] + 2.0 * truth[1] + 0.01, 0.5 * sigma)]
    landings = one_landing(tracks(Line(), dict(zip("ab", truth, strict=True)), ["y"], TIMES, sigma, 3), readings, {"a": 0.0, "b": 0.0})
    return Model(landings, [coordinate(n, s, p) for n, s, p in zip("ab", sigmas, positive, strict=True)], Line())


def at_best(model: Model, z: np.ndarray | None = None):  # type: ignore[no-untyped-def]
    z = np.zeros(len(model.coordinates)) if z is None else z
    predicted = model.predict(z)
    assert predicted is not None
    fit = fitted(model, z, model.slopes(z, predicted), predicted)
    assert fit is not None
    return fit


def log_likelihood(model: Model):  # type: ignore[no-untyped-def]
    """-χ²/2 over z; these models are linear, so three residuals know it."""

    def residual(z: np.ndarray) -> np.ndarray:
        predicted = model.predict(z)
        assert predicted is not None
        return model.residual(predicted)

    axes = np.eye(len(model.coordinates))
    first = residual(0.0 * axes[0])
    slopes = np.column_stack([residual(axis) - first for axis in axes])

    def at(z: np.ndarray) -> float:
        r = first + slopes @ z
        return -0.5 * float(r @ r)

    return at


def test_a_linear_model_is_fitted_to_its_posterior() -> None:
    model = line((0.5, 0.3), 0.1)
    fit = at_best(model)
    zero = model.predict(np.zeros(2))
    assert zero is not None
    J, r = model.whitened(model.slopes(np.zeros(2), zero), zero), model.residual(zero)
    covariance = np.linalg.inv(J.T @ J + np.eye(2))
    np.testing.assert_allclose(fit.covariance, covariance, rtol=1e-6)
    np.testing.assert_allclose(fit.z, covariance @ (J.T @ r), atol=1e-6)
    value, sigma = fit.estimate(1)
    assert value == pytest.approx(0.3 * fit.z[1])
    assert sigma == pytest.approx(0.3 * covariance[1, 1] ** 0.5)


@pytest.mark.parametrize("sigma", [0.05, 0.3, 3.0])
def test_the_evidence_of_two_coordinates_is_the_integral_over_their_prior(sigma: float) -> None:
    model = line((0.5, 0.3), sigma)
    fit = at_best(model)
    likelihood = log_likelihood(model)
    scale = likelihood(fit.z)
    s = np.sqrt(np.diag(fit.covariance))
    a, b = fit.z

    def density(y: float, x: float) -> float:
        z = np.array([x, y])
        return float(np.exp(likelihood(z) - scale) * density_of(x) * density_of(y))

    integral = dblquad(density, a - 8 * s[0], a + 8 * s[0], b - 8 * s[1], b + 8 * s[1], epsrel=1e-5, epsabs=0.0)[0]
    assert fit.log_evidence == pytest.approx(np.log(integral) + scale, abs=2e-3)


@pytest.mark.parametrize("truth", [0.6, 0.05, 0.0, -0.1, -0.4])
def test_the_evidence_of_a_half_normal_coordinate_is_its_integral_on_either_side_of_the_limit(truth: float) -> None:
    times = np.linspace(0.1, 1.9, 6)
    landings = one_landing(tracks(Line(), {"a": truth, "b": 0.0}, ["y"], times, 0.2, 8), (), {"a": 0.0, "b": 0.0})
    model = Model(landings, [coordinate("a", 0.5, positive=True)], Line())
    fit = at_best(model)
    likelihood = log_likelihood(model)
    scale = likelihood(fit.z)
    integral = quad(lambda x: 2.0 * density_of(x) * np.exp(likelihood(np.array([x])) - scale), 0.0, 6.0, epsrel=1e-8, limit=200)[0]
    assert fit.z[0] >= 0.0
    assert fit.log_evidence == pytest.approx(np.log(integral) + scale, abs=0.01)


@pytest.mark.parametrize("truth", [(0.4, 0.3), (0.4, 0.0), (0.2, -0.3)])
def test_the_evidence_holds_with_a_half_normal_effect_beside_a_nuisance(truth: tuple[float, float]) -> None:
    model = line((0.5, 0.3), 0.3, (False, True), truth)
    fit = at_best(model)
    likelihood = log_likelihood(model)
    scale = likelihood(fit.z)

    def density(y: float, x: float) -> float:
        return float(np.exp(likelihood(np.array([x, y])) - scale) * density_of(x) * 2.0 * density_of(y))

    integral = dblquad(density, -6.0, 6.0, 0.0, 6.0, epsrel=1e-5, epsabs=0.0)[0]
    assert fit.log_evidence == pytest.approx(np.log(integral) + scale, abs=0.02)


def test_a_limit_of_the_value_is_not_overstepped() -> None:
    model = line((0.5, 0.3), 0.05, (False, True))
    fit = at_best(model)
    assert fit.z[1] == 0.0


def test_a_nonlinear_fit_recovers_what_was_put_in() -> None:
    truth = {"v": 1.15, "w": 0.55, "phase": 0.1, "tilt": -0.03}
    names = list(truth)
    model = Model(ringing_landing(truth), [coordinate(n, 0.15) for n in names], Ringing())
    fit = refined(model, at_best(model))
    for i, name in enumerate(names):
        value, sigma = fit.estimate(i)
        assert RINGING[name] + value == pytest.approx(truth[name], abs=4.0 * sigma)
    assert fit.chi2 < 260.0
    assert seen_from(model, fit.z, fit.predicted, fit.slopes).log_evidence == pytest.approx(fit.log_evidence)


def test_slopes_of_the_very_point_are_its_derivatives_where_those_from_far_off_are_secants() -> None:
    """The phase of cos(6 t): at z = 0.1 (10 σ and more in all) the secant has turned; differences of 1.5 to 5 σ are within 3 %."""
    model = Model(ringing_landing({}), [coordinate("stiff", 8.0)], Ringing())
    z = np.zeros(1)
    predicted = model.predict(z)
    assert predicted is not None
    near = 1e-6
    true = (model.predict(z + near) - model.predict(z - near)) / (2.0 * near)  # type: ignore[operator]
    size = float(np.linalg.norm(true))
    about, here = (model.slopes(z, predicted, felt=felt)[:, 0] for felt in (ABOUT, HERE))
    again = model.slopes(z, predicted, like=here[:, None], felt=HERE)[:, 0]
    assert np.linalg.norm(about - true) > 0.2 * size
    assert np.linalg.norm(here - true) < 0.03 * size
    assert np.linalg.norm(again - true) < 0.03 * size


def test_broyden_s_formula_makes_slopes_meet_the_move_and_leaves_others_alone() -> None:
    random = np.random.default_rng(0)
    slopes, move, change = random.standard_normal((7, 3)), np.array([0.3, -0.1, 0.2]), random.standard_normal(7)
    before = slopes.copy()
    broyden(slopes, move, change)
    np.testing.assert_allclose(slopes @ move, change)
    across = np.cross(move, [1.0, 0.0, 0.0])
    np.testing.assert_allclose(slopes @ across, before @ across)


@pytest.mark.parametrize(("above", "given_up"), [(-0.5, True), (0.5, False)])
def test_a_fit_is_given_up_where_the_slopes_leave_no_hope_of_a_ceiling(above: float, given_up: bool) -> None:
    """Eight prior sigmas away, so that a step is cut short: after the first, which is always flown, HOPE times what the next promises."""
    model = line((0.5, 0.3), 0.1, truth=(4.0, -0.3))
    z = np.zeros(2)
    predicted = model.predict(z)
    assert predicted is not None
    slopes = model.slopes(z, predicted)
    one = fitted(model, z, slopes, predicted, steps=1)
    assert one is not None
    step = gauss_newton_step(one.jacobian, one.residual, one.z, model.coordinates, 1.0)
    promised = one.objective - objective(one.residual - one.jacobian @ step, one.z + step)
    found = fitted(model, z, slopes, predicted, steps=2, ceiling=one.objective - HOPE * promised + above)
    assert (found is None) == given_up


def test_what_cannot_be_flown_gives_no_fit() -> None:
    class Crashing(Line):
        def land(self, *_):  # type: ignore[no-untyped-def]
            return None

    model = line((0.5, 0.3), 0.1)
    assert fitted(Model(model.landings, model.coordinates, Crashing()), np.zeros(2), np.zeros((13, 2))) is None


class Deceiving(Line):
    """Beside another landing y = a + (b - 2 (a - a')) t: what it lacks in b seems to come with a, as corners read off a grid did."""

    varies = True

    def land(
        self,
        values: Mapping[str, float],
        grid: Array,
        columns: Sequence[str],
        final: Sequence[str],
        beside: Mapping[str, float] | None = None,
    ) -> Course | None:
        away = 0.0 if beside is None else values["a"] - beside["a"]
        return super().land({**values, "b": values["b"] - 2.0 * away}, grid, columns, final)


def test_a_refined_fit_is_no_worse_than_it_was_where_landings_beside_it_deceive() -> None:
    hidden = {"a": 0.3, "b": -0.2}
    landings = one_landing(tracks(Line(), hidden, ["y"], TIMES, 0.05, 3), (), {"a": 0.0, "b": 0.0})
    model, z = Model(landings, (coordinate("a"),), Deceiving()), np.array([0.3])
    predicted = model.own(z)
    assert predicted is not None
    slopes = model.slopes(z, predicted)
    begun = seen_from(model, z, predicted, slopes)
    tempted = fitted(model, z, slopes, predicted)
    assert tempted is not None
    assert settled(model, tempted).objective > begun.objective + 1.0, "or the test sees nothing"
    assert refined(model, begun).objective <= begun.objective
