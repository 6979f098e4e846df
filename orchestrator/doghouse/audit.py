"""Landings anywhere in the certified envelope, at random: what the grid of combinations and the search along rays could have missed."""

from __future__ import annotations

import math

import numpy as np

from orchestrator.doghouse.landing import Inputs
from orchestrator.doghouse.model import Doghouse


def drawn(doghouse: Doghouse) -> list[Inputs]:
    """Speeds even over the envelope's area, all headings and directions, tilts up to the largest, friction even in its logarithm."""
    random = np.random.default_rng(doghouse.audit.seed)
    certified, varies = doghouse.certified, doghouse.varies
    low, high = math.log(min(varies.friction)), math.log(max(varies.friction))
    found: list[Inputs] = []
    while len(found) < doghouse.audit.landings:
        across = random.uniform(0.0, certified.horizontal_limit_m_s)
        down = random.uniform(0.0, certified.vertical_at_zero_horizontal_m_s)
        heading, motion, toward = random.uniform(-180.0, 180.0, 3)
        tilt = random.uniform(0.0, max(varies.tilt_deg, default=0.0))
        friction = math.exp(random.uniform(low, high))
        if certified.holds(across, down):
            found.append(Inputs(*(float(x) for x in (across, down, heading, motion, tilt, toward, friction))))
    return found
