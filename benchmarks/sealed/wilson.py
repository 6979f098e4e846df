"""Wilson's score interval for a share."""

from __future__ import annotations

from math import sqrt

Z95 = 1.959963984540054  # two-sided 95 %


def wilson(hits: int, n: int, z: float = Z95) -> tuple[float, float]:
    """(p + z²/2n ± z √(p(1-p)/n + z²/4n²)) / (1 + z²/n); Wilson (1927), J. Am. Stat. Assoc. 22, 209."""
    if n == 0:
        return 0.0, 1.0
    p = hits / n
    middle, half = p + z * z / (2 * n), z * sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n))
    return max(0.0, (middle - half) / (1.0 + z * z / n)), min(1.0, (middle + half) / (1.0 + z * z / n))
