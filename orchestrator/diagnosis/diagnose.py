"""`orchestrator diagnose`: all stages from folders of measured data to a verdict, a revised scenario and a report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import perf_counter

import numpy as np

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.adequacy import adequacy
from orchestrator.diagnosis.crew import Crew, Store
from orchestrator.diagnosis.effects.effect import Effect
from orchestrator.diagnosis.effects.library import LIBRARY, load_library
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.held_out import ask_holdouts
from orchestrator.diagnosis.hypothesis import NULL, parts_of
from orchestrator.diagnosis.locate import located
from orchestrator.diagnosis.measured import faults, read_measured
from orchestrator.diagnosis.measured.landing import Measured
from orchestrator.diagnosis.origin import code, flown_otherwise, flown_units, provenance
from orchestrator.diagnosis.outcome import Candidate, CannotTell, Estimate, Gap, NamedEffect, Outcome
from orchestrator.diagnosis.recorded import contact_columns
from orchestrator.diagnosis.report import verdict_sentence as sentence
from orchestrator.diagnosis.search import UnflyableError
from orchestrator.diagnosis.setup import Setup, names_of, set_up
from orchestrator.diagnosis.signatures import measures_between, not_excited
from orchestrator.diagnosis.stages import State, align, judged, promising, run_search, to_be_asked, try_pairs
from orchestrator.diagnosis.terms.find_term import adopt, find_term, forsake
from orchestrator.diagnosis.terms.found import Found, to_outcome
from orchestrator.diagnosis.verdict import Judged, Judgement
from orchestrator.errors import ScenarioError, UserError
from orchestrator.scenario.locate import scenario_folder

Told = Callable[[str, str, float], None]
PLACE_OF = {
    "soil.normal": "soil",
    "soil.tangential": "soil",
    "soil.shape": "soil",
    "strut": "gear",
    "engine": "guidance",
    "initial": "body",
}
SHOWN = 12  # rivals listed


@dataclass
class Request:
    """What the user asked for."""

    scenario: Path
    measured: Sequence[Path]
    holdout: Sequence[Path] = ()
    effects: Sequence[Path] = ()
    out: Path = Path("results/diagnosis")
    seed: int = 0
    workers: int = 2
    overrides: Sequence[str] = ()
    budget: int = 20000
    """Landings after which only what the verdict needs is flown: no second effects, no rivals on the held-out landings."""


@dataclass
class Diagnosis:
    """The outcome, and what the report and the co-simulation need beyond it."""

    outcome: Outcome
    setup: Setup | None = None
    held: Setup | None = None
    state: State | None = None
    holdout_fits: dict[str, Fit] = field(default_factory=dict)
    effects: dict[str, Effect] = field(default_factory=dict)
    judgement: Judgement | None = None
    found: Found | None = None
    """A term outside the library."""


def library(request: Request) -> dict[str, Effect]:
    """The project's effects and the user's own."""
    return load_library([beside_scenarios(LIBRARY.name), *request.effects])


def diagnose(request: Request, told: Told | None = None) -> Diagnosis:
    """The search and its verdict. What is reported of the co-simulation comes later (`prove`)."""
    began = perf_counter()
    blueprint = draw_up(read_scenario(request.scenario, request.overrides), request.scenario)
    measured, held = [read_measured(p) for p in request.measured], [read_measured(p) for p in request.holdout]
    effects = library(request)
    outcome = Outcome(
        "nothing_missing",
        scenario=str(request.scenario),
        measured=[str(p) for p in request.measured],
        holdout=[str(p) for p in request.holdout],
    )
    tolerances = beside_scenarios("tolerances.toml")
    names = names_of([one.folder for one in (*measured, *held)])
    setup = set_up(blueprint, measured, effects, tolerances, request.overrides, names[: len(measured)])
    outcome.titles = {name: effect.title for name, effect in effects.items()}
    outcome.warnings += [f"effect {name} is left out: {why}" for name, why in setup.skipped.items()]
    if setup.why_slow:
        outcome.warnings.append(f"searched through the master, with {len(setup.hypotheses)} effects: {setup.why_slow}")
    units = flown_units(setup.addresses)
    told_besides = {"seed": request.seed, "budget": request.budget, "set": list(request.overrides)}
    outcome.provenance = provenance(request.scenario, [*request.measured, *request.holdout], units, told_besides)
    if _faulty(outcome, [*measured, *held]):
        return Diagnosis(outcome, setup, effects=effects)
    slow = flown_otherwise(setup.addresses, request.scenario, request.overrides) if setup.why_slow else ""
    crew = Crew(setup.make, request.workers, Store(request.out / ".work", units, code() + slow))
    try:
        kept_out = set_up(blueprint, held, {}, tolerances, request.overrides, names[len(measured) :]) if held else None
        return _searched(request, setup, kept_out, crew, outcome, effects, told, began)
    except BaseException:
        crew.abandon()
        raise
    finally:
        crew.close()


def _searched(
    request: Request,
    setup: Setup,
    held: Setup | None,
    crew: Crew,
    outcome: Outcome,
    effects: dict[str, Effect],
    told: Told | None,
    began: float,
) -> Diagnosis:
    for one in (setup, held):
        complaint = align(one, crew) if one is not None else ""
        if complaint:
            outcome.verdict, outcome.faults = "data_fault", [{"channel": "", "what": complaint, "from_s": None, "to_s": None}]
            outcome.sentence = sentence(outcome)
            return Diagnosis(outcome, setup, held, effects=effects)
    try:
        state = run_search(setup, crew, request.seed, told, setup.hypotheses)
    except UnflyableError:
        raise _unflyable(request, setup) from None
    if crew.flown < request.budget:
        try_pairs(state)
    diagnosis = Diagnosis(outcome, setup, held, state, effects=effects)
    names = promising(state)
    try:
        law = _law_outside(request, diagnosis, crew, names, told) if names and crew.flown < request.budget else None
        verdicts, judgement = _judged(request, diagnosis, crew, law, told)
    except UnflyableError:
        raise _unflyable(request, held or setup) from None
    diagnosis.judgement = judgement
    if judgement.verdict == "none_of_my_effects" and diagnosis.found is None and crew.flown < request.budget:
        try:
            _look_outside(request, diagnosis, crew, told)
        except UnflyableError:
            raise _unflyable(request, held or setup) from None
    fill(diagnosis, verdicts, judgement)
    outcome.simulations = crew.flown
    outcome.seconds = perf_counter() - began
    outcome.sentence = sentence(outcome)
    return diagnosis


def _unflyable(request: Request, setup: Setup) -> UserError:
    return UserError(f"{request.scenario}: cannot be flown from the prior means of {', '.join(setup.names)}; check the priors")


def _asked(diagnosis: Diagnosis, crew: Crew, seed: int, names: Sequence[str], told: Told | None) -> dict[str, tuple[float, float]]:
    """What the held-out landings say of these: name -> (gain, adequacy); nothing without such landings. Keeps their fits."""
    held, state = diagnosis.held, diagnosis.state
    if held is None or state is None or not names:
        return {}
    fits, gains = ask_holdouts(state, held, crew, seed, names, told)
    diagnosis.holdout_fits = {**diagnosis.holdout_fits, **fits}
    return gains


def _law_outside(request: Request, diagnosis: Diagnosis, crew: Crew, names: Sequence[str], told: Told | None) -> Found | None:
    """The law outside the library that comes nearest to the effects that would be named; its nuisances are offered to these.

    Two effects at once can imitate much: a torque with the yaw angle came out as friction under two pads.
    """
    setup, state = diagnosis.setup, diagnosis.state
    if setup is None or state is None:
        return None
    beat = max(state.fits[name].log_evidence for name in names) - state.fits[NULL.name].log_evidence
    found = find_term(state, setup, crew, request.seed, told, beat)
    if found is None or not found.adequate or found.second is not None:  # two laws at once have no such prior
        return None
    adopt(state, found)
    state.fits = state.search.back_substituted(state.fits, state.hypotheses, names[:2], found.name)
    forsake(state, found)
    return found


def _judged(
    request: Request, diagnosis: Diagnosis, crew: Crew, law: Found | None, told: Told | None
) -> tuple[list[Judged], Judgement]:
    """The verdict on the effects and, where there is one, on a law outside the library beside them."""
    state = diagnosis.state
    if state is None:
        raise ValueError("a verdict needs a search")
    names, gains = to_be_asked(state), {}
    if law is not None:
        laws = {law.name: len(law.regressed)}
        adopt(state, law)
        asked = to_be_asked(state, laws)
        if law.name in asked:
            gains = _asked(diagnosis, crew, request.seed, asked, told)
            verdicts, judgement = judged(state, gains, laws)
            if law.name in judgement.answers:
                return verdicts, _with_law(diagnosis, judgement, law, names)
        forsake(state, law)
    wanted = names if crew.flown < request.budget else names[:1]
    return judged(state, gains if gains.keys() >= set(wanted) else _asked(diagnosis, crew, request.seed, wanted, told))


def _with_law(diagnosis: Diagnosis, judgement: Judgement, law: Found, names: Sequence[str]) -> Judgement:
    """The law into the outcome: put forward where it is the answer, beside the effects where it is one of several."""
    outcome = diagnosis.outcome
    outcome.titles[law.name] = f"{law.words[:1].upper()}{law.words[1:]} (not in the library)"
    if judgement.verdict == "cannot_tell":
        outcome.term = to_outcome(law)
        return judgement
    _put_forward(diagnosis, law)
    outcome.term["instead_of"] = names[0]
    return replace(judgement, why=f"{names[0]} would be named, but {law.words}, which is not in the library, is more probable")


def _look_outside(request: Request, diagnosis: Diagnosis, crew: Crew, told: Told | None) -> None:
    """Generic terms, where no effect of the library will do."""
    setup, state = diagnosis.setup, diagnosis.state
    if setup is None or state is None:
        return
    found = find_term(state, setup, crew, request.seed, told)
    if found is None:
        return
    if not found.adequate:
        diagnosis.outcome.warnings.append(f"nearest of the generic terms: {found.words}; it leaves more than noise, and is not put forward")
        return
    adopt(state, found)
    gains = _asked(diagnosis, crew, request.seed, [found.name], told)
    if gains and gains[found.name][0] <= 0.0:
        forsake(state, found)
        diagnosis.outcome.warnings.append(f"{found.words}: worse than nothing missing on the held-out landing, and not put forward")
        return
    _put_forward(diagnosis, found)


def _put_forward(diagnosis: Diagnosis, found: Found) -> None:
    """The term into the outcome, with what it closes on the held-out landings."""
    held, closure = diagnosis.held, None
    if held is not None:
        fits = diagnosis.holdout_fits
        before, after, count = fits[NULL.name].chi2, fits[found.name].chi2, held.landings.size
        closure = 1.0 - max(after - count, 0.0) / (before - count) if before > count else None
    diagnosis.found = found
    diagnosis.outcome.term = to_outcome(found, closure)


def fill(diagnosis: Diagnosis, verdicts: Sequence[Judged], judgement: Judgement) -> None:
    """The outcome's members from the fits."""
    outcome, state, setup = diagnosis.outcome, diagnosis.state, diagnosis.setup
    if state is None or setup is None:
        return
    null = state.fits[NULL.name]
    outcome.verdict = judgement.verdict
    outcome.readings, outcome.chi2_null, outcome.adequacy_null = setup.landings.size, null.chi2, adequacy(null, setup.landings).p
    known = {v.name: v for v in verdicts}
    ranked = sorted(known, key=lambda n: -judgement.probabilities[n])
    outcome.candidates = [_candidate(diagnosis, known[n], judgement) for n in ranked[:SHOWN]]
    best = diagnosis.found.fit if diagnosis.found else state.fits[ranked[0]]
    adopted = null if judgement.verdict == "nothing_missing" else best
    if judgement.verdict in ("effect", "effects"):
        whole = next(n for n in ranked if set(parts_of(n)) == set(judgement.names))
        adopted = best = state.fits[whole]
        outcome.effects = [_named(diagnosis, n, whole, judgement.probabilities[whole]) for n in judgement.names]
    if judgement.verdict == "cannot_tell":
        tracks = measures_between(state, judgement.answers)
        outcome.cannot_tell = CannotTell(list(judgement.names), tracks, list(judgement.answers))
    if judgement.why:
        outcome.warnings.append(judgement.why)
    outcome.not_excited = [name for name in not_excited(state) if name in diagnosis.effects]
    ports = {n: (e.port, PLACE_OF.get(e.port, e.port)) for n, e in diagnosis.effects.items()}
    close = {n: f for n, f in state.fits.items() if n in ports and f.log_evidence > null.log_evidence + 2.0}
    several = len(setup.names) > 1
    outcome.where = located(null, setup.landings, close, ports, setup.names if several else ())
    _fill_gap(diagnosis, best, ranked)
    _fill_nuisances(outcome, adopted, state)
    for k, observation in enumerate(setup.landings.observations):
        for track, noise in zip(observation.tracks, observation.noises, strict=True):
            channel = f"{track.channel} ({k + 1})" if several else track.channel
            outcome.noise[channel] = {"stated": track.sigma, "used": noise.sigma, "colour": noise.rho}
    if state.courses:
        touched = {leg: state.courses[0].final[name] for leg, name in contact_columns(setup.addresses).items()}
        outcome.events = {f"contact {leg}": time for leg, time in touched.items() if time >= 0.0}


