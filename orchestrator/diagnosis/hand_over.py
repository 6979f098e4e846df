"""The winner's effect handed over to its rivals, nothing missing among them: each is begun where it would do best what the winner does.

A rival that looks like the winner only with other nuisances (a step under one pad is one under another on a ground that is tilted
differently) is found neither from the base fit nor from the winner's nuisances with nothing in its effect's place. The slopes at the
winner's fit tell how far nuisances and rival must move for the winner's effect to go: a least-squares step, and a fit from there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate, nulls
from orchestrator.diagnosis.fit import Fit, gauss_newton_step, log_evidence
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis, joined
from orchestrator.diagnosis.problem import Model, Nobody
from orchestrator.diagnosis.search import MARGIN, Search
from orchestrator.diagnosis.tasks.fits import FitAt, Point
from orchestrator.diagnosis.tasks.predict import slopes_beside

Array = NDArray[np.float64]
STAGE = "hand-over"
TAKERS = 8  # rivals that are fitted
SWEEPS = 3  # of the quadratic step, each within the reach of one
BEHIND = 40.0  # in ln evidence: who then stands further behind the winner is not refined
WORTH = 2.0  # in ln evidence: what must be promised beyond what a rival has


def handed_over(search: Search, fits: dict[str, Fit], hypotheses: Sequence[Hypothesis], winner: str) -> dict[str, Fit]:
    """The fits, those of rivals replaced that stand better where the winner's effect has been handed over to them."""
    best = fits[winner]
    others = [h for h in (*hypotheses, NULL) if h.name != winner and h.name in fits]
    taken = offers(search, best, others)
    worth = [h for h in others if taken[h.name][0] > fits[h.name].log_evidence + WORTH]
    ends = begun_there(search, best, worth, taken)
    found = {name: fit for name, fit in ends.items() if fit.log_evidence > best.log_evidence - BEHIND}
    return search.if_better(fits, found, STAGE)


def handed_over_within(
    search: Search, best: Fit, pair: tuple[Hypothesis, Hypothesis], hypotheses: Sequence[Hypothesis]
) -> list[tuple[Hypothesis, Fit]]:
    """Pairs in which one effect of the best pair stays and its other has gone over to a rival, refined where they come near the best."""
    found: list[tuple[Hypothesis, Fit]] = []
    for stays, goes in (pair, pair[::-1]):
        beside = search.beside(stays)
        fit = arranged(best, (*beside.nuisances, *goes.coordinates))
        rivals = [h for h in hypotheses if h.name not in (stays.name, goes.name) and not h.slots & stays.slots]
        taken = offers(beside, fit, rivals)
        worth = [h for h in rivals if taken[h.name][0] > best.log_evidence - MARGIN]
        ends = begun_there(beside, fit, worth, taken)
        found += [(joined(stays, h), ends[h.name]) for h in worth if h.name in ends]
    near = [(both, fit) for both, fit in found if fit.log_evidence > best.log_evidence - MARGIN]
    return list(zip([both for both, _ in near], search.refine_all([fit for _, fit in near], STAGE), strict=True))


def arranged(fit: Fit, coordinates: Sequence[Coordinate]) -> Fit:
    """The same fit with its coordinates in another order."""
    order = [fit.coordinates.index(c) for c in coordinates]
    return replace(fit, coordinates=tuple(coordinates), z=fit.z[order], slopes=fit.slopes[:, order], jacobian=fit.jacobian[:, order])


def begun_there(search: Search, best: Fit, rivals: Sequence[Hypothesis], taken: Mapping[str, tuple[float, Array]]) -> dict[str, Fit]:
    """Fits of the TAKERS that promise most, from where the best fit's effect has gone over to them. taken: what `offers` says."""
    takers = sorted(rivals, key=lambda h: -taken[h.name][0])[:TAKERS]
    count = len(search.nuisances)
    here = Point(best.z[:count], best.predicted, best.slopes[:, :count], np.inf)
    tasks = [FitAt(search.landings, (*search.nuisances, *h.coordinates), here, taken[h.name][1], 5, search.fresh) for h in takers]
    ends = zip(takers, search.run(STAGE, tasks), strict=True)
    return {h.name: fit for h, fit in ends if fit is not None}


def offers(search: Search, fit: Fit, rivals: Sequence[Hypothesis]) -> dict[str, tuple[float, Array]]:
    """Of each rival what `taken_over` says, by its name."""
    asks = [slopes_beside(search.landings, fit.coordinates, fit.z, fit.predicted, h.coordinates) for h in rivals]
    return {h.name: taken_over(search, fit, h, own) for h, own in zip(rivals, search.run(STAGE, asks), strict=True)}


def taken_over(search: Search, fit: Fit, rival: Hypothesis, own: Array) -> tuple[float, Array]:
    """ln evidence that the slopes promise of the rival in the place of the fit's effect, and z of nuisances and rival there.

    own: the rival's slopes at the fit
    """
    count = len(search.nuisances)
    coordinates = (*search.nuisances, *rival.coordinates)
    model, effect = Model(search.landings, coordinates, Nobody()), Model(search.landings, fit.coordinates[count:], Nobody())
    jacobian = model.whitened(np.column_stack([fit.slopes[:, :count], own]), fit.predicted)
    z = np.append(fit.z[:count], np.zeros(len(rival.coordinates)))  # of one known from other landings: as it was there
    residual = fit.residual + effect.whitened(fit.slopes[:, count:], fit.predicted) @ (fit.z[count:] - nulls(effect.coordinates))
    residual = residual + jacobian[:, count:] @ nulls(rival.coordinates)
    for _ in range(SWEEPS):
        step = gauss_newton_step(jacobian, residual, z, coordinates, 1.0)
        z, residual = z + step, residual - jacobian @ step
    return log_evidence(coordinates, z, residual, jacobian), z


__all__ = ["arranged", "begun_there", "handed_over", "handed_over_within", "offers", "taken_over"]
