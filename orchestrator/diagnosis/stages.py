"""The stages of a diagnosis as steps over one search: align, fit, judge the noise, try effects and pairs, ask the held-out landings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.adequacy import adequacy, freedom_used
from orchestrator.diagnosis.align import first_contact, swapped
from orchestrator.diagnosis.climb import explains
from orchestrator.diagnosis.coordinates import SHARED, Coordinate
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hand_over import arranged, handed_over, handed_over_within
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis, parts_of, turned_round
from orchestrator.diagnosis.landing import ATTITUDE, RATES, Course
from orchestrator.diagnosis.noise import TRUST, Noise, Stretch, noise_of
from orchestrator.diagnosis.observation import Observation
from orchestrator.diagnosis.pairs import fit_seconds
from orchestrator.diagnosis.recorded import contact_columns
from orchestrator.diagnosis.search import LEAST, Search, Told, renoised
from orchestrator.diagnosis.setup import Setup
from orchestrator.diagnosis.tasks.predict import Land
from orchestrator.diagnosis.verdict import ADEQUATE, BEATS, Judged, Judgement, contenders, credible, judge

Array = NDArray[np.float64]
GRID = 0.01  # s, of courses to look at
RESTING = 0.006  # rad/s
SETTLED = 0.15  # s after the last faster instant
PAIRED_WITH = 2  # singles that second effects are tried beside
WORTH_RACING = 2.0  # in ln evidence over any single: pairs that are raced
OVERTAKES = 6.0  # in ln evidence over an adequate single: pairs that are kept; about what their prior asks for
HAND_OVERS = 2  # from a winner, and from whoever overtakes it by that
MISLED = 8.0  # of φ: a base fit that proves so far from its best has misled the effects that were judged from it
FOUND = 0.05  # s, standard deviation of a clock that is not as the data say: 93 were 0.04 off RMS, 0.10 at most
ASKED = 8  # contenders; more of them are not told apart
NO_LAWS: Mapping[str, int] = MappingProxyType({})


@dataclass
class State:
    """A search with its fits so far."""

    setup: Setup
    search: Search
    base: Fit
    fits: dict[str, Fit] = field(default_factory=dict)
    hypotheses: list[Hypothesis] = field(default_factory=list)
    courses: list[Course] = field(default_factory=list)


def look(setup: Setup, crew: Crew, coordinates: Sequence[Coordinate], z: Array, landing: int, final: Sequence[str] = ()) -> Course | None:
    """A landing's course on a fine grid."""
    grid = np.arange(0.0, setup.landings.stop[landing] + 0.5 * GRID, GRID)
    columns = tuple(dict.fromkeys((*RATES, *ATTITUDE, *setup.landings.observations[landing].columns)))
    task = Land(setup.landings, tuple(coordinates), z, landing, grid, columns, tuple(final))
    course: Course | None = crew.run([task])[0]
    return course


def align(setup: Setup, crew: Crew) -> str:
    """Find where the data's clock has first contact, and refuse swapped axes: the complaint, or nothing."""
    for k, observation in enumerate(setup.landings.observations):
        dated = [] if observation.tracks else [r.column for r in observation.readings if r.kind == "time"]
        course = look(setup, crew, setup.nuisances, np.zeros(len(setup.nuisances)), k, dated)
        if course is None:
            continue
        observation.shift = first_contact(observation, course)
        if observation.shift != 0.0:
            setup.nuisances[:] = [
                replace(c, sigma=FOUND) if c.name == "time.origin" and c.landing in (SHARED, k) else c for c in setup.nuisances
            ]
        complaint = swapped(observation, course)
        if complaint:
            return f"{setup.names[k]}: {complaint}"
    return ""


def hear_noise(setup: Setup, crew: Crew, fit: Fit, best: bool = False) -> list[Course]:
    """Set the noise of every track from the stretch at rest, where that is short from what the fit leaves; gives the fit's courses.

    best: of all that were tried, so that what it leaves may be noise that is larger than stated.
    """
    courses = []
    channels = sum(len(o.tracks) for o in setup.landings.observations)
    size = setup.landings.size
    told = explains(fit.chi2, size) or (best and fit.chi2 <= size * (1.0 + 3.0 * np.hypot(np.sqrt(2.0 / size), 2.0 * TRUST)))
    followed = freedom_used(fit) / channels if channels and told else None
    for k, (observation, part) in enumerate(zip(setup.landings.observations, setup.landings.parts, strict=True)):
        course = look(setup, crew, fit.coordinates, fit.z, k, tuple(contact_columns(setup.addresses).values()))
        if course is None:
            continue
        courses.append(course)
        fast = np.max(np.abs([course.columns[name] for name in RATES]), axis=0) > RESTING
        rest = float(course.times[np.flatnonzero(fast)[-1]]) + SETTLED if fast.any() else 0.0
        observation.set_noise(_heard(observation, fit.predicted[part], rest, followed))
    return courses