def _fill_gap(diagnosis: Diagnosis, best: Fit, ranked: Sequence[str]) -> None:
    outcome, state, setup = diagnosis.outcome, diagnosis.state, diagnosis.setup
    if state is None or setup is None:
        return
    n, null = setup.landings.size, state.fits[NULL.name]
    gap = Gap(float(np.sqrt(null.chi2 / n)), float(np.sqrt(best.chi2 / n)))
    before, after, count = null.chi2, best.chi2, n
    held = diagnosis.held
    chosen = diagnosis.found.name if diagnosis.found else next((x for x in ranked if state.fits[x] is best), "")
    if held is not None and chosen in diagnosis.holdout_fits:
        count = held.landings.size
        before, after = diagnosis.holdout_fits[NULL.name].chi2, diagnosis.holdout_fits[chosen].chi2
        gap.holdout_before, gap.holdout_after = float(np.sqrt(before / count)), float(np.sqrt(after / count))
    if chosen != NULL.name and before > count:
        gap.closure = 1.0 - max(after - count, 0.0) / (before - count)
    outcome.gap = gap


def _fill_nuisances(outcome: Outcome, best: Fit, state: State) -> None:
    spread = np.sqrt(np.diag(best.covariance))
    for i, c in enumerate(state.search.nuisances):
        name = c.name if c.landing < 0 else f"{c.name} ({c.landing + 1})"
        value, sigma = c.value(float(best.z[i])), c.sigma * float(spread[i])
        outcome.nuisances[name] = {"value": value, "sigma": sigma, "prior_sigma": c.sigma, "pull": float(best.z[i])}


