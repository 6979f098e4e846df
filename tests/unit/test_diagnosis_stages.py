"""The stages between the searches: when the noise's colour is judged without rest, and when a search begins anew."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnosis_samples import Ringing, coordinate, one_landing, ringing_landing
from numpy.typing import NDArray

from orchestrator.diagnosis import stages
from orchestrator.diagnosis.fit import Fit, seen_from
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis, joined
from orchestrator.diagnosis.landing import ATTITUDE, RATES, Course
from orchestrator.diagnosis.noise import Noise
from orchestrator.diagnosis.observation import Track
from orchestrator.diagnosis.problem import Model
from orchestrator.diagnosis.signatures import measures_between
from orchestrator.diagnosis.stages import State, hear_noise, run_search, try_pairs

Array = NDArray[np.float64]
TIMES = np.arange(0.02, 3.0, 0.02)
SIGMA, RHO = 0.01, 0.7
EFFECT = "damping"


def never_resting(random: np.random.Generator) -> SimpleNamespace:
    """Three rates with coloured noise, judged by a fit that predicts the truth."""
    tracks = []
    for channel in RATES:
        noise = random.standard_normal(len(TIMES))
        for k in range(1, len(noise)):
            noise[k] = RHO * noise[k - 1] + np.sqrt(1.0 - RHO**2) * noise[k]
        tracks.append(Track("rates", channel, channel, TIMES, SIGMA * noise, SIGMA, None))
    return SimpleNamespace(landings=one_landing(tracks, (), {}), names=["one"], addresses=None)


@pytest.mark.parametrize(("chi2", "rho"), [(1.0, RHO), (3.0, 0.0)], ids=["explains the data", "leaves more than noise"])
def test_colour_of_what_never_rests_is_judged_by_a_fit_that_explains_the_data_only(monkeypatch: Any, chi2: float, rho: float) -> None:
    setup = never_resting(np.random.default_rng(3))
    grid = np.linspace(0.0, 3.0, 301)
    moving = Course(grid, {name: np.ones(301) for name in (*RATES, *ATTITUDE)}, {})
    monkeypatch.setattr(stages, "look", lambda *_: moving)
    monkeypatch.setattr(stages, "contact_columns", lambda _: {})
    rows = setup.landings.size
    fit: Any = SimpleNamespace(
        coordinates=(), z=np.zeros(0), predicted=np.zeros(rows), chi2=chi2 * rows, jacobian=np.zeros((rows, 0)), covariance=np.zeros((0, 0))
    )
    hear_noise(setup, None, fit)  # type: ignore[arg-type]
    heard: list[Noise] = setup.landings.observations[0].noises
    assert [it.rho for it in heard] == pytest.approx([rho] * 3, abs=0.12)
    assert [it.sigma for it in heard] == pytest.approx([SIGMA] * 3, rel=0.2)


class Scripted:
    """A search that finds what it is told, and notes whether it was asked once more. null: φ of nothing missing after its rivals."""

    null = 0.0
    again: list[str]

    def __init__(self, *_: Any) -> None:
        type(self).again = []

    def base(self) -> Any:
        return fit(100.0)

    def refine_all(self, fits: list[Any], _: str) -> list[Any]:
        return fits

    def fit_all(self, *_: Any) -> dict[str, Any]:
        return {EFFECT: fit(60.0)}

    def explained_by(self, _: Any) -> bool:
        return True

    def refine_best(self, fits: dict[str, Any]) -> dict[str, Any]:
        return fits

    def back_substituted(self, fits: dict[str, Any], *_: Any) -> dict[str, Any]:
        return fits | {NULL.name: fit(self.null)}

    def once_more(self, _: Any, fits: dict[str, Any], best: str) -> dict[str, Any]:
        self.again.append(best)
        return fits


class Paired(Scripted):
    """Pairs: the wrong one is ahead until all are raced anew."""

    crew = None

    def raced_anew(self, fits: dict[str, Any], known: Any, base: Any) -> dict[str, Any]:
        assert {h.name for h in known} == set(fits), "every pair, and nothing but pairs"
        return fits | {RIGHT: fit(20.0)}

    def back_substituted(self, fits: dict[str, Any], known: Any, names: list[str], winner: str) -> dict[str, Any]:
        assert (winner, names) in ((WRONG, [EFFECT]), (RIGHT, [WRONG]))
        return fits


class Shown(Paired):
    """The effect alone does as well from the pair's nuisances."""

    def raced_anew(self, *_: Any) -> dict[str, Any]:
        raise AssertionError("no pair is worth a race")

    def back_substituted(self, fits: dict[str, Any], known: Any, names: list[str], winner: str) -> dict[str, Any]:
        return fits | {name: fit(29.5) for name in names}


WRONG, RIGHT = "damping + lag", "damping + step"


