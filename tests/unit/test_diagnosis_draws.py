"""From one horizon to the next by draws of the posterior: they find the minimum that the fit's own place leads away from."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pytest
from diagnosis_samples import RINGING, Formula, Line, Ringing, coordinate, line, one_landing, tracks
from numpy.typing import NDArray

from orchestrator.diagnosis import held_out
from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.fit import Fit, fitted
from orchestrator.diagnosis.held_out import climbed_again, climbed_with, exchanged
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis
from orchestrator.diagnosis.observation import ORIGIN, Track
from orchestrator.diagnosis.problem import Landings, Model
from orchestrator.diagnosis.search import Search, Told
from orchestrator.diagnosis.setup import Setup
from orchestrator.diagnosis.tasks.begin import Timed
from orchestrator.diagnosis.tasks.draw import Draw
from orchestrator.diagnosis.tasks.fits import Climb

Array = NDArray[np.float64]
EARLY = 0.5  # s
TIMES = np.arange(0.1, 2.0, 0.1)


class Turning(Formula):
    """At first a itself; later a point turned by 9 a, its radius 1 + 0.3 a: from 0.38 the way down leads to a whole turn, 0.70."""

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        a = values["a"]
        late = (1.0 + 0.3 * a) * (np.cos(9.0 * a) if name == "x" else np.sin(9.0 * a))
        return np.where(t < EARLY, a, late)


def turning() -> Turning:
    return Turning()


def turning_landing(a: float = 0.0) -> Landings:
    """True is a = 0; the early readings say 0.38, with little certainty. a: what the scenario says."""
    lander = Turning()
    noisy = tracks(lander, {"a": 0.0}, ("x", "y"), TIMES, 0.05, 3)
    early, late = TIMES < EARLY, TIMES > EARLY
    tracked = [
        Track("early", "x", "x", TIMES[early], np.full(early.sum(), 0.38), 0.6, 0.0),
        *(Track("late", t.channel, t.column, TIMES[late], t.readings[late], 0.05, 0.0) for t in noisy),
    ]
    return one_landing(tracked, (), {"a": a, "idle": 0.0})


def fit_at(landings: Landings, coordinates: tuple[Coordinate, ...], lander: Formula, z: Array, horizon: float = np.inf) -> Fit:
    model = Model(landings, coordinates, lander, horizon)
    predicted = model.predict(z)
    assert predicted is not None
    fit = fitted(model, z, model.slopes(z, predicted), steps=20, renew=tuple(range(len(z))), renewals=5)
    assert fit is not None
    return fit


def test_draws_find_the_minimum_beside_which_the_fit_stands() -> None:
    landings, only = turning_landing(), (coordinate("a"),)
    early = fit_at(landings, only, Turning(), np.zeros(1), EARLY)
    assert early.z[0] == pytest.approx(0.35, abs=0.05)
    caught = fit_at(landings, only, Turning(), early.z)
    assert caught.z[0] > 0.5, "nobody is caught here: the test shows nothing"
    (point,) = Draw(landings, early, np.inf, 60, 1)(Turning())
    found = Climb(landings, only, point)(Turning())
    assert found is not None
    assert found.z[0] == pytest.approx(0.0, abs=0.01)
    assert found.objective < caught.objective - 10.0


def test_effects_caught_are_freed_by_racing_anew() -> None:
    """Two effects that are the same but for their priors, both caught where the fit at hand leads."""
    landings, idle = turning_landing(0.2), coordinate("idle")
    effects = [Hypothesis(name, (coordinate("a", sigma),)) for name, sigma in (("near", 1.0), ("wide", 1.1))]
    search = Search(landings, (idle,), (), Crew(turning))
    search.horizons = (EARLY, np.inf)
    base = search.base()
    fits = {h.name: fit_at(landings, (idle, *h.coordinates), Turning(), np.array([0.0, 0.2])) for h in effects}
    assert all(fit.z[1] > 0.3 for fit in fits.values()), "nobody is caught here: the test shows nothing"
    freed = search.raced_anew(fits, effects, base)
    assert {name: float(fit.z[1]) for name, fit in freed.items()} == pytest.approx({"near": -0.2, "wide": -0.2 / 1.1}, abs=0.01)


def test_draws_tell_the_slopes() -> None:
    """Of a linear landing 60 draws leave 1/61 of what was wrong about the slopes, in the mean over all directions."""
    coordinates = (coordinate("a"), coordinate("b"))
    landings = one_landing(tracks(Line(), {"a": 0.3, "b": -0.2}, ("y",), TIMES, 0.1, 5), (), {"a": 0.0, "b": 0.0})
    fit = fit_at(landings, coordinates, line(), np.zeros(2))
    (best, *_) = Draw(landings, fit, np.inf, 60, 1, np.zeros((len(TIMES), 2)))(line())
    assert best.slopes == pytest.approx(np.column_stack([np.ones(len(TIMES)), TIMES]), rel=0.05)


def test_no_draw_is_better_than_a_fit_that_stands() -> None:
    coordinates = (coordinate("a"), coordinate("b"))
    landings = one_landing(tracks(Line(), {"a": 0.3, "b": -0.2}, ("y",), TIMES, 0.1, 5), (), {"a": 0.0, "b": 0.0})
    fit = fit_at(landings, coordinates, line(), np.zeros(2))
    (best, *_) = Draw(landings, fit, np.inf, 60, 1)(line())
    assert best.z == pytest.approx(fit.z)


@pytest.mark.parametrize("late", [-0.11, 0.0, 0.07])
def test_each_draw_is_judged_at_the_time_of_contact_that_suits_it(late: float) -> None:
    """A clock known to 50 ms: whatever zero was drawn, the one taken is right to the step of the times tried (5 ms)."""
    tracked = [replace(t, times=t.times + late) for t in tracks(Ringing(), RINGING, ("x", "y"), np.arange(0.02, 1.0, 0.02), 0.01, 5)]
    landings = one_landing(tracked, (), RINGING)
    coordinates = (coordinate("v", 0.1), Coordinate("time.origin", ((ORIGIN, 1.0),), 0.05))
    for drawn in (-1.5, 0.3):
        (found,) = Timed(landings, coordinates, (np.array([0.0, drawn]),), 0.8)(Ringing())
        assert found is not None
        assert 0.05 * found[1][1] == pytest.approx(late, abs=5.5e-3)


def test_draws_stay_on_their_side_of_a_limit() -> None:
    coordinates = (coordinate("a", positive=True), coordinate("b"))
    landings = one_landing(tracks(Line(), {"a": 0.0, "b": 0.1}, ("y",), TIMES, 0.5, 5), (), {"a": 0.0, "b": 0.0})
    fit = fit_at(landings, coordinates, line(), np.zeros(2))
    points = Draw(landings, fit, np.inf, 40, 41)(line())
    assert len(points) == 41
    assert all(point.z[0] >= 0.0 for point in points)
    assert len({float(point.z[0]) for point in points}) > 35


@pytest.mark.parametrize("caught", ["null", "effect"])
def test_on_a_held_out_landing_whoever_is_caught_is_freed_by_the_other(caught: str) -> None:
    """Turning is the nuisance here; the effect moves nothing."""
    landings, only, both = turning_landing(), (coordinate("a"),), (coordinate("a"), coordinate("idle"))
    trap, free = np.array([0.35]), np.zeros(1)
    null = fit_at(landings, only, Turning(), trap if caught == "null" else free)
    fit = fit_at(landings, both, Turning(), np.array([*(trap if caught == "effect" else free), 0.0]))
    assert abs(null.objective - fit.objective) > 10.0, "nobody is caught here: the test shows nothing"
    search = Search(landings, both, (), Crew(turning))
    assert [f.z[0] for f in exchanged(search, null, fit)] == pytest.approx([0.0, 0.0], abs=0.01)


class Lifted(Turning):
    """Turning whose early readings an effect lifts."""

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        return super().column(name, values, t) + np.where(t < EARLY, values["lift"], 0.0)


def lifted() -> Lifted:
    return Lifted()


def test_on_a_held_out_landing_the_nuisances_are_fitted_anew_with_the_effect_in() -> None:
    """Without the effect the nuisance is drawn a whole turn away, and put in there the effect does not free it."""
    tracked = tracks(Lifted(), {"a": 0.0, "lift": 0.7}, ("x", "y"), TIMES, 0.02, 3)
    landings = one_landing(tracked, (), {"a": 0.0, "lift": 0.0})
    nuisances, own = [coordinate("a")], [Coordinate("lift", (("lift", 1.0),), 0.03, mean=0.7)]
    search = Search(landings, nuisances, (), Crew(lifted))
    drawn_away = search.base()
    caught = search.fit_once(Hypothesis("lift", tuple(own)), drawn_away, "held-out landing")
    assert caught is not None
    assert caught.z[0] > 0.3, "nobody is caught here: the test shows nothing"
    held = Setup(None, lifted, {}, landings, ["held"], nuisances, [], [])  # type: ignore[arg-type]
    found = climbed_with(held, own, Crew(lifted), 0, None)
    assert found is not None
    assert found.z[0] == pytest.approx(0.0, abs=0.01)
    assert found.chi2 < 2.0 * landings.size < caught.chi2


@pytest.mark.parametrize(("freed_by", "ends_at", "climbs"), [(2, 0.0, [1, 2]), (9, 0.7, [1, 2, 3])])
def test_on_a_held_out_landing_the_best_is_climbed_from_other_draws_until_it_leaves_noise(
    freed_by: int, ends_at: float, climbs: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Climbs end in the trap but for those from the draws of `freed_by`; none is made once the fit is adequate."""
    landings, only, own = turning_landing(), (coordinate("a"),), (coordinate("idle"),)
    trapped, free = (fit_at(landings, (*only, *own), Turning(), np.array([a, 0.0])) for a in (0.35, 0.0))
    held = Setup(None, turning, {}, landings, ["held"], list(only), [], [])  # type: ignore[arg-type]
    asked: list[int] = []

    def climb(held: Setup, own: Sequence[Coordinate], crew: Crew, seed: int, told: Told | None) -> Fit:
        asked.append(seed)
        return free if seed == freed_by else trapped

    monkeypatch.setattr(held_out, "climbed_with", climb)
    monkeypatch.setattr(held_out, "hear_noise", lambda *_, best: [])
    null = fit_at(landings, only, Turning(), np.array([0.35]))
    search = Search(landings, only, (), Crew(turning))
    fits = climbed_again(search, held, {"idle": Hypothesis("idle", own)}, {NULL.name: null, "idle": trapped}, 0)
    assert asked == climbs
    assert [fits[name].z[0] for name in (NULL.name, "idle")] == pytest.approx([ends_at, ends_at], abs=0.01)