def _candidate(diagnosis: Diagnosis, one: Judged, judgement: Judgement) -> Candidate:
    state = diagnosis.state
    if state is None:
        raise ValueError("a candidate needs a search")
    fit, first = state.fits[one.name], len(state.search.nuisances)
    titles = [diagnosis.outcome.titles.get(n, n) for n in parts_of(one.name)]
    owners = [n for n in parts_of(one.name) for _ in (diagnosis.effects[n].parameters if n in diagnosis.effects else "1")]
    estimates = [Estimate(*fit.estimate(i), fit.coordinates[i].unit) for i in range(first, len(fit.z))]
    parameters = _by_name([(n, c.name, it) for n, c, it in zip(owners, fit.coordinates[first:], estimates, strict=True)])
    p = judgement.probabilities[one.name]
    return Candidate(
        one.name, " + ".join(titles) or "Nothing missing", one.log_evidence, fit.chi2, p, one.adequacy, one.holdout_gain, parameters
    )


def _by_name(estimates: Sequence[tuple[str, str, Estimate]]) -> dict[str, Estimate]:
    """(effect, parameter, estimate) by parameter; by effect.parameter where both effects of a pair call one alike."""
    names = [name for _, name, _ in estimates]
    return {name if names.count(name) == 1 else f"{effect}.{name}": estimate for effect, name, estimate in estimates}


