"""Two effects at once: second ones beside a first, judged by their slopes there, the best of them fitted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hypothesis import Hypothesis, joined
from orchestrator.diagnosis.problem import Model, Nobody
from orchestrator.diagnosis.search import Search
from orchestrator.diagnosis.tasks.fits import FitAt, point_of
from orchestrator.diagnosis.tasks.predict import slopes_beside

Array = NDArray[np.float64]
SECONDS = 6  # second effects fitted beside a first
WORTH = 1.0  # in ln evidence: what the slopes must promise beyond the first
STAGE = "second effects"


def fit_seconds(search: Search, first: Hypothesis, fit: Fit, hypotheses: Sequence[Hypothesis]) -> dict[str, tuple[Hypothesis, Fit]]:
    """Pairs with a first effect by name, with their fits; the best two refined."""
    others = [h for h in hypotheses if h.name != first.name and not h.slots & first.slots]
    starts = {h.name: np.concatenate([fit.z, np.zeros(len(h.coordinates))]) for h in others}
    asks = [slopes_beside(search.landings, fit.coordinates, fit.z, fit.predicted, h.coordinates) for h in others]
    own = search.run(STAGE, asks)
    worth = {h.name: _promised(search, fit, h, starts[h.name], slopes) for h, slopes in zip(others, own, strict=True)}
    chosen = [h for h in sorted(others, key=lambda h: -worth[h.name])[:SECONDS] if worth[h.name] > fit.log_evidence + WORTH]
    tasks = [FitAt(search.landings, (*fit.coordinates, *h.coordinates), point_of(fit), starts[h.name], 5, search.fresh) for h in chosen]
    found = {}
    for h, pair in zip(chosen, search.run(STAGE, tasks), strict=True):
        if pair is not None:
            both = joined(first, h)
            found[both.name] = (both, pair)
    top = sorted(found, key=lambda n: -found[n][1].log_evidence)[:2]
    for n, again in zip(top, search.refine_all([found[n][1] for n in top], STAGE), strict=True):
        found[n] = (found[n][0], again)
    return found


def _promised(search: Search, fit: Fit, h: Hypothesis, z: Array, own: Array) -> float:
    """ln evidence at the optimum that the slopes promise."""
    model = Model(search.landings, (*fit.coordinates, *h.coordinates), Nobody())
    residual, jacobian = model.residual(fit.predicted), model.whitened(np.column_stack([fit.slopes, own]), fit.predicted)
    hessian = jacobian.T @ jacobian + np.eye(len(z))
    slope = jacobian.T @ residual - z
    step = np.linalg.solve(hessian, slope)
    return float(-0.5 * (residual @ residual + z @ z) + 0.5 * slope @ step - 0.5 * np.linalg.slogdet(hessian)[1])