def test_pairs_are_raced_anew_before_one_is_believed(monkeypatch: Any) -> None:
    heard: list[Any] = []
    monkeypatch.setattr(stages, "hear_noise", lambda _, __, it, **___: heard.append(it) or [])
    monkeypatch.setattr(stages, "adequacy", lambda *_: SimpleNamespace(p=1e-6))
    found = {name: (Hypothesis(name, (), ()), fit(objective)) for name, objective in ((WRONG, 30.0), (RIGHT, 35.0))}
    monkeypatch.setattr(stages, "fit_seconds", lambda *_: found)
    handed: list[Any] = []
    monkeypatch.setattr(stages, "handed_over", lambda _, fits, known, leader: handed.append(([h.name for h in known], leader)) or fits)
    asked = []

    def handed_over_within(_: Any, best: Any, pair: Any, __: Any) -> list[Any]:
        asked.append(" + ".join(h.name for h in pair))
        return [(Hypothesis("slope + step", (), ()), fit(20.5))]

    monkeypatch.setattr(stages, "handed_over_within", handed_over_within)
    setup: Any = SimpleNamespace(landings=one_landing([], (), {}), nuisances=[], tolerances=())
    hypotheses = [Hypothesis(name, (), ()) for name in (EFFECT, "step", "lag", "slope")]
    state = State(setup, Paired(), fit(100.0), {NULL.name: fit(100.0), EFFECT: fit(60.0)}, hypotheses)  # type: ignore[arg-type]
    try_pairs(state)
    assert asked == [RIGHT], "nobody overtook it: it is asked once"
    assert "slope + step" in state.fits
    assert min(state.fits, key=lambda name: state.fits[name].objective) == RIGHT
    assert [it.objective for it in heard] == [20.0], "the noise is judged by the best pair"
    assert handed == [([EFFECT], WRONG), ([EFFECT], RIGHT)], "the first effect alone may do what the pair does"


def test_a_second_effect_that_only_shows_where_the_first_should_stand_is_let_go(monkeypatch: Any) -> None:
    """The axes of a gyro stood at 339.9, with a second effect at 329.5: alone, from that one's nuisances, they end at 331.3."""
    monkeypatch.setattr(stages, "adequacy", lambda *_: SimpleNamespace(p=0.5))
    monkeypatch.setattr(stages, "fit_seconds", lambda *_: {WRONG: (Hypothesis(WRONG, (), ()), fit(28.0))})
    monkeypatch.setattr(stages, "handed_over", lambda _, fits, *__: fits)
    setup: Any = SimpleNamespace(landings=one_landing([], (), {}), nuisances=[], tolerances=())
    state = State(setup, Shown(), fit(100.0), {NULL.name: fit(100.0), EFFECT: fit(60.0)}, [Hypothesis(EFFECT, (), ())])  # type: ignore[arg-type]
    try_pairs(state)
    assert {name: it.objective for name, it in state.fits.items()} == {NULL.name: 100.0, EFFECT: 29.5}


NUISANCE = coordinate("v")
DRAG, LIFT, TILT = (Hypothesis(name, (coordinate(name),)) for name in ("drag", "lift", "tilt"))
RINGS = ringing_landing({"drag": 0.3, "lift": 0.2})


def pair_at(first: Hypothesis, second: Hypothesis, z: tuple[float, float, float]) -> Fit:
    model, at = Model(RINGS, (NUISANCE, *first.coordinates, *second.coordinates), Ringing()), np.array(z)
    predicted = model.predict(at)
    assert predicted is not None
    return seen_from(model, at, predicted, model.slopes(at, predicted))


@pytest.mark.parametrize(("drag", "taken"), [(0.3, True), (0.0, False)], ids=["better", "worse"])
def test_a_pair_the_other_way_round_takes_its_own_place_where_it_is_better(drag: float, taken: bool) -> None:
    here = joined(DRAG, LIFT)
    before = pair_at(DRAG, LIFT, (0.0, 0.1, 0.2))
    setup, search = SimpleNamespace(landings=RINGS), SimpleNamespace(nuisances=(NUISANCE,))
    state = State(setup, search, before, {here.name: before}, [here])  # type: ignore[arg-type]
    stages._take_in(state, joined(LIFT, DRAG), pair_at(LIFT, DRAG, (0.0, 0.2, drag)))
    assert [h.name for h in state.hypotheses] == [here.name]
    assert list(state.fits) == [here.name]
    assert state.fits[here.name].coordinates == (NUISANCE, *here.coordinates)
    assert state.fits[here.name].z == pytest.approx([0.0, 0.3, 0.2] if taken else [0.0, 0.1, 0.2])


def test_what_would_decide_between_pairs_is_where_the_pairs_differ() -> None:
    """Drag and lift, or drag and tilt: y alone has the tilt, and more of it than x has of the lift."""
    fits = {joined(DRAG, h).name: pair_at(DRAG, h, (0.0, 0.3, 0.05)) for h in (LIFT, TILT)}
    state = State(SimpleNamespace(landings=RINGS), None, fits["drag + lift"], fits)  # type: ignore[arg-type]
    first = measures_between(state, ["drag + lift", "drag + tilt"])[0]
    assert first.channel == "y"
    assert first.reason.startswith("the two best, drag + lift and drag + tilt, differ most there")


