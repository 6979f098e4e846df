"""Outside the library: the one call that looks for a generic term where no effect of the library explains the data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from orchestrator.diagnosis.adequacy import adequacy
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hand_over import begun_there, offers
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis, parts_of
from orchestrator.diagnosis.outcome import Estimate
from orchestrator.diagnosis.pairs import fit_seconds
from orchestrator.diagnosis.search import Search, Told
from orchestrator.diagnosis.setup import Setup
from orchestrator.diagnosis.stages import State
from orchestrator.diagnosis.terms.dictionary import dictionary, in_scenario
from orchestrator.diagnosis.terms.found import OF_A_CLASS, Found, Rival
from orchestrator.diagnosis.terms.linear import port_evidence, whitened
from orchestrator.diagnosis.terms.regress import Regression, best_of_library, regressed
from orchestrator.diagnosis.terms.stability import stability
from orchestrator.diagnosis.verdict import ADEQUATE, BEATS, HEARD

SECONDS = 12  # terms that are tried beside the first
COULD = 15.0, 0.25  # of ln evidence, or of what is to be beaten: a term that takes over from the best and promises so much less is no rival


def find_term(state: State, setup: Setup, crew: Crew, seed: int = 0, told: Told | None = None, beat: float = -np.inf) -> Found | None:
    """The best generic term that is not a refused effect of the library; None where none beats nothing missing.

    beat: ln evidence over nothing missing that it must come near to be of use
    Not where the search goes through the master: the dictionary is in the twin's names, and several hundred landings long.
    """
    if setup.why_slow:
        return None
    search = state.search
    search.crew, search.told = crew, told or search.told
    known = in_scenario(dictionary(), setup.addresses)
    regression = Regression(search, {n: term for n, (term, _) in known.items()}, {n: h for n, (_, h) in known.items()})
    tried = {part for name in state.fits for part in parts_of(name)}
    offered = [n for n, (term, _) in known.items() if not tried & {n, term.equals}]
    base = state.fits.get(NULL.name, state.base)
    best = best_of_library(state.fits)
    if best is not None and np.isfinite(beat):
        regression.keep(_taking_over(search, best, [known[n][1] for n in offered], beat))
        if not regression.fits:
            return None
    winner = regressed(regression, base, best, offered)
    null = base.log_evidence
    if winner is None or regression.fits[winner].log_evidence - null < BEATS:
        return None
    found = told_of(regression, winner, set(offered), null, seed)
    return with_second(regression, found, offered, null)


def _taking_over(search: Search, best: Fit, terms: Sequence[Hypothesis], beat: float) -> dict[str, Fit]:
    """Terms that do nearly as well in the place of the best fit's effect: by the slopes there, and fitted from where they lead.

    None that does no better than nothing missing, which is `beat` behind the best.
    """
    least = best.log_evidence - min(max(COULD[0], COULD[1] * beat), beat - HEARD)
    promised = offers(search, best, terms)
    near = [h for h in terms if promised[h.name][0] > least]
    return {name: fit for name, fit in begun_there(search, best, near, promised).items() if fit.log_evidence > least}


def adopt(state: State, found: Found) -> None:
    """Its fit and hypothesis among the state's, so that the held-out landings can be asked about it like about any effect."""
    state.fits[found.name] = found.fit
    state.hypotheses.append(found.hypothesis)


def forsake(state: State, found: Found) -> None:
    """Out of the state again."""
    del state.fits[found.name]
    state.hypotheses.remove(found.hypothesis)


def told_of(regression: Regression, winner: str, offered: set[str], null: float, seed: int) -> Found:
    """What the regression says of its winner."""
    search, terms, fit = regression.search, regression.terms, regression.fits[winner]
    evidence = regression.evidence
    best = evidence[winner]
    near = sorted((n for n in evidence if n != winner and evidence[n] > best - OF_A_CLASS), key=lambda n: -evidence[n])
    ports = port_evidence(evidence, regression.ports)
    top = max(ports.values())
    last = next(view for view in reversed(regression.views) if winner in view.columns)
    stable = stability(whitened(search.landings, search.nuisances, last), search.landings, winner, regression.ports, offered, seed)
    p = adequacy(fit, search.landings).p
    return Found(
        terms[winner],
        Estimate(*fit.estimate(len(search.nuisances)), terms[winner].measure),
        best - null,
        p,
        p >= ADEQUATE,
        tuple(Rival(terms[n], best - evidence[n], regression.size(n)) for n in near if n in offered),
        stable,
        {port: value - top for port, value in ports.items()},
        regression.hypotheses[winner],
        fit,
        {n: value - null for n, value in evidence.items()},
        tuple(dict.fromkeys(terms[n].equals for n in near if n not in offered and terms[n].equals)),
    )


def with_second(regression: Regression, found: Found, offered: list[str], null: float) -> Found:
    """A second term beside the first, where that is not adequate alone and the pair is better by BEATS."""
    if found.adequate:
        return found
    others = [regression.hypotheses[n] for n in regression.ranked(offered) if n != found.name][:SECONDS]
    pairs = fit_seconds(regression.search, found.hypothesis, found.fit, others)
    name = max(pairs, key=lambda n: pairs[n][1].log_evidence, default=None)
    if name is None or pairs[name][1].log_evidence < found.fit.log_evidence + BEATS:
        return found
    return _paired(regression, found, *pairs[name], null)


def _paired(regression: Regression, first: Found, pair: Hypothesis, fit: Fit, null: float) -> Found:
    place = len(regression.search.nuisances)
    term = regression.terms[pair.coordinates[1].name]
    p = adequacy(fit, regression.search.landings).p
    sizes = [Estimate(*fit.estimate(place + i), one.measure) for i, one in enumerate((first.term, term))]
    whole = replace(first, log_evidence=fit.log_evidence - null, adequacy=p, adequate=p >= ADEQUATE, fit=fit, hypothesis=pair)
    second = replace(whole, term=term, coefficient=sizes[1], rivals=(), stability={}, known_as=())
    return replace(whole, coefficient=sizes[0], second=second)


__all__ = ["adopt", "find_term", "forsake", "told_of", "with_second"]
