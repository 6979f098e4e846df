"""A measured landing in SI: series over time, scalars at rest, and what was known beforehand."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Series:
    """Channels sampled together. `times` (n,) in s as the file has them, rising; `values` (n, c) in SI, NaN where there is none."""

    name: str
    channels: tuple[str, ...]
    """"rates.yaw", "attitude.pitch", or any "unit.variable" of the scenario's outputs."""
    times: Array
    values: Array
    sigma: Array
    """(c,), standard deviation of the noise, SI."""
    colour: float | None
    """AR(1) coefficient between neighbouring samples; None: to be estimated."""
    unit: tuple[str, ...] = ()
    """SI unit of each channel."""

    @property
    def mask(self) -> Mask:
        """(n, c), True where there is a sample."""
        return np.isfinite(self.values)


@dataclass(frozen=True)
class Scalar:
    """A number known after the landing, SI: a value with its sigma, or an interval with sharp edges (an open end is infinite)."""

    name: str
    """stroke.LEG.STRUT, penetration.LEG, skid.LEG, contact_time.LEG, peak.CHANNEL (largest magnitude, with sign), or a final
    "unit.variable"."""
    kind: Literal["value", "interval"]
    value: float
    """The middle, for an interval closed on both sides; NaN for one that is open."""
    sigma: float
    """0 for an interval: its edges are sharp."""
    low: float
    high: float
    unit: str = ""


@dataclass(frozen=True)
class Prior:
    """What was known of a parameter before the landing. One of `sigma` and `sigma_log` is None; the other has `mean`'s shape."""

    name: str
    mean: Array
    sigma: Array | None
    sigma_log: Array | None
    unit: str = ""


@dataclass(frozen=True)
class Measured:
    """A folder of measured data."""

    title: str
    source: str
    folder: Path
    series: list[Series] = field(default_factory=list)
    values: list[Scalar] = field(default_factory=list)
    prior: list[Prior] = field(default_factory=list)
