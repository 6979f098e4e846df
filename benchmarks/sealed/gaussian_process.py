"""A Gaussian process for a discrepancy over time: exponential of the squared distance, size and length by the marginal likelihood."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

Array = NDArray[np.float64]
LENGTHS = (0.03, 0.06, 0.12, 0.25, 0.5, 1.0)  # s
SIZES = (0.3, 1.0, 3.0, 10.0)  # of the noise's sigma


def kernel(a: Array, b: Array, size: float, length: float) -> Array:
    return np.asarray(size**2 * np.exp(-0.5 * ((a[:, None] - b[None, :]) / length) ** 2))


def likelihood_gain(x: Array, y: Array, sigma: float) -> tuple[float, float, float]:
    """(ln L of the best process less ln L of noise alone less ln n for its two parameters, size, length)."""
    noise = -0.5 * float(np.sum((y / sigma) ** 2)) - len(y) * np.log(sigma)
    best = (-np.inf, 0.0, 1.0)
    for length in LENGTHS:
        for share in SIZES:
            factor = cho_factor(kernel(x, x, share * sigma, length) + sigma**2 * np.eye(len(x)), lower=True)
            gain = -0.5 * float(y @ cho_solve(factor, y)) - float(np.sum(np.log(np.diag(factor[0])))) - noise - np.log(len(y))
            best = max(best, (gain, share * sigma, length))
    return best


def mean_at(x: Array, y: Array, sigma: float, size: float, length: float, there: Array) -> Array:
    """The process' mean at other instants."""
    weights = np.linalg.solve(kernel(x, x, size, length) + sigma**2 * np.eye(len(x)), y)
    return np.asarray(kernel(there, x, size, length) @ weights)
