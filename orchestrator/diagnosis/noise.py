"""The noise of a measured series: its level, its colour, and the whitening that makes a residual white with unit variance.

Noise is a first-order autoregression from sample to sample: e_k = ρ e_{k-1} + sqrt(1 - ρ²) σ w_k. Between samples that are further
apart than usual ρ is raised to that distance. Taking coloured noise as white turns noise into effects (diagnosis.md: 4 false alarms of 5).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
STILL = 40  # samples of a series needed to judge its noise by
LOST = 3  # numbers of a parabola
TRUST = 0.1  # of ln σ: what stated noise is taken to be known to, before the rest is heard
CONTRADICTED = 3.0  # standard deviations: beyond, the stated noise counts for nothing
LEAST = 0.5  # of the stated σ: data may be quieter than said, the model is not


@dataclass(frozen=True)
class Noise:
    """σ and ρ of one channel; ρ belongs to `interval` s between samples."""

    sigma: float
    rho: float
    interval: float
    known: float = np.inf
    """Innovations that σ is known as well as from; σ is known to 1/√(2 known)."""


@dataclass(frozen=True)
class Stretch:
    """Residual of one channel, and which of its samples were taken at rest."""

    times: Array
    residual: Array
    still: NDArray[np.bool_]
    sigma: float


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


def noise_of(tracks: Sequence[Stretch], colour: float | None, followed: float | None = None) -> list[Noise]:
    """Noise of the channels of one series, which have one instrument and one colour, from stretches in which the vehicle rests.

    The stated σ are taken in proportion; ρ and their common factor are estimated. The factor makes the INNOVATIONS as large as they are:
    they are what a whitened residual is measured by, and hardly depend on an error of ρ; σ and ρ by themselves would matter threefold.
    A short rest tells the factor to 10 % only: it is weighed with the stated σ, normal in ln σ, unless it contradicts them.

    Where nearly nothing was taken at rest the stated σ stand, and ρ is judged by the whole residual of a fit that leaves no more than
    noise. followed: numbers of each channel that it took out; None where it leaves more, and ρ is then taken for zero.
    """
    intervals = [typical_interval(t.times) for t in tracks]
    quiet = [_detrended(t.residual[t.still] / t.sigma) for t in tracks]
    known = sum(len(u) for u in quiet)
    stated = 1.0 / TRUST**2
    if known < STILL:
        whole = [t.residual / t.sigma for t in tracks] if followed is not None else []
        rho = _significant(_rho(whole, followed or 0.0), whole) if colour is None else colour
        return [Noise(t.sigma, rho, interval, 0.5 * stated) for t, interval in zip(tracks, intervals, strict=True)]
    rho = _significant(_rho(quiet, LOST), quiet) if colour is None else colour
    factor = np.sqrt(_innovation(quiet, rho) / (1.0 - rho**2))
    heard = 2.0 * known
    if abs(np.log(factor)) < CONTRADICTED * np.sqrt(1.0 / heard + 1.0 / stated):
        factor, heard = factor ** (heard / (heard + stated)), heard + stated
    factor = max(float(factor), LEAST)
    return [Noise(factor * t.sigma, rho, interval, 0.5 * heard) for t, interval in zip(tracks, intervals, strict=True)]


def _detrended(u: Array) -> Array:
    """Without the parabola that a slow settling leaves."""
    if len(u) <= LOST:
        return np.zeros(0)
    t = np.linspace(-1.0, 1.0, len(u))
    return np.asarray(u - np.polynomial.polynomial.polyval(t, np.polynomial.polynomial.polyfit(t, u, LOST - 1)))


def _significant(rho: float, quiet: Sequence[Array]) -> float:
    """ρ, or zero where white noise would give as much."""
    return rho if rho * np.sqrt(sum(len(u) for u in quiet)) >= 2.0 else 0.0


def _rho(quiet: Sequence[Array], lost: float) -> float:
    """Lag-one autocorrelation, 0 to 0.97, corrected for what taking out so many numbers of each hides of a coloured noise."""
    rho = 0.0
    for _ in range(4):
        variance = covariance = 0.0
        for u in quiet:
            if len(u) == 0:
                continue
            hidden = min(lost * (1.0 + rho) / max(1.0 - rho, 1e-3) / len(u), 0.6)
            full = float(u @ u) / (1.0 - hidden)
            variance += full
            covariance += float(u[1:] @ u[:-1]) * len(u) / (len(u) - 1) + hidden * full
        rho = float(np.clip(covariance / variance, 0.0, 0.97)) if variance > 0.0 else 0.0
    return rho


def _innovation(quiet: Sequence[Array], rho: float) -> float:
    """Variance of u_k - ρ u_{k-1}."""
    total = count = 0.0
    for u in quiet:
        if len(u) > LOST + 1:
            steps = u[1:] - rho * u[:-1]
            total += float(steps @ steps)
            count += len(steps) - LOST * (1.0 - rho)
    return total / count if count > 0.0 else 1.0 - rho**2
