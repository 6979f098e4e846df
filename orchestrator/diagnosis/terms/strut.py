"""Generic terms of the struts."""

from __future__ import annotations

from collections.abc import Iterator

from orchestrator.diagnosis.terms.formulas import WRITTEN, factor, manner
from orchestrator.diagnosis.terms.term import Energy, Term

STROKE, RATE = 0.05 / 0.01, 0.3 / 0.1  # the reference point in the units of the powers: 5 cm, 0.3 m/s
FORCE = 1000.0  # N there: one standard deviation
ON_STROKE, ON_MOTION = 0, 3
_STRUTS = ("struts", "primary struts", "secondary struts")
_FORMS = tuple((ON_STROKE, a, 0.0) for a in (0.0, 0.5, 1.0, 2.0)) + tuple((ON_MOTION, 0.0, b) for b in (0.0, 1.0, 2.0))
"""Phase with the exponents of stroke and rate."""


def strut_terms() -> Iterator[Term]:
    """F += c (|d|/0.01 m)^a (|ḋ|/0.1 m/s)^b against the stroke or the motion of all struts, the primaries or the secondaries."""
    for struts, which in enumerate(_STRUTS):
        for phase, a, b in _FORMS:
            yield _strut(struts, which, phase, a, b)


def _strut(struts: int, which: str, phase: int, a: float, b: float) -> Term:
    energy: tuple[Energy, Energy] = ("conservative", "conservative") if phase == ON_STROKE else ("dissipative", "active")
    against, sign = ("stroke", "sgn d") if phase == ON_STROKE else ("motion", "sgn ḋ")
    return Term(
        f"{which.replace(' ', '_')}_stroke{WRITTEN[a]}_rate{WRITTEN[b]}_against_{against}",
        "strut",
        "gear",
        f"{which}, {manner((a, 'stroke'), (b, 'stroke rate'))}, against the {against}",
        f"F += c{factor('|d|', '0.01 m', a)}{factor('|ḋ|', '0.1 m/s', b)} {sign}",
        "gear.strut_term",
        (("gear.strut_term_stroke", a), ("gear.strut_term_rate", b), ("gear.strut_term_phase", phase), ("gear.strut_term_struts", struts)),
        FORCE / (STROKE**a * RATE**b),
        "N",
        *energy,
    )
