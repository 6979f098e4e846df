"""Coordinates of a search: what may vary, each scaled so that its prior is a standard normal distribution.

A coordinate moves one or several variables of the twin together: by adding, by a factor exp(p), or by setting. Nuisances come first
in a problem, so that an effect acts on top of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import exp
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Operation = Literal["add", "scale", "set"]
SHARED = -1  # landing of a coordinate that all landings share


@dataclass(frozen=True)
class Coordinate:
    """One number to find. p = mean + sigma z, with z ~ N(0, 1); `positive`: half of it, z >= 0."""

    name: str
    slots: tuple[tuple[str, float], ...]
    """Variables of the twin (or clock.SERIES, time.origin) with the factor by which each follows p."""
    sigma: float
    mean: float = 0.0
    operation: Operation = "add"
    low: float = -np.inf
    high: float = np.inf
    """Limits of p."""
    positive: bool = False
    unit: str = "1"
    landing: int = SHARED
    step: float = 0.1
    """Of z, for differences."""
    fixed: tuple[tuple[str, float], ...] = ()
    """Variables that are set along with it, whatever z is: which term, when a pulse begins."""
    null: float | None = None
    """p that moves nothing; without, the mean does not."""

    def value(self, z: float) -> float:
        """p of a z, within its limits."""
        return min(max(self.mean + self.sigma * z, self.low), self.high)

    def scaled(self, p: float) -> float:
        """z of a p."""
        return (p - self.mean) / self.sigma

    @property
    def bounds(self) -> tuple[float, float]:
        """Limits of z."""
        low = 0.0 if self.positive else self.scaled(self.low)
        return low, self.scaled(self.high)


def nulls(coordinates: Sequence[Coordinate]) -> Array:
    """z at which none of the coordinates moves anything."""
    return np.array([0.0 if c.null is None else c.scaled(c.null) for c in coordinates])


def applied(base: Mapping[str, float], coordinates: Sequence[Coordinate], z: Array, landing: int) -> dict[str, float]:
    """Values that differ from a scenario's, in one landing, with the coordinates at z."""
    values: dict[str, float] = {}
    for coordinate, number in zip(coordinates, z.tolist(), strict=True):
        if coordinate.landing not in (SHARED, landing):
            continue
        p = coordinate.value(number)
        values.update(coordinate.fixed)
        for name, factor in coordinate.slots:
            now = values.get(name, base.get(name, 0.0))
            if coordinate.operation == "add":
                values[name] = now + factor * p
            elif coordinate.operation == "scale":
                values[name] = now * exp(factor * p)
            else:
                values[name] = factor * p
    return values


def folded(coordinates: Sequence[Coordinate], z: Array) -> Array:
    """z with normal draws of half-normal coordinates on their own side."""
    return np.where([c.positive for c in coordinates], np.abs(z), z)


def clipped(coordinates: Sequence[Coordinate], z: Array) -> Array:
    """z within the coordinates' limits."""
    low, high = np.array([c.bounds for c in coordinates]).reshape(-1, 2).T
    return np.clip(z, low, high)
