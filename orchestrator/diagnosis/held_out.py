"""The gate: an effect must predict landings that it was not fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from operator import attrgetter

import numpy as np

from orchestrator.diagnosis.adequacy import adequacy
from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis
from orchestrator.diagnosis.search import Search, Told, UnflyableError, renoised
from orchestrator.diagnosis.setup import Setup
from orchestrator.diagnosis.stages import State, hear_noise
from orchestrator.diagnosis.verdict import ADEQUATE

STAGE = "held-out landing"


def posterior_of(fit: Fit, nuisances: int) -> list[Coordinate]:
    """The fit's own coordinates as a prior for another landing: its estimate with its standard deviation."""
    found = []
    for i in range(nuisances, len(fit.z)):
        c = fit.coordinates[i]
        value, sigma = fit.estimate(i)
        found.append(replace(c, mean=value, sigma=max(sigma, 1e-6 * c.sigma), positive=False, step=1.0))
    return found


def ask_holdouts(
    state: State, held: Setup, crew: Crew, seed: int, names: Sequence[str], told: Told | None = None
) -> tuple[dict[str, Fit], dict[str, tuple[float, float]]]:
    """Fits of nothing missing and of `names` to the held-out landings, each effect known only as the fitted landings left it."""
    search = Search(held.landings, held.nuisances, held.tolerances, crew, seed, told)
    null = search.base()
    hear_noise(held, crew, null)
    null = renoised(held.landings, null)
    fits: dict[str, Fit] = {}
    known = {name: Hypothesis(name, tuple(posterior_of(state.fits[name], len(state.search.nuisances)))) for name in names}
    for name, hypothesis in known.items():
        fit = search.fit_once(hypothesis, null, STAGE)
        if fit is None or adequacy(fit, held.landings).p < ADEQUATE:
            fit = climbed_with(held, hypothesis.coordinates, crew, seed, told)
        if fit is not None:
            null, fits[name] = exchanged(search, null, fit)
    if len(fits) > 1:  # they decide between these names: none is to lose for its nuisances alone
        best = min(fits, key=lambda name: fits[name].objective)
        fits = search.back_substituted(fits, list(known.values()), [name for name in fits if name != best], best, margin=np.inf)
    if fits:
        hear_noise(held, crew, next(iter(fits.values())), best=True)
    fits = {n: renoised(held.landings, fit) for n, fit in {NULL.name: null, **fits}.items()}
    evidence = fits[NULL.name].log_evidence
    gains = {n: (fit.log_evidence - evidence, adequacy(fit, held.landings).p) for n, fit in fits.items() if n != NULL.name}
    return fits, dict.fromkeys(names, (-np.inf, 0.0)) | gains


def climbed_with(held: Setup, own: Sequence[Coordinate], crew: Crew, seed: int, told: Told | None) -> Fit | None:
    """The nuisances fitted with the effect in from the first horizon on; None where that cannot be flown.

    A strong effect draws the fit of nothing missing, and whatever begins there, into false minima.
    """
    try:
        return Search(held.landings, held.nuisances, (*held.tolerances, *own), crew, seed, told).base()
    except UnflyableError:
        return None


def exchanged(search: Search, null: Fit, fit: Fit) -> tuple[Fit, Fit]:
    """Both fits, the worse of the two tried again from the other's nuisances: both are to be judged from the better valley."""
    count = len(null.z)
    if fit.objective < null.objective:
        (tried,) = search.refine_all([replace(null, z=fit.z[:count], slopes=fit.slopes[:, :count])], STAGE)
        return min(null, tried, key=attrgetter("objective")), fit
    z, slopes = np.append(null.z, fit.z[count:]), np.column_stack([null.slopes, fit.slopes[:, count:]])
    (tried,) = search.refine_all([replace(fit, z=z, slopes=slopes)], STAGE)
    return null, min(fit, tried, key=attrgetter("objective"))
