"""The gate: an effect must predict landings that it was not fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.adequacy import adequacy
from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hypothesis import NULL
from orchestrator.diagnosis.search import Search, Told, renoised
from orchestrator.diagnosis.setup import Setup
from orchestrator.diagnosis.stages import State, hear_noise

Array = NDArray[np.float64]
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
    fits: dict[str, Fit] = {}
    starts: list[Array] = []
    place = len(held.nuisances)
    for name in (NULL.name, *names):
        own = posterior_of(state.fits[name], len(state.search.nuisances)) if name != NULL.name else []
        search = Search(held.landings, [*held.nuisances, *own], held.tolerances, crew, seed, told)
        fits[name] = search.base([np.concatenate([z[:place], np.zeros(len(own)), z[place:]]) for z in starts])
        if name == NULL.name:
            starts = list(search.beginnings)
            hear_noise(held, crew, fits[name])
            fits[name] = renoised(held.landings, fits[name])
        else:
            fits[NULL.name], fits[name] = exchanged(search, fits[NULL.name], fits[name], range(place, place + len(own)))
    if names:
        hear_noise(held, crew, fits[names[0]])
    fits = {n: renoised(held.landings, fit) for n, fit in fits.items()}
    null = fits[NULL.name].log_evidence
    return fits, {n: (fits[n].log_evidence - null, adequacy(fits[n], held.landings).p) for n in names}


def exchanged(search: Search, null: Fit, fit: Fit, own: range) -> tuple[Fit, Fit]:
    """Both fits, the worse of the two tried again from the other's nuisances: both are to be judged from the better valley.

    own: columns of `fit` that `null` does not have
    """
    nuisances = np.delete(np.arange(len(fit.z)), own)
    if fit.objective < null.objective:
        (tried,) = search.refine_all([replace(null, z=fit.z[nuisances], slopes=fit.slopes[:, nuisances])], STAGE)
        return min(null, tried, key=_objective), fit
    z, slopes = fit.z.copy(), fit.slopes.copy()
    z[nuisances], slopes[:, nuisances] = null.z, null.slopes
    (tried,) = search.refine_all([replace(fit, z=z, slopes=slopes)], STAGE)
    return null, min(fit, tried, key=_objective)


def _objective(fit: Fit) -> float:
    return fit.objective