class Racing(Scripted):
    """Nothing explains the data until as much has been tried as `explains_after` says."""

    explains_after = 0
    tried: list[str]

    def __init__(self, *_: Any) -> None:
        super().__init__()
        type(self).tried = []

    def explained_by(self, _: Any) -> bool:
        return len(self.tried) >= self.explains_after

    def race(self, _: Any, fits: dict[str, Any], __: Any) -> dict[str, Any]:
        self.tried.append("race")
        return fits


@pytest.mark.parametrize(("after", "tried"), [(0, []), (1, ["hand-over"]), (2, ["hand-over", "race"])])
def test_effects_race_where_neither_they_nor_a_hand_over_explain_the_data(monkeypatch: Any, after: int, tried: list[str]) -> None:
    monkeypatch.setattr(stages, "Search", Racing)
    monkeypatch.setattr(Racing, "explains_after", after)
    monkeypatch.setattr(stages, "hear_noise", lambda *_, **__: [])
    monkeypatch.setattr(stages, "renoised", lambda _, it: it)
    monkeypatch.setattr(stages, "adequacy", lambda *_: SimpleNamespace(p=0.5))
    monkeypatch.setattr(stages, "_substitute", lambda _: None)
    monkeypatch.setattr(stages, "handed_over", lambda search, fits, *_: search.tried.append("hand-over") or fits)
    setup: Any = SimpleNamespace(landings=one_landing([], (), {}), nuisances=[], tolerances=())
    state = run_search(setup, None, 0, None, [Hypothesis(EFFECT, (), ())])  # type: ignore[arg-type]
    assert Racing.tried == tried
    assert set(state.fits) == {NULL.name, EFFECT}


def fit(objective: float) -> Any:
    return SimpleNamespace(objective=objective, log_evidence=-objective)


@pytest.mark.parametrize(("null", "p", "again"), [(99.0, 0.5, False), (90.0, 0.5, True), (99.0, 1e-4, True)])
def test_a_search_that_was_misled_or_explains_too_little_begins_anew(monkeypatch: Any, null: float, p: float, again: bool) -> None:
    """Either nothing missing itself ends 8 of φ below where the search began, or the best leaves more than noise."""
    monkeypatch.setattr(stages, "Search", Scripted)
    monkeypatch.setattr(Scripted, "null", null)
    monkeypatch.setattr(stages, "hear_noise", lambda *_, **__: [])
    monkeypatch.setattr(stages, "renoised", lambda _, it: it)
    monkeypatch.setattr(stages, "adequacy", lambda *_: SimpleNamespace(p=p))
    monkeypatch.setattr(stages, "handed_over", lambda _, fits, *__: fits)
    setup: Any = SimpleNamespace(landings=one_landing([], (), {}), nuisances=[], tolerances=())
    state = run_search(setup, None, 0, None, [Hypothesis(EFFECT, (), ())])  # type: ignore[arg-type]
    assert Scripted.again == ([EFFECT] if again else [])
    assert state.fits[EFFECT].objective == 60.0


@pytest.mark.parametrize(("share", "refined"), [(1.02, False), (1.2, True)])
def test_fits_are_seen_by_the_noise_that_later_fits_are_made_under(monkeypatch: Any, share: float, refined: bool) -> None:
    """2 % of sigma over 387 rows are 8 in ln evidence: what is fitted later would be compared under another noise."""
    landings = ringing_landing({})
    (observation,) = landings.observations
    model = Model(landings, [coordinate("hump", 0.04)], Ringing())
    predicted = model.predict(np.zeros(1))
    assert predicted is not None
    before = {name: seen_from(model, np.zeros(1), predicted, np.ones((len(predicted), 1))) for name in (NULL.name, EFFECT)}
    asked: list[str] = []

    def refine_all(fits: list[Fit], stage: str) -> list[Fit]:
        asked.append(stage)
        return fits

    def hear(*_: Any, best: bool) -> list[Course]:
        observation.set_noise([Noise(share * n.sigma, n.rho, n.interval) for n in observation.noises])
        return []

    monkeypatch.setattr(stages, "hear_noise", hear)
    search: Any = SimpleNamespace(refine_all=refine_all)
    setup: Any = SimpleNamespace(landings=landings)
    state = State(setup, search, before[NULL.name], dict(before))
    stages._rehear(state, None)  # type: ignore[arg-type]
    for name, fit in state.fits.items():
        assert fit.chi2 == pytest.approx(before[name].chi2 / share**2)
    assert asked == (["finalists"] if refined else [])


def test_a_look_at_a_landing_has_every_column_that_was_measured() -> None:
    stroke = Track("struts", "leg+Z.primary.stroke", "leg1.primary.stroke", TIMES, np.zeros(len(TIMES)), 0.01, None)
    seen: list[Any] = []
    crew: Any = SimpleNamespace(run=lambda tasks: [seen.append(task) for task in tasks])
    setup: Any = SimpleNamespace(landings=one_landing([stroke], (), {}))
    stages.look(setup, crew, (), np.zeros(0), 0)
    assert seen[0].columns == (*RATES, *ATTITUDE, "leg1.primary.stroke")
