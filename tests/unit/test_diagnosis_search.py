"""The whole search on a landing that is a formula: it names what was put in, and is not caught where nuisances hide it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pytest
from diagnosis_samples import RINGING, Formula, Line, Ringing, coordinate, one_landing, ringing, ringing_landing, tracks
from numpy.typing import NDArray

from orchestrator.diagnosis.adequacy import adequacy
from orchestrator.diagnosis.crew import Crew, content, counted
from orchestrator.diagnosis.fit import Fit, fitted
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis
from orchestrator.diagnosis.landing import Course
from orchestrator.diagnosis.pairs import fit_seconds
from orchestrator.diagnosis.problem import Model
from orchestrator.diagnosis.search import Search, UnflyableError
from orchestrator.diagnosis.tasks import probe as probe_task
from orchestrator.diagnosis.tasks.fits import FitAt, Point, point_of
from orchestrator.diagnosis.tasks.probe import Probe
from orchestrator.diagnosis.verdict import Judged, judge

Array = NDArray[np.float64]
NUISANCES = (coordinate("v", 0.1), coordinate("w", 0.1), coordinate("phase", 0.1), coordinate("tilt", 0.02))
SIZES = {"lift": 0.3, "drag": 0.5, "stiff": 1.0, "bias": 0.8, "kick": 0.5, "hump": 0.2}
EFFECTS = [Hypothesis(name, (coordinate(name, size),), ((0.5 * size,), (-0.5 * size,))) for name, size in SIZES.items()]
HIDDEN = {"v": 1.12, "w": 0.52, "phase": -0.08, "tilt": 0.01}


def searched(changed: Mapping[str, float]) -> tuple[dict[str, Fit], list[Judged], Search]:
    landings = ringing_landing({**HIDDEN, **changed}, seed=1)
    search = Search(landings, NUISANCES, (), Crew(ringing))
    base = search.base()
    fits = search.refine_best(search.fit_all(EFFECTS, base) | {NULL.name: base})
    null = fits[NULL.name].log_evidence
    return fits, [Judged(n, f.log_evidence - null, adequacy(f, landings).p) for n, f in fits.items()], search


@pytest.mark.parametrize(("name", "size"), [("drag", 0.3), ("stiff", 0.7), ("bias", -0.5), ("kick", 0.4), ("hump", 0.15)])
def test_a_hidden_effect_is_named_with_its_size(name: str, size: float) -> None:
    fits, judged, _ = searched({name: size})
    found = judge(judged, len(EFFECTS))
    assert (found.verdict, found.names) == ("effect", (name,)), judged
    value, sigma = fits[name].estimate(len(NUISANCES))
    assert value == pytest.approx(size, abs=4.0 * sigma)


def test_where_nothing_is_hidden_nothing_is_missing() -> None:
    _, judged, _ = searched({})
    assert judge(judged, len(EFFECTS)).verdict == "nothing_missing"


def test_what_a_nuisance_can_do_as_well_is_not_named() -> None:
    _, judged, _ = searched({"lift": 0.1})
    assert judge(judged, len(EFFECTS)).names != ("lift",)


def test_two_hidden_effects_are_found_as_a_pair() -> None:
    fits, judged, search = searched({"drag": 0.4, "bias": 0.5})
    assert judge(judged, len(EFFECTS)).verdict == "none_of_my_effects"
    best = max((n for n in fits if n != NULL.name), key=lambda n: fits[n].log_evidence)
    pairs = fit_seconds(search, next(h for h in EFFECTS if h.name == best), fits[best], EFFECTS)
    null = fits[NULL.name].log_evidence
    judged += [Judged(n, f.log_evidence - null, adequacy(f, search.landings).p) for n, (_, f) in pairs.items()]
    found = judge(judged, len(EFFECTS))
    assert (found.verdict, set(found.names)) == ("effects", {"drag", "bias"})


@pytest.mark.parametrize("missing", [{}, {"drag": 0.4}])
def test_a_library_without_effects_leaves_the_base_fit_alone(missing: Mapping[str, float]) -> None:
    search = Search(ringing_landing({**HIDDEN, **missing}, seed=1), NUISANCES, (), Crew(ringing))
    base = search.base()
    assert search.raced_anew(search.fit_all([], base), [], base) == {}


def test_a_race_leaves_whoever_stood_better_before_where_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    search = Search(ringing_landing({**HIDDEN, "drag": 0.4, "bias": 0.5}, seed=1), NUISANCES, (), Crew(ringing))
    base = search.base()
    fits = search.fit_all(EFFECTS, base)
    assert not search.explained_by(fits)
    monkeypatch.setattr(search, "refine_all", lambda fits, _: fits)
    low, high = replace(fits["lift"], residual=0.0 * fits["lift"].residual), replace(fits["drag"], residual=2.0 * fits["drag"].residual)
    raced = search.race(EFFECTS, {**fits, "lift": low, "drag": high}, base)
    assert raced["lift"] is low
    assert raced["drag"].objective < high.objective


class Refused(Ringing):
    """A lander that lands nothing."""

    def land(
        self, values: Mapping[str, float], grid: Array, columns: Sequence[str], final: Sequence[str], beside: object = None
    ) -> Course | None:
        return None


def test_a_landing_that_cannot_be_flown_is_no_fit() -> None:
    with pytest.raises(UnflyableError):
        Search(ringing_landing(HIDDEN), NUISANCES, (), Crew(Refused)).base()


def test_the_base_fit_does_not_depend_on_the_number_of_workers() -> None:
    landings = ringing_landing({**HIDDEN, "drag": 0.05}, seed=1)
    found = []
    for workers in (1, 2):
        crew = Crew(ringing, workers)
        found.append(content(Search(landings, NUISANCES, (), crew).base()))
        crew.close()
    assert found[0] == found[1]


class Trap(Formula):
    """x = n + e, and y sees n in folds: beside the wrong n, the slope by e points away from the truth."""

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        n, e = values["n"], values["e"]
        if name == "x":
            return np.full(len(t), n + e)
        return np.asarray(0.143 * (1.0 - np.cos(11.0 * n)) + 0.3 * n + (0.25 + 0.28 * t) * e)


def test_a_probe_escapes_the_minimum_in_which_nuisances_hold_the_effect() -> None:
    times = np.arange(0.05, 2.0, 0.05)
    landings = one_landing(tracks(Trap(), {"n": 0.0, "e": 2.0}, ("x", "y"), times, 0.4, 4), (), {"n": 0.0, "e": 0.0})
    coordinates = (coordinate("n"), coordinate("e"))
    alone = Model(landings, coordinates[:1], Trap())
    z = min((np.array([n]) for n in np.linspace(-0.5, 3.5, 201)), key=lambda z: _phi(alone, z))
    predicted = alone.predict(z)
    assert predicted is not None
    here = Point(z, predicted, alone.slopes(z, predicted), np.inf)
    caught = FitAt(landings, coordinates, here, np.append(z, 0.0), 8, (0,))(Trap())
    free = Probe(landings, coordinates, here, ())(Trap())
    assert caught is not None
    assert free is not None
    assert abs(caught.z[1]) < 0.5, "this trap catches nobody: the test shows nothing"
    assert free.z[1] == pytest.approx(2.0, abs=0.3)
    assert free.objective < caught.objective - 10.0


def _phi(model: Model, z: Array) -> float:
    predicted = model.predict(z)
    assert predicted is not None
    r = model.residual(predicted)
    return 0.5 * float(r @ r + z @ z)


PAIRS = ("a", "b", "c")


class Turned(Formula):
    """Pairs of nuisances seen in axes that the effect turns by 1.2 rad: turned back by hand, they hold all of it but a faint line."""

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        v, e = values, values["e"]
        if name == "line":
            return 0.12 * e * t
        x, y, turn = v[f"{name[0]}1"], v[f"{name[0]}2"], 1.2 * e
        return np.full(len(t), x * np.cos(turn) - y * np.sin(turn) if name[1] == "1" else x * np.sin(turn) + y * np.cos(turn))


def test_a_probe_makes_slopes_anew_around_what_it_holds() -> None:
    """Those of the base fit lead nowhere there, and the effect would be dropped as hopeless: soil damping of a sealed case was."""
    times = np.arange(0.05, 2.0, 0.05)
    names = [f"{pair}{k}" for pair in PAIRS for k in (1, 2)]
    base = dict.fromkeys([*names, "e"], 0.0)
    truth = dict(zip(names, (1.0, 0.5, -0.8, 0.9, 0.3, -1.1), strict=True)) | {"e": 1.0}
    landings = one_landing(tracks(Turned(), truth, (*names, "line"), times, 0.1, 4), (), base)
    coordinates = tuple(coordinate(name) for name in [*names, "e"])
    alone = Model(landings, coordinates[:-1], Turned())
    z = np.zeros(len(names))
    predicted = alone.predict(z)
    assert predicted is not None
    absorbed = fitted(alone, z, alone.slopes(z, predicted), predicted)
    assert absorbed is not None
    fit = Probe(landings, coordinates, point_of(absorbed), ())(Turned())
    assert fit is not None
    assert fit.z[-1] == pytest.approx(1.0, abs=0.1)
    assert fit.objective < absorbed.objective - 20.0


def test_a_probe_that_costs_what_the_slopes_foresee_ends_after_one_landing(monkeypatch: pytest.MonkeyPatch) -> None:
    """y = a + b t without a slope: held at λ = 64 it costs 32 of φ, as foreseen; with nothing foreseen four steps are tried."""
    times = np.arange(0.05, 2.0, 0.05)
    landings = one_landing(tracks(Line(), {"a": 0.0, "b": 0.0}, ("y",), times, 0.1, 4), (), {"a": 0.0, "b": 0.0})
    alone = Model(landings, (coordinate("a"),), Line())
    z = np.zeros(1)
    predicted = alone.predict(z)
    assert predicted is not None
    probe = Probe(landings, (coordinate("a"), coordinate("b")), Point(z, predicted, alone.slopes(z, predicted), np.inf), ())
    soon, fit = counted(probe, Line())
    monkeypatch.setattr(probe_task, "AS_FORESEEN", (9.0, 9.0))
    late, other = counted(probe, Line())
    assert soon < late
    assert fit.objective == pytest.approx(other.objective)


class Grained(Ringing):
    """Its own steps leave 0.02 to chance, here by the values' last digits; beside another landing it takes that one's."""

    varies = True

    def land(
        self,
        values: Mapping[str, float],
        grid: Array,
        columns: Sequence[str],
        final: Sequence[str],
        beside: Mapping[str, float] | None = None,
    ) -> Course | None:
        course = super().land(values, grid, columns, final)
        chance = 0.02 * np.sin(1e7 * sum((beside or values).values()))
        return course and Course(grid, {name: column + chance for name, column in course.columns.items()}, course.final)


def test_slopes_are_differences_of_landings_beside_each_other() -> None:
    """Where each chooses its own steps, chance over a difference of 0.02 is as large as the slope itself."""
    landings = one_landing(tracks(Ringing(), RINGING, ("x", "y"), np.arange(0.02, 2.0, 0.02), 0.01, 2), (), RINGING)
    z = np.full(len(NUISANCES), 0.1)
    exact, found = (Model(landings, NUISANCES, lander) for lander in (Ringing(), Grained()))
    clean, seen = exact.predict(z), found.predict(z)
    assert clean is not None
    assert seen is not None
    assert np.allclose(found.slopes(z, seen), exact.slopes(z, clean), atol=0.05)
    apart = found.predict(z + 1e-6)
    assert apart is not None
    assert np.abs(apart - seen).max() > 0.005


def test_hypotheses_start_from_the_nuisances_without_the_effect() -> None:
    landings = one_landing(tracks(Ringing(), RINGING, ("x", "y"), np.arange(0.02, 2.0, 0.02), 0.01, 2), (), RINGING)
    search = Search(landings, NUISANCES, (), Crew(ringing))
    base = search.base()
    drag = next(h for h in EFFECTS if h.name == "drag")
    fit = search.fit_all([drag], base)["drag"]
    point = search.without(fit)
    assert point is not None
    assert np.array_equal(point.predicted, Model(landings, NUISANCES, Ringing()).predict(fit.z[: len(NUISANCES)]))


def test_the_base_values_of_the_formula_are_complete() -> None:
    assert set(RINGING) >= set(SIZES)
    assert Ringing().column("x", RINGING, np.zeros(1))[0] == 1.0
