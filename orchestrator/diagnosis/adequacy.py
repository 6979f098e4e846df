"""Whether a fit leaves nothing but noise: its chi-square, and how white its residual is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binom
from scipy.stats import chi2 as chi_square
from scipy.stats import f as variance_ratio

from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.problem import Landings

Array = NDArray[np.float64]
LAGS = 5


@dataclass(frozen=True)
class Adequacy:
    """p-values: of the size of the residual, of the whiteness of the worst channel (corrected for their number), and of both together."""

    chi2: float
    freedom: float
    size: float
    whiteness: float

    @property
    def p(self) -> float:
        """The smaller of the two, corrected for being two."""
        return min(1.0, 2.0 * min(self.size, self.whiteness))


def freedom_used(fit: Fit) -> float:
    """How many numbers a fit could follow of its rows: tr J (J'J + 1)^-1 J'."""
    return float(np.trace(fit.covariance @ (fit.jacobian.T @ fit.jacobian)))


def adequacy(fit: Fit, landings: Landings) -> Adequacy:
    """Of a fit's residual: freedom is the number of rows less what the fit could follow of them."""
    counted = np.concatenate(
        [
            np.concatenate([np.ones(sum(len(t.times) for t in o.tracks)), [float(not r.interval) for r in o.readings]])
            for o in landings.observations
        ]
    )
    freedom = max(float(counted.sum()) - freedom_used(fit), 1.0)
    against, judged = _noise_freedom(landings), float(fit.residual**2 @ _understated(landings))
    size = chi_square.sf(judged, freedom) if np.isinf(against) else variance_ratio.sf(judged / freedom, freedom, against)
    return Adequacy(fit.chi2, freedom, float(size), _whiteness(fit, landings))


def _noise_freedom(landings: Landings) -> float:
    """Degrees of freedom of the estimated noise that all rows are measured by; infinite where it is as good as known.

    Of n rows with noise estimated from k the relative variance of chi-square is 2/n where the noise is known. It is 2/k - 2/n where it was
    estimated from k of these rows: then it is F's with n and 1/(1/k - 2/n) degrees of freedom. Series add by the squares of their shares.
    """
    inverse = 0.0
    for observation in landings.observations:
        for places in observation.series.values():
            rows, known = float(sum(len(observation.tracks[i].times) for i in places)), observation.noises[places[0]].known
            if rows > 0.0:
                inverse += (rows / landings.size) ** 2 * max(1.0 / known - 2.0 / rows, 0.0)
    return 1.0 / inverse if inverse > 0.0 else np.inf


def _understated(landings: Landings) -> Array:
    """Row by row, by how much a noise that a fit told is larger than what is known without that fit, as variances."""
    found = np.ones(landings.size)
    for observation, part in zip(landings.observations, landings.parts, strict=True):
        rows = found[part]
        for noise, place in zip(observation.noises, observation.places, strict=False):
            rows[place] = noise.understated
    return found


def _whiteness(fit: Fit, landings: Landings) -> float:
    """Smallest p-value of `portmanteau` over the channels, times their number."""
    found = []
    for observation, part in zip(landings.observations, landings.parts, strict=True):
        rows = fit.residual[part]
        found += [
            portmanteau(rows[place])
            for track, place in zip(observation.tracks, observation.places, strict=False)
            if len(track.times) > 4 * LAGS
        ]
    return min(1.0, len(found) * min(found)) if found else 1.0


def portmanteau(residual: Array, lags: int = LAGS) -> float:
    """p-value of no positive autocorrelation up to `lags`: the sum of Ljung and Box (1978) over the positive ones.

    What a missing effect leaves is smooth from sample to sample; what alternates, a fit's own freedom makes, or chance. A sum of squares
    of those of independent normal numbers that are positive is chi-square of as many freedoms as are positive, a binomial number.
    """
    n = len(residual)
    r = residual - residual.mean()
    variance = float(r @ r)
    if variance == 0.0:
        return 1.0
    q = n * (n + 2.0) * sum(max(float(r[k:] @ r[:-k]) / variance, 0.0) ** 2 / (n - k) for k in range(1, lags + 1))
    positive = np.arange(1, lags + 1)
    return 1.0 if q == 0.0 else float(binom.pmf(positive, lags, 0.5) @ chi_square.sf(q, positive))