def _heard(observation: Observation, predicted: Array, rest: float, followed: float | None) -> list[Noise]:
    """Noise of every track, series by series, from samples later than `rest`, s since first contact."""
    found: dict[int, Noise] = {}
    for places in observation.series.values():
        tracks = [observation.tracks[i] for i in places]
        stretches = [
            Stretch(t.times, observation.raw(predicted, i), t.times - observation.shift > rest, t.sigma)
            for i, t in zip(places, tracks, strict=True)
        ]
        found |= dict(zip(places, noise_of(stretches, tracks[0].colour, followed), strict=True))
    return [found[i] for i in range(len(observation.tracks))]


def run_search(setup: Setup, crew: Crew, seed: int, told: Told | None, hypotheses: Sequence[Hypothesis]) -> State:
    """Base, every hypothesis, the best refined, null and rivals once more from the winner's nuisances.

    Where no effect explains the data from the base fit on, the best is handed over to the others, and where that does not help, they race.
    """
    search = Search(setup.landings, setup.nuisances, setup.tolerances, crew, seed, told)
    base = search.base()
    courses = hear_noise(setup, crew, base)
    base = search.refine_all([renoised(setup.landings, base)], "base fit")[0]
    fits = search.fit_all(hypotheses, base) | {NULL.name: base}
    state = State(setup, search, base, fits, list(hypotheses), courses)
    if not search.explained_by(state.fits):
        _hand_over(state)
    if not search.explained_by(state.fits):
        state.fits = search.race(hypotheses, state.fits, base)
    state.fits = search.refine_best(state.fits)
    _substitute(state)
    misled = base.objective > state.fits[NULL.name].objective + MISLED
    _rehear(state, crew)
    best = _ranked(state)[0]
    if misled or (best != NULL.name and adequacy(state.fits[best], setup.landings).p < ADEQUATE):
        state.fits = search.once_more(state.hypotheses, state.fits, best)
        _substitute(state)
        _rehear(state, crew)
    return state


def _substitute(state: State) -> None:
    ranked = _ranked(state)
    if ranked[0] == NULL.name or state.fits[ranked[0]].log_evidence - state.fits[NULL.name].log_evidence < 2.0:
        return
    rivals = [n for n in ranked[1:4] if n != NULL.name]
    state.fits = state.search.back_substituted(state.fits, state.hypotheses, [NULL.name, *rivals], ranked[0])
    _hand_over(state)


def _hand_over(state: State) -> None:
    for _ in range(HAND_OVERS):
        winner = _ranked(state)[0]
        if winner == NULL.name:
            return
        state.fits = handed_over(state.search, state.fits, state.hypotheses, winner)
        if _ranked(state)[0] == winner:
            return


def _rehear(state: State, crew: Crew) -> None:
    """The noise judged again by the best fit's residual at rest; all fits seen anew, the best refined under it."""
    ranked = _ranked(state)
    before = [n for o in state.setup.landings.observations for n in o.noises]
    state.courses = hear_noise(state.setup, crew, state.fits[ranked[0]], best=True) or state.courses
    after = [n for o in state.setup.landings.observations for n in o.noises]
    if after == before:
        return
    state.fits = {name: renoised(state.setup.landings, fit) for name, fit in state.fits.items()}  # 2 % of sigma are 8 in ln evidence
    if all(abs(np.log(a.sigma / b.sigma)) < 0.05 and abs(a.rho - b.rho) < 0.05 for a, b in zip(after, before, strict=True)):
        return
    top = _ranked(state)[:4]
    top = top if NULL.name in top else [*top, NULL.name]
    state.fits |= dict(zip(top, state.search.refine_all([state.fits[n] for n in top], "finalists"), strict=True))


def try_pairs(state: State) -> None:
    """Second effects beside the best singles, where one alone is not adequate, or good enough to be named.

    What a first effect leaves of a second may pass for noise that is larger or more coloured than it is: adequacy alone would not ask.
    """
    singles = [n for n in _ranked(state) if n != NULL.name][:PAIRED_WITH]
    known = {h.name: h for h in state.hypotheses}
    if not singles:
        return
    best, null = state.fits[singles[0]], state.fits[NULL.name]
    if best.log_evidence < null.log_evidence + BEATS and adequacy(best, state.setup.landings).p >= ADEQUATE:
        return
    seconds = list(state.hypotheses)
    for name in singles:
        for pair, (hypothesis, fit) in fit_seconds(state.search, known[name], state.fits[name], seconds).items():
            if turned_round(pair) not in state.fits:
                state.fits[pair] = fit
                state.hypotheses.append(hypothesis)
    pairs = [name for name in state.fits if len(parts_of(name)) > 1]
    if pairs and _ahead(state, pairs) > WORTH_RACING:  # a second effect may have shown the first one alone where to stand
        leader = max(pairs, key=lambda name: state.fits[name].log_evidence)
        state.fits = state.search.back_substituted(state.fits, state.hypotheses, singles, leader)
        state.fits = handed_over(state.search, state.fits, [known[name] for name in singles], leader)
    if pairs and _ahead(state, pairs) > WORTH_RACING:
        _race_pairs(state)
        leader = max(pairs, key=lambda name: state.fits[name].log_evidence)
        state.fits = handed_over(state.search, state.fits, [known[name] for name in singles], leader)
        _hand_over_within(state, seconds)
        pairs = [name for name in state.fits if len(parts_of(name)) > 1]
    if _ahead(state, pairs) < OVERTAKES and adequacy(state.fits[singles[0]], state.setup.landings).p >= ADEQUATE:
        state.fits = {name: fit for name, fit in state.fits.items() if name not in pairs}
        state.hypotheses = [h for h in state.hypotheses if h.name not in pairs]


