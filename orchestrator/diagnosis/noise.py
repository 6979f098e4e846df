"""The noise of a measured series: its level, its colour, and the whitening that makes a residual white with unit variance.

Noise is a first-order autoregression from sample to sample: e_k = ρ e_{k-1} + sqrt(1 - ρ²) σ w_k. Between samples that are further
apart than usual ρ is raised to that distance. Taking coloured noise as white turns noise into effects (diagnosis.md: 4 false alarms of 5).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
STILL = 40  # samples needed to judge a noise by
LEAST = 0.5  # of the stated σ: data may be quieter than said, the model is not


@dataclass(frozen=True)
class Noise:
    """σ and ρ of one channel; ρ belongs to `interval` s between samples."""

    sigma: float
    rho: float
    interval: float


class Whitening:
    """Turns the residual of one channel into independent numbers of unit variance; linear, so that it serves for Jacobians too."""

    def __init__(self, times: Array, noise: Noise) -> None:
        """times: of the valid samples, s, rising."""
        if len(times) == 0:
            self.share = np.zeros(0)
        gaps = np.diff(times) / noise.interval if len(times) > 1 else np.zeros(0)
        follow = np.where(noise.rho > 0.0, noise.rho ** np.maximum(gaps, 1e-9), 0.0) if noise.rho > 0.0 else np.zeros(len(gaps))
        self.follow = np.concatenate([[0.0], follow])[: len(times)]
        self.scale = 1.0 / (noise.sigma * np.sqrt(1.0 - self.follow**2))

    def __call__(self, residual: Array) -> Array:
        """residual (n,) or (n, m)."""
        before = np.zeros_like(residual)
        before[1:] = residual[:-1]
        shape = (-1,) + (1,) * (residual.ndim - 1)
        return (residual - self.follow.reshape(shape) * before) * self.scale.reshape(shape)


def typical_interval(times: Array) -> float:
    """Median distance of samples, s."""
    return float(np.median(np.diff(times))) if len(times) > 1 else 1.0


def colour_of(residual: Array) -> tuple[float, float]:
    """σ and ρ (0 to 0.97) of a stretch of nothing but noise, by its autocovariances at lags 0 to 3, corrected for the removed mean and slope."""
    n = len(residual)
    t = np.linspace(-1.0, 1.0, n)
    r = residual - np.polynomial.polynomial.polyval(t, np.polynomial.polynomial.polyfit(t, residual, 2))
    rho = 0.0
    for _ in range(3):  # taking out three numbers makes coloured noise look whiter and smaller
        lost = 3.0 * (1.0 + rho) / max(1.0 - rho, 1e-3) / n
        c = [float(r[k:] @ r[: n - k]) / (n - k) for k in range(3)]
        variance = c[0] / max(1.0 - lost, 0.3)
        missing = variance - c[0]
        rho = float(np.clip((c[1] + missing) / variance, 0.0, 0.97)) if variance > 0.0 else 0.0
    return float(np.sqrt(max(c[0] / max(1.0 - 3.0 * (1.0 + rho) / max(1.0 - rho, 1e-3) / n, 0.3), 0.0))), rho


def noise_of(times: Array, residual: Array, still: NDArray[np.bool_], sigma: float, colour: float | None) -> Noise:
    """Noise of a channel from its stated σ and colour, and from a stretch in which the vehicle rests.

    still   mask of samples at rest. The stated numbers stand unless the stretch contradicts them by more than three standard errors.
    """
    interval = typical_interval(times)
    quiet = residual[still]
    if len(quiet) < STILL:
        return Noise(sigma, 0.0 if colour is None else colour, interval)
    seen, rho = colour_of(quiet)
    if colour is not None:
        rho = colour
    elif rho < 2.0 / np.sqrt(len(quiet)):
        rho = 0.0
    independent = len(quiet) * (1.0 - rho**2) / (1.0 + rho**2)
    contradicted = seen > 0.0 and abs(np.log(seen / sigma)) > 3.0 / np.sqrt(2.0 * independent)
    return Noise(max(seen, LEAST * sigma) if contradicted else sigma, rho, interval)
