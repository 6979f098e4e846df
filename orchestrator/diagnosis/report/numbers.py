"""Numbers as a person reads them."""

from __future__ import annotations

from math import degrees, floor, isfinite, log10

NONE = "–"
SHOWN = {"rad": ("deg", degrees(1.0)), "rad/s": ("deg/s", degrees(1.0)), "m": ("cm", 100.0)}
"""SI unit -> unit of figures, factor."""


def shown_unit(unit: str) -> tuple[str, float]:
    """What a figure's axis is labelled with, and the factor to it."""
    return SHOWN.get(unit, (unit, 1.0))


def spelt(unit: str) -> str:
    """N.s/m2 -> N·s/m²; nothing for the unit 1."""
    return "" if unit == "1" else unit.replace(".", "·").replace("2", "²").replace("3", "³")


def number(value: float | None, digits: int = 3) -> str:
    """So many significant digits, thousands apart, no exponent between 1e-4 and 1e7."""
    if value is None or not isfinite(value):
        return NONE
    if value == 0.0:
        return "0"
    order = floor(log10(abs(value)))
    if not -4 <= order < 7:
        return f"{value:.{digits - 1}e}".replace("-", "−")
    decimals = max(digits - 1 - order, 0)
    rounded = round(value, digits - 1 - order)
    return f"{rounded:,.{decimals}f}".replace(",", "\u202f").replace("-", "−")


def with_sigma(value: float | None, sigma: float | None) -> str:
    """41 200 ± 1 300: the deviation to two digits, the value to the same place."""
    if value is None or not isfinite(value):
        return NONE
    if sigma is None or not isfinite(sigma) or sigma <= 0.0:
        return number(value, 4)
    digits = max(floor(log10(abs(value))) - floor(log10(sigma)) + 2, 2) if value else 2
    return f"{number(value, min(digits, 7))} ± {number(sigma, 2)}"


def signed(value: float | None, decimals: int = 1) -> str:
    """+12.3 or −4.0."""
    if value is None or not isfinite(value):
        return NONE
    return f"{value:+,.{decimals}f}".replace(",", "\u202f").replace("-", "−")


def chance(probability: float | None) -> str:
    """A probability in percent; near 0 and 1 what can honestly be said."""
    if probability is None or not isfinite(probability):
        return NONE
    return "> 99.9 %" if probability > 0.999 else "< 0.1 %" if probability < 0.001 else percent(probability)


def percent(share: float | None) -> str:
    """Of a share."""
    if share is None or not isfinite(share):
        return NONE
    text = f"{100.0 * share:.1f}" if share > 0.99 or share < 0.01 else f"{100.0 * share:.0f}"
    return f"{text.removesuffix('.0')} %".replace("-", "−")


def probability_of_residual(p: float | None) -> str:
    """p-value: two digits, a bound where it is tiny."""
    if p is None or not isfinite(p):
        return NONE
    return "< 10⁻⁶" if p < 1e-6 else f"{p:.2g}" if p >= 1e-3 else number(p, 2)
