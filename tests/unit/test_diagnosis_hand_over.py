"""A winner's effect handed over: rivals that look like it with other nuisances only."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from diagnosis_samples import Formula, coordinate, one_landing, tracks
from numpy.typing import NDArray

from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.fit import Fit, seen_from
from orchestrator.diagnosis.hand_over import arranged, handed_over, handed_over_within, taken_over
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis
from orchestrator.diagnosis.problem import Model
from orchestrator.diagnosis.search import Search
from orchestrator.diagnosis.tasks.fits import FitAt, Point
from orchestrator.diagnosis.tasks.predict import slopes_beside

Array = NDArray[np.float64]
TIMES = np.linspace(0.05, 1.95, 40)


class Warped(Formula):
    """y = n + (east - west) t + west + other t^2/4: one side up is the other down, on a ground that is higher."""

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        v = values
        return np.asarray(v["n"] + (v["east"] - v["west"]) * t + v["west"] + v["other"] * 0.25 * t * t)


def warped() -> Warped:
    return Warped()


BASE = dict.fromkeys(("n", "east", "west", "other"), 0.0)
NUISANCES = (coordinate("n"),)
EFFECTS = {name: Hypothesis(name, (coordinate(name),)) for name in ("east", "west", "other")}


def search_of(hidden: Mapping[str, float]) -> Search:
    return Search(one_landing(tracks(Warped(), {**BASE, **hidden}, ["y"], TIMES, 0.01, 1), (), BASE), NUISANCES, (), Crew(warped))


def stuck(search: Search, name: str, z: tuple[float, float]) -> Fit:
    """A fit that stands where it was put."""
    model = Model(search.landings, (*NUISANCES, *EFFECTS[name].coordinates), Warped())
    at = np.array(z)
    predicted = model.predict(at)
    assert predicted is not None
    return seen_from(model, at, predicted, model.slopes(at, predicted))


def test_a_rival_takes_over_with_other_nuisances_and_another_sign() -> None:
    """-west lowers the ground by as much: n must make up for it. The wrong rival stays where it was."""
    search = search_of({"east": 0.7, "n": 0.2})
    fits = {n: stuck(search, n, (0.0, 0.0)) for n in ("west", "other")}
    fits["east"] = search.refine_all([stuck(search, "east", (0.2, 0.7))], "")[0]
    found = handed_over(search, fits, list(EFFECTS.values()), "east")
    assert found["west"].z == pytest.approx([0.9, -0.7], abs=0.02)
    assert found["west"].chi2 == pytest.approx(found["east"].chi2, abs=0.5)
    assert found["east"] is fits["east"]
    assert found["other"].log_evidence < found["east"].log_evidence - 20.0


def test_what_a_linear_rival_is_promised_is_what_it_gets() -> None:
    search = search_of({"east": 0.7, "n": 0.2})
    east = search.refine_all([stuck(search, "east", (0.2, 0.7))], "")[0]
    for name in ("west", "other"):
        h = EFFECTS[name]
        (own,) = search.crew.run([slopes_beside(search.landings, east.coordinates, east.z, east.predicted, h.coordinates)])
        promised, z = taken_over(search, east, h, own)
        fitted = search.refine_all([stuck(search, name, (float(z[0]), float(z[1])))], "")[0]
        assert promised == pytest.approx(fitted.log_evidence, abs=0.3)  # ENOUGH: a step that promises less is not flown
        assert z == pytest.approx(fitted.z, abs=0.01)


def test_nothing_missing_takes_over_too() -> None:
    """Nothing is hidden, but the fit of nothing missing stands where it should not: an effect would be named for its sake."""
    search = search_of({"n": 0.2})
    east = search.refine_all([stuck(search, "east", (0.2, 0.0))], "")[0]
    model = Model(search.landings, NUISANCES, Warped())
    at = np.array([-0.5])
    predicted = model.predict(at)
    assert predicted is not None
    null = seen_from(model, at, predicted, model.slopes(at, predicted))
    assert null.log_evidence < east.log_evidence - 100.0
    found = handed_over(search, {"east": east, NULL.name: null}, [EFFECTS["east"]], "east")
    assert found[NULL.name].log_evidence > east.log_evidence


def test_beside_one_effect_of_a_pair_the_other_goes_over_to_its_rival() -> None:
    """East and another together: west beside the other is the same. Whichever of the two stays in front."""
    search = search_of({"east": 0.7, "n": 0.2, "other": 0.5})
    both = (*NUISANCES, *EFFECTS["east"].coordinates, *EFFECTS["other"].coordinates)
    model, at = Model(search.landings, both, Warped()), np.array([0.2, 0.7, 0.5])
    predicted = model.predict(at)
    assert predicted is not None
    best = search.refine_all([seen_from(model, at, predicted, model.slopes(at, predicted))], "")[0]
    found = handed_over_within(search, best, (EFFECTS["east"], EFFECTS["other"]), list(EFFECTS.values()))
    assert [pair.name for pair, _ in found] == ["other + west"]
    ((pair, fit),) = found
    assert fit.coordinates == (*NUISANCES, *pair.coordinates)
    assert fit.z == pytest.approx([0.9, 0.5, -0.7], abs=0.03)
    assert fit.chi2 == pytest.approx(best.chi2, abs=0.5)


def known(name: str, value: float) -> Hypothesis:
    """An effect as another landing left it: its mean is what was found there, and moves something."""
    return Hypothesis(name, (replace(coordinate(name), mean=value, sigma=0.05, null=0.0),))


def test_an_effect_known_from_another_landing_is_handed_over_whole() -> None:
    """Another ground height: west, as little as it may differ from what is known of it, needs n where east does not."""
    search = search_of({"east": 0.7, "n": 0.2})
    effects = [known("east", 0.7), known("west", -0.7)]
    fits = {}
    for h, n in zip(effects, (0.2, 0.0), strict=True):
        model, at = Model(search.landings, (*NUISANCES, *h.coordinates), Warped()), np.array([n, 0.0])
        predicted = model.predict(at)
        assert predicted is not None
        fits[h.name] = seen_from(model, at, predicted, model.slopes(at, predicted))
    (own,) = search.crew.run([slopes_beside(search.landings, fits["east"].coordinates, fits["east"].z, fits["east"].predicted,
                                            effects[1].coordinates)])  # fmt: skip
    promised, z = taken_over(search, fits["east"], effects[1], own)
    assert z == pytest.approx([0.9, 0.0], abs=0.2)
    found = handed_over(search, fits, effects, "east")
    assert found["west"].log_evidence == pytest.approx(promised, abs=0.5)
    assert found["west"].log_evidence > fits["west"].log_evidence + 100.0


def test_an_effect_that_is_known_is_there_where_its_fit_begins() -> None:
    """The prediction without it is not taken for the one with it."""
    search = search_of({"east": 0.7, "n": 0.2})
    h, n = known("east", 0.7), np.array([0.2])
    model = Model(search.landings, NUISANCES, Warped())
    without = model.predict(n)
    assert without is not None
    point = Point(n, without, model.slopes(n, without), np.inf)
    fit = FitAt(search.landings, (*NUISANCES, *h.coordinates), point, np.array([0.2, 0.0]), steps=0)(Warped())
    assert fit is not None
    assert fit.predicted == pytest.approx(Model(search.landings, (*NUISANCES, *h.coordinates), Warped()).predict(fit.z))


def test_a_fit_arranged_otherwise_is_the_same_fit() -> None:
    search = search_of({"east": 0.7})
    fit = stuck(search, "east", (0.2, 0.7))
    other = arranged(fit, fit.coordinates[::-1])
    assert other.estimate(0) == pytest.approx(fit.estimate(1), rel=1e-12)
    assert other.jacobian @ other.z == pytest.approx(fit.jacobian @ fit.z)
    assert (other.objective, other.log_evidence) == pytest.approx((fit.objective, fit.log_evidence), rel=1e-12)
