"""How a product of powers is written and said."""

from __future__ import annotations

_SUPERSCRIPTS = {0.5: "^½", 2.0: "²"}
_MANNERS = {0.5: "with the root of", 1.0: "linear in", 2.0: "quadratic in"}
WRITTEN = {0.5: "half", 1.0: "1", 2.0: "2", 0.0: "0"}
"""Exponents in names."""


def factor(symbol: str, scale: str, exponent: float) -> str:
    """(δ/0.01 m)² ; nothing for exponent 0."""
    return f" ({symbol}/{scale}){_SUPERSCRIPTS.get(exponent, '')}" if exponent else ""


def manner(*dependences: tuple[float, str]) -> str:
    """ "linear in depth, quadratic in sink rate"; "constant" where all exponents are 0."""
    said = [f"{_MANNERS[exponent]} {what}" for exponent, what in dependences if exponent]
    return ", ".join(said) or "constant"