def _ahead(state: State, pairs: Sequence[str]) -> float:
    """The best pair's ln evidence over the best single's, or over nothing missing's."""
    together = max((state.fits[name].log_evidence for name in pairs), default=-np.inf)
    return together - max(fit.log_evidence for name, fit in state.fits.items() if name not in pairs)


def _race_pairs(state: State) -> None:
    """The best pairs once more from the first horizon on, and from the best pair's nuisances: beside a first effect alone a second sits
    in the minimum in which the first has put up with its absence.
    """
    pairs = {name: fit for name, fit in state.fits.items() if len(parts_of(name)) > 1}
    known = [h for h in state.hypotheses if h.name in pairs]
    raced = state.search.raced_anew(pairs, known, state.fits[NULL.name])
    changed = [name for name in pairs if raced[name] is not pairs[name]]
    pairs |= dict(zip(changed, state.search.refine_all([raced[name] for name in changed], "pairs"), strict=True))
    ranked = sorted(pairs, key=lambda name: -pairs[name].log_evidence)
    state.fits |= state.search.back_substituted(pairs, known, ranked[1:4], ranked[0])
    _rehear(state, state.search.crew)


def _hand_over_within(state: State, singles: Sequence[Hypothesis]) -> None:
    """Rivals of either effect of the best pair, beside the other one: a step under one pad is another's also where a second effect acts."""
    known = {h.name: h for h in singles}
    for _ in range(HAND_OVERS):
        leader = _ranked(state)[0]
        if len(parts_of(leader)) != 2:
            return
        first, second = (known[name] for name in parts_of(leader))
        for both, fit in handed_over_within(state.search, state.fits[leader], (first, second), singles):
            _take_in(state, both, fit)
        if _ranked(state)[0] == leader:
            return


def _take_in(state: State, pair: Hypothesis, fit: Fit) -> None:
    """A pair's fit where there was none, or a worse one, of the same two."""
    round_about = next((h for h in state.hypotheses if h.name == turned_round(pair.name)), None)
    if round_about is not None:
        pair, fit = round_about, arranged(fit, (*state.search.nuisances, *round_about.coordinates))
    if pair.name not in state.fits:
        state.hypotheses.append(pair)
    elif fit.objective > state.fits[pair.name].objective - LEAST:
        return
    state.fits[pair.name] = fit


def judged(
    state: State, holdouts: Mapping[str, tuple[float, float]], laws: Mapping[str, int] = NO_LAWS
) -> tuple[list[Judged], Judgement]:
    """All hypotheses, and the verdict. holdouts: name -> (gain, adequacy). laws: those outside the library -> how many were tried."""
    null = state.fits[NULL.name].log_evidence
    found = []
    for name, fit in state.fits.items():
        p = adequacy(fit, state.setup.landings).p
        gain, held = holdouts.get(name, (None, None))
        found.append(Judged(name, fit.log_evidence - null, p, gain, held, laws.get(name, 0)))
    return found, judge(found, _singles(state, laws))


def _ranked(state: State) -> list[str]:
    return sorted(state.fits, key=lambda n: -state.fits[n].log_evidence)


def promising(state: State) -> list[str]:
    """Effects that might be named by the fitted landings alone, and whose fit leaves no more than noise."""
    return _adequate_of(credible, state, NO_LAWS)


def to_be_asked(state: State, laws: Mapping[str, int] = NO_LAWS) -> list[str]:
    """Effects and laws that the held-out landings are to be asked about: those that contend, and whose fit leaves no more than noise."""
    return _adequate_of(contenders, state, laws)[:ASKED]


def _adequate_of(choose: Callable[[Sequence[Judged], int], tuple[str, ...]], state: State, laws: Mapping[str, int]) -> list[str]:
    found, _ = judged(state, {}, laws)
    adequate = {one.name for one in found if one.adequacy >= ADEQUATE}
    return [n for n in choose(found, _singles(state, laws)) if n in adequate]


def _singles(state: State, laws: Mapping[str, int]) -> int:
    return sum(1 for h in state.hypotheses if len(parts_of(h.name)) == 1 and h.name not in laws)
