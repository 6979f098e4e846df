"""The noise of a measured series: its level, its colour, and the whitening that makes a residual white with unit variance.

Noise is a first-order autoregression from sample to sample: e_k = ρ e_{k-1} + sqrt(1 - ρ²) σ w_k. Between samples that are further
apart than usual ρ is raised to that distance. Taking coloured noise as white turns noise into effects (diagnosis.md: 4 false alarms of 5).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
STILL = 40  # samples of a series at rest, needed to judge its noise by
LOST = 3  # numbers of a parabola
COLOURS = np.linspace(0.0, 0.95, 96)
SIGNIFICANT = 2.0  # of the log-likelihood: what ρ must bring to be more than zero
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
    reference: float | None = None
    """The σ that this is said of, where it is another: what is known without the fit that told σ. Its size is judged by it."""

    @property
    def understated(self) -> float:
        """Variance over that of the reference."""
        return 1.0 if self.reference is None else (self.sigma / self.reference) ** 2


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
    """Noise of the channels of one series, which have one instrument and one colour: the likeliest ρ and common factor on the stated σ.

    The stated σ count as an observation of their own (normal in ln σ), unless the data contradict them. Judged is the whole residual of a
    fit that leaves no more than noise, less a polynomial of as many terms as the fit followed numbers of each channel; but how large such
    a residual is may not be judged by itself, so its reference is what rest and statement alone say. Where a fit leaves more (followed is
    None), the samples that were taken at rest are judged, less a parabola.
    """
    quiet = [u for t in tracks if len(u := t.residual[t.still] / t.sigma) > 2 * LOST]
    known = sum(len(u) - LOST for u in quiet)
    if followed is not None:
        factor, rho = _likeliest([t.residual / t.sigma for t in tracks], followed, round(followed), colour)
        reference = max(_likeliest(quiet, LOST, LOST, it)[0] for it in {rho, colour})  # a short rest tells size and colour together
    elif known >= STILL:
        factor, rho = _likeliest(quiet, LOST, LOST, colour)
        reference = factor
    else:
        factor, rho, reference, known = 1.0, colour or 0.0, 1.0, 0
    factor, reference = max(factor, LEAST), max(reference, LEAST)
    heard, same = _heard(reference, known), reference == factor
    return [
        Noise(factor * t.sigma, rho, typical_interval(t.times), heard, None if same else reference * t.sigma) for t in tracks
    ]


def _heard(factor: float, known: int) -> float:
    """Innovations worth of what is known of σ: the data's, and the statement's unless they contradict each other."""
    stated = 0.5 / TRUST**2
    return float(known) if known and _contradicted(np.log(factor), known) else known + stated


def _contradicted(distance: float, known: float) -> bool:
    return bool(abs(distance) > CONTRADICTED * np.sqrt(0.5 / max(known, 1.0) + TRUST**2))


def _likeliest(rows: Sequence[Array], lost: float, trend: int, colour: float | None) -> tuple[float, float]:
    """Factor on σ and ρ by restricted likelihood: of each row so many numbers are lost, and a polynomial of so many terms is left free."""
    known = sum(len(u) - lost for u in rows)
    if known <= 0.0:
        return 1.0, colour or 0.0
    found = [(*_factor(known, *_square(rows, rho, trend)), float(rho)) for rho in (COLOURS if colour is None else [colour])]
    likelihood, factor, rho = max(found)
    if likelihood < found[0][0] + SIGNIFICANT:
        likelihood, factor, rho = found[0]
    return factor, rho


def _factor(known: float, square: float, volume: float) -> tuple[float, float]:
    """The greatest log-likelihood, up to a constant, and the factor e^x where it is: -known x - square e^(-2x)/2 - (x/TRUST)²/2."""
    free = 0.5 * np.log(max(square, 1e-12) / known)
    stated = 0.0 if _contradicted(free, known) else 1.0 / TRUST**2
    x = free
    for _ in range(20):
        spread = square * np.exp(-2.0 * x)
        x -= (spread - known - stated * x) / (-2.0 * spread - stated)
    return float(-known * x - 0.5 * square * np.exp(-2.0 * x) - 0.5 * stated * x * x - 0.5 * volume), float(np.exp(x))


def _square(rows: Sequence[Array], rho: float, trend: int) -> tuple[float, float]:
    """Sum of squares of the rows as white numbers, less the best polynomial, and the logarithm of the volume that goes with it."""
    square = volume = 0.0
    for u in rows:
        white = _white(u, rho)
        volume += (len(u) - 1) * np.log(1.0 - rho**2)
        if trend:
            free, own = _free(len(u), trend, rho)
            white = white - free @ (free.T @ white)
            volume += own
        square += float(white @ white)
    return square, volume


@lru_cache(maxsize=1024)
def _free(count: int, terms: int, rho: float) -> tuple[Array, float]:
    """Orthonormal columns of the polynomials as white numbers, and the logarithm of their volume."""
    free, triangle = np.linalg.qr(_white(np.vander(np.linspace(-1.0, 1.0, count), terms), rho))
    return free, 2.0 * float(np.sum(np.log(np.abs(np.diag(triangle)))))


def _white(values: Array, rho: float) -> Array:
    """Down the columns."""
    found = values.copy()
    found[1:] = (values[1:] - rho * values[:-1]) / np.sqrt(1.0 - rho**2)
    return found
