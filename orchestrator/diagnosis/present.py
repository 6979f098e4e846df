"""After the verdict: the co-simulation's proof, the revised scenario, and what the report draws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.before_after import before_after, write_before_after
from orchestrator.diagnosis.believed import belief_of, fitted_values, without_effect
from orchestrator.diagnosis.crew import Crew, Store
from orchestrator.diagnosis.diagnose import Diagnosis, Request
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.flight import CoSimulation
from orchestrator.diagnosis.found_term import write_effect
from orchestrator.diagnosis.hypothesis import NULL, parts_of
from orchestrator.diagnosis.landing import Course
from orchestrator.diagnosis.moves import Named
from orchestrator.diagnosis.observation import ORIGIN, SEEN, Observation, sampled
from orchestrator.diagnosis.outcome import Candidate
from orchestrator.diagnosis.places import PLACES
from orchestrator.diagnosis.problem import Model, Nobody
from orchestrator.diagnosis.proof import NULL as BEFORE
from orchestrator.diagnosis.proof import WINNER, Observed, Proof, prove
from orchestrator.diagnosis.recorded import contact_columns
from orchestrator.diagnosis.report import ChannelCourse, Contact, LandingCourses, RestValue, verdict_sentence, write_report
from orchestrator.diagnosis.report.words import unit_of
from orchestrator.diagnosis.revision import REVISED, inserts_of, write_landing, write_revision
from orchestrator.diagnosis.setup import Setup
from orchestrator.diagnosis.stages import look
from orchestrator.diagnosis.tasks.predict import Predict
from orchestrator.diagnosis.term_fmu import build_term_fmu
from orchestrator.diagnosis.terms.found import Found, as_term
from orchestrator.errors import OrchestratorError
from orchestrator.scenario.locate import find_fmu

Array = NDArray[np.float64]
LEFT = ("report.html", REVISED, "landing_*.toml", "before_after.*", "figures/*.png", "courses/*", "found/*")
"""What a verdict leaves in its folder beside diagnosis.json."""


def present(request: Request, diagnosis: Diagnosis) -> None:
    """diagnosis.json, report.html and, where an effect is named, revised.toml, into the request's folder.

    Where the co-simulation fails, the search's verdict is written all the same, and the error raised then.
    """
    outcome, setup, state = diagnosis.outcome, diagnosis.setup, diagnosis.state
    request.out.mkdir(parents=True, exist_ok=True)
    clear_earlier(request)
    outcome.write(request.out)
    courses: list[LandingCourses] = []
    failed: OrchestratorError | None = None
    if setup is not None and state is not None:
        proof = None
        try:
            proof = _proven(request, diagnosis)
        except OrchestratorError as error:
            failed = error
            outcome.warnings.append(f"the co-simulation has proved nothing: {error}")
        courses = _courses(request, diagnosis, proof)
    outcome.sentence = verdict_sentence(outcome)
    write_report(request.out, outcome, courses)
    outcome.write(request.out)
    if failed is not None:
        raise type(failed)(f"{failed} (the search's verdict is in {request.out}: {outcome.sentence})") from failed


def clear_earlier(request: Request) -> None:
    """Remove what an earlier verdict left in the request's folder: its revised scenario would stand beside a report that names nothing.

    What this request was given stays: its scenario, and effects in folders below.
    """
    given = [request.scenario.resolve(), *(it.resolve() for it in request.effects)]
    for pattern in LEFT:
        for path in request.out.glob(pattern):
            if path.is_file() and not any(path.resolve() == it or path.resolve().is_relative_to(it) for it in given):
                path.unlink()


def chosen(diagnosis: Diagnosis) -> str:
    """The hypothesis that the verdict stands for; nothing missing where it names none."""
    names = {e.name for e in diagnosis.outcome.effects}
    if diagnosis.found is not None:
        return diagnosis.found.name
    if diagnosis.state is None or not names:
        return NULL.name
    return next((n for n in diagnosis.state.fits if set(parts_of(n)) == names), NULL.name)


def _named(diagnosis: Diagnosis, name: str) -> list[Named]:
    """Effects of a hypothesis with what its own fit estimated."""
    if diagnosis.found is not None and diagnosis.setup is not None and name == diagnosis.found.name:
        return [as_term(one, diagnosis.setup.addresses).named() for one in diagnosis.found.both]
    found: dict[str, Candidate] = {c.name: c for c in diagnosis.outcome.candidates}
    if diagnosis.state is None or name not in found:
        return []
    if name == chosen(diagnosis):
        return [Named(diagnosis.effects[e.name], e.parameters) for e in diagnosis.outcome.effects]
    return [Named(diagnosis.effects[p], found[name].parameters) for p in parts_of(name) if p in diagnosis.effects]


def _proven(request: Request, diagnosis: Diagnosis) -> Proof | None:
    outcome, setup, state = diagnosis.outcome, diagnosis.setup, diagnosis.state
    if setup is None or state is None:
        return None
    name = chosen(diagnosis)
    simulation = CoSimulation(request.scenario, request.overrides)
    try:
        named = _named(diagnosis, name)
        winner = belief_of(setup.addresses, WINNER, _fits(diagnosis, name), inserts_of(named)) if named else None
        ablated = without_effect(setup.addresses, "without", _fits(diagnosis, name), len(state.search.nuisances)) if named else None
        rival = next((c.name for c in outcome.candidates if c.name not in (NULL.name, name) and len(parts_of(c.name)) == len(named)), "")
        placebo = (
            belief_of(setup.addresses, rival, _fits(diagnosis, rival), inserts_of(_named(diagnosis, rival))) if named and rival else None
        )
        null = belief_of(setup.addresses, BEFORE, _fits(diagnosis, NULL.name))
        proof = prove(simulation, _observed(diagnosis), null, winner, ablated, placebo)
        _take_over(diagnosis, proof)
        if named:
            _revise(request, diagnosis, named, name, proof.numerics.settings)
        write_before_after(request.out, before_after(proof))
        return proof
    finally:
        simulation.close()


def _take_over(diagnosis: Diagnosis, proof: Proof) -> None:
    """What the co-simulation says takes the place of what the search said."""
    outcome = diagnosis.outcome
    outcome.checks, outcome.simulations = proof.checks, outcome.simulations + proof.simulations
    outcome.warnings += proof.warnings
    if outcome.effects or diagnosis.found:
        outcome.gap = proof.gap
    if not proof.numerics.ok:
        outcome.verdict = "numerics"
        outcome.warnings += [proof.numerics.reason] if proof.numerics.reason else []
    outcome.sentence = ""  # it had the search's verdict and gap


def _revise(request: Request, diagnosis: Diagnosis, named: Sequence[Named], name: str, master: Mapping[str, float]) -> None:
    setup, outcome = diagnosis.setup, diagnosis.outcome
    if setup is None:
        return
    titles = [e.title for e in outcome.effects] or [it.effect.title for it in named]
    title = f"{setup.addresses.blueprint.scenario.table.title}, with {' and '.join(it.lower() for it in titles)}"
    source = f"found by orchestrator diagnose; see {request.out / 'report.html'}"
    revised = write_revision(request.out, setup.addresses, named, title, [source], master, request.overrides)
    outcome.revised_scenario = str(revised)
    for found in diagnosis.found.both if diagnosis.found is not None else ():
        _keep_term(request, found, setup)
    for k, applied in enumerate(fitted_values(setup.addresses, setup.landings, diagnosis.state.fits[name] if diagnosis.state else None)):  # type: ignore[arg-type]
        write_landing(request.out, k + 1, revised, applied.values, applied.seen, setup.names[k])


def _keep_term(request: Request, found: Found, setup: Setup) -> None:
    """The found term as an entry for the library, and as an FMU of its own for any FMI tool."""
    term = as_term(found, setup.addresses)
    write_effect(request.out / "found", term)
    place = term.coefficient.partition(".")[0]
    units = setup.addresses.units(place)
    fmu = setup.addresses.blueprint.interfaces[units[0]].path if units else find_fmu(PLACES[place], setup.addresses.folder, "found term")
    if fmu is not None:
        own = {address.partition(".")[2]: value for address, value in {**term.fixed, term.coefficient: term.estimate.value}.items()}
        build_term_fmu(request.out / "found", fmu, own, f"{fmu.stem}With{term.name.title().replace('_', '')}", term.physics)


def _fits(diagnosis: Diagnosis, name: str) -> list:  # type: ignore[type-arg]
    """(landings, fit), of the fitted ones and, where it was asked of them, the held-out ones."""
    setup, held, state = diagnosis.setup, diagnosis.held, diagnosis.state
    if setup is None or state is None:
        return []
    found = [(setup.landings, state.fits[name])]
    if held is not None and name in diagnosis.holdout_fits:
        found.append((held.landings, diagnosis.holdout_fits[name]))
    return found


def _observed(diagnosis: Diagnosis) -> list[Observed]:
    found = []
    for setup, holdout in ((diagnosis.setup, False), (diagnosis.held, True)):
        if setup is None or (holdout and not diagnosis.holdout_fits):
            continue
        for name, observation, stop in zip(setup.names, setup.landings.observations, setup.landings.stop, strict=True):
            found.append(Observed(name, observation, stop, holdout))
    return found


# Courses


def _courses(request: Request, diagnosis: Diagnosis, proof: Proof | None) -> list[LandingCourses]:
    setup, held, state = diagnosis.setup, diagnosis.held, diagnosis.state
    if setup is None or state is None:
        return []
    name, found = chosen(diagnosis), []
    for one, fits, kind in ((setup, state.fits, "fit"), (held, diagnosis.holdout_fits, "holdout")):
        if one is None or NULL.name not in fits:
            continue
        crew = Crew(one.make, 1, Store(None))
        try:
            means = np.zeros(len(one.nuisances))
            (flown,) = crew.run([Predict(one.landings, tuple(one.nuisances), (means,))])[0]
            raw = np.full(one.landings.size, np.nan) if flown is None else flown
            for k in range(len(one.names)):
                found.append(_landing(one, crew, k, raw, fits[NULL.name], fits.get(name) if name != NULL.name else None, proof, kind))
        finally:
            crew.close()
    return [it for it in found if it is not None]


def _landing(
    setup: Setup, crew: Crew, k: int, raw: Array, null: Fit, after: Fit | None, proof: Proof | None, kind: str
) -> LandingCourses | None:
    """raw: prediction of the scenario as it stands, of all landings; NaN where one of them cannot be flown."""
    observation, name = setup.landings.observations[k], setup.names[k]
    touched = contact_columns(setup.addresses)
    final = tuple(touched.values())
    first = look(setup, crew, setup.nuisances, np.zeros(len(setup.nuisances)), k, final)
    fitted = look(setup, crew, null.coordinates, null.z, k, final)
    then = look(setup, crew, after.coordinates, after.z, k, final) if after is not None else None
    if first is None or fitted is None:
        return None
    proven = {it.belief: it.predicted for it in (proof.flown if proof else []) if it.landing == name and it.holdout == (kind == "holdout")}
    before, improved = proven.get(BEFORE), proven.get(WINNER)
    part = setup.landings.parts[k]
    before = null.predicted[part] if before is None else before
    improved = after.predicted[part] if after is not None and improved is None else improved
    spread = _spread(after, part) if after is not None else None
    sides = [(first, {}), (fitted, _seen(setup, null, k)), (then, _seen(setup, after, k))]
    channels = [_channel(observation, i, sides, before, improved, spread) for i in range(len(observation.tracks))]
    rest = [_rest(observation, i, raw[part], before, improved) for i in range(len(observation.readings))]
    shown, seen = next((course, seen) for course, seen in reversed(sides) if course is not None)
    contact = observation.shift + seen.get(ORIGIN, 0.0)
    contacts = [Contact(leg, shown.final[c] + contact) for leg, c in touched.items() if shown.final[c] >= 0.0]
    return LandingCourses(name, "holdout" if kind == "holdout" else "fit", channels, rest, contacts, shift=observation.shift)


def _seen(setup: Setup, fit: Fit | None, k: int) -> dict[str, float]:
    """What a fit says of the data's clocks in landing k."""
    if fit is None:
        return {}
    values = Model(setup.landings, fit.coordinates, Nobody()).values(fit.z, k)
    return {name: value for name, value in values.items() if name.startswith(SEEN)}


