"""What an effect looks like in the data once the nuisances have taken their share; which look alike, and what would tell them apart."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.hypothesis import NULL, parts_of
from orchestrator.diagnosis.outcome import Measure
from orchestrator.diagnosis.stages import State

Array = NDArray[np.float64]
UNSEEN = 9.0  # λ at one prior sigma: below, the landing could hardly have shown the effect
DECIDES = 25.0  # λ of the difference of two effects: enough to tell them apart


def projected(jacobian: Array, columns: Array) -> Array:
    """Gram matrix of columns once nuisances of standard normal priors took their share: S' (1 + J J')⁻¹ S; its diagonal is λ."""
    inner = np.linalg.inv(jacobian.T @ jacobian + np.eye(jacobian.shape[1]))
    removed = columns - jacobian @ (inner @ (jacobian.T @ columns))
    return np.asarray(columns.T @ removed)


def energies(state: State) -> dict[str, float]:
    """λ of every effect at one prior sigma of its most visible direction, beside the nuisances of the base fit."""
    count = len(state.search.nuisances)
    found = {}
    for h in state.hypotheses:
        fit = state.fits.get(h.name)
        if fit is None or len(parts_of(h.name)) > 1:
            continue
        gram = projected(fit.jacobian[:, :count], fit.jacobian[:, count:])
        found[h.name] = float(np.linalg.eigvalsh(gram)[-1])
    return found


def not_excited(state: State) -> list[str]:
    """Effects of one prior sigma that these data would not have shown."""
    return sorted(name for name, size in energies(state).items() if size < UNSEEN)


def measures_between(state: State, names: Sequence[str]) -> list[Measure]:
    """For the two most probable of the hypotheses: the channel whose predictions differ most, and how well it must be measured."""
    known = [n for n in names if n in state.fits and n != NULL.name][:2]
    if len(known) < 2:
        return []
    a, b = (state.fits[n] for n in known)
    landings, found = state.setup.landings, []
    for observation, part in zip(landings.observations, landings.parts, strict=True):
        apart = a.predicted[part] - b.predicted[part]
        for track, place in zip(observation.tracks, observation.places, strict=False):
            found.append((float(np.sqrt(np.square(apart[place]).sum())), track.channel, track.sigma))
        for reading, place in zip(observation.readings, observation.places[len(observation.tracks) :], strict=True):
            found.append((float(np.abs(apart[place]).sum()), reading.name, reading.edge if reading.interval else reading.sigma))
    measures = [(size / np.sqrt(DECIDES), channel, sigma) for size, channel, sigma in found if size > 0.0]
    measures.sort(key=lambda m: -m[0] / m[2])
    return [
        Measure(channel, float(needed), f"the two best, {known[0]} and {known[1]}, differ most there; now known to {sigma:.2g}")
        for needed, channel, sigma in measures[:3]
    ]