def _named(diagnosis: Diagnosis, name: str, whole: str, probability: float) -> NamedEffect:
    state, effect = diagnosis.state, diagnosis.effects[name]
    if state is None:
        raise ValueError("a named effect needs a search")
    fit, place = state.fits[whole], len(state.search.nuisances)
    for part in parts_of(whole):
        count = len(diagnosis.effects[part].parameters)
        if part == name:
            chosen = range(place, place + count)
            parameters = {fit.coordinates[i].name: Estimate(*fit.estimate(i), fit.coordinates[i].unit) for i in chosen}
            return NamedEffect(name, effect.title, PLACE_OF.get(effect.port, effect.port), parameters, probability)
        place += count
    raise ValueError(f"{name} is not in {whole}")


def _faulty(outcome: Outcome, measured: Sequence[Measured]) -> bool:
    found = [(one, fault) for one in measured for fault in faults(one)]
    outcome.faults = [
        {"channel": f"{one.folder.name}: {fault.channel}", "what": fault.what, "from_s": fault.from_s, "to_s": fault.to_s}
        for one, fault in found
    ]
    if found:
        outcome.verdict = "data_fault"
        outcome.sentence = sentence(outcome)
    return bool(found)


def beside_scenarios(name: str) -> Path:
    """A file or folder of the project's scenarios folder; ScenarioError where there is none."""
    own = Path(__file__).resolve().parents[2] / "scenarios"
    for folder in (scenario_folder() or own, own):
        if (folder / name).exists():
            return folder / name
    raise ScenarioError(f"scenarios/{name}: is neither here nor above; change to the project's folder")