def _spread(fit: Fit, part: slice) -> Array:
    """Standard deviation of the prediction from what is not known of the parameters."""
    slopes = fit.slopes[part]
    return np.asarray(np.sqrt(np.einsum("ij,jk,ik->i", slopes, fit.covariance, slopes)))


def _channel(
    observation: Observation,
    i: int,
    sides: Sequence[tuple[Course | None, Mapping[str, float]]],
    before: Array,
    after: Array | None,
    spread: Array | None,
) -> ChannelCourse:
    """sides: as it stands, fitted, with the effect: each a course with what its fit says of the data's clocks."""
    track, place, noise = observation.tracks[i], observation.places[i], observation.noises[i]
    last = float(track.times[-1]) - observation.shift + 0.1
    early = min(float(track.times[0]) - observation.shift, 0.0)
    shown = sides[1][0]
    assert shown is not None
    grid = np.concatenate([np.arange(early, 0.0, 0.01), shown.times[shown.times <= last]])
    late = [observation.late(track, seen) - observation.shift for _, seen in sides]
    first, fitted, then = (None if c is None else sampled(c, track.column, grid - s) for (c, _), s in zip(sides, late, strict=True))
    band = None if spread is None else np.interp(grid + observation.shift, track.times, spread[place])
    residual = None if after is None else (track.readings - after[place]) / noise.sigma
    assert first is not None
    unit = unit_of(track.channel).removeprefix("1")
    return ChannelCourse(
        track.series, track.channel, unit, track.times, track.readings, noise.sigma, grid + observation.shift,
        first, fitted, then, band, (track.readings - before[place]) / noise.sigma, residual,
    )  # fmt: skip


def _rest(observation: Observation, i: int, raw: Array, before: Array, after: Array | None) -> RestValue:
    reading, row = observation.readings[i], observation.places[len(observation.tracks) + i].start
    value = None if reading.interval else reading.value
    low, high, edge = (reading.low, reading.high, reading.edge) if reading.interval else (None, None, None)
    sigma = None if reading.interval else reading.sigma
    then = None if after is None else float(after[row])
    return RestValue(reading.name, reading.unit, float(raw[row]), float(before[row]), then, value, sigma, low, high, edge)
