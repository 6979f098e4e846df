"""How often the same port and the same form win when the noise is drawn again: a block bootstrap of the white residual.

In the linear model of a view; it costs no landing.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.terms.linear import White, explained, linear_of, port_evidence

Array = NDArray[np.float64]
DRAWS = 20
BLOCK = 10  # samples


def stability(white: White, landings: Landings, winner: str, ports: Mapping[str, str], offered: set[str], seed: int) -> dict[str, float]:
    """Shares of DRAWS in which the winner's port, and the winner itself among `offered`, come first again."""
    random = np.random.default_rng(seed)
    signal = explained(white, white.names.index(winner))
    noise = white.residual - signal
    same_port = same_form = 0
    for _ in range(DRAWS):
        found = linear_of(white, signal + resampled(noise, landings, random))
        evidence = dict(zip(white.names, found.evidence.tolist(), strict=True))
        same_port += next(iter(port_evidence(evidence, ports))) == ports[winner]
        same_form += max((n for n in white.names if n in offered), key=lambda n: evidence[n]) == winner
    return {"port": same_port / DRAWS, "form": same_form / DRAWS}


def resampled(noise: Array, landings: Landings, random: np.random.Generator) -> Array:
    """Each track from blocks of itself; the readings at rest, single numbers, with a sign by chance."""
    drawn = noise.copy()
    for observation, part in zip(landings.observations, landings.parts, strict=True):
        rows = drawn[part]
        for k, place in enumerate(observation.places):
            own = noise[part][place]
            if k < len(observation.tracks):
                rows[place] = _blocks(own, random)
            else:
                rows[place] = own * random.choice([-1.0, 1.0])
    return drawn


def _blocks(own: Array, random: np.random.Generator) -> Array:
    if len(own) == 0:
        return own
    length = min(BLOCK, len(own))
    count = -(-len(own) // length)
    starts = random.integers(0, len(own) - length + 1, size=count)
    return np.concatenate([own[s : s + length] for s in starts])[: len(own)]
