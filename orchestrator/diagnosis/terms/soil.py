"""Generic terms of the soil under the pads: normal and tangential."""

from __future__ import annotations

from collections.abc import Iterator

from orchestrator.diagnosis.terms.formulas import WRITTEN, factor, manner
from orchestrator.diagnosis.terms.term import Energy, Term

DEPTH, RATE, SLIDE = 0.05 / 0.01, 0.3 / 0.1, 0.1 / 0.1  # the reference point in the units of the powers: 5 cm, 0.3 m/s, 10 cm
NORMAL, TANGENTIAL = 2000.0, 1000.0  # N there: one standard deviation
ALWAYS, SINKING, RISING, AGAINST = range(4)
_WHEN = {ALWAYS: "always", SINKING: "while sinking", RISING: "while rising", AGAINST: "against the motion"}
_NAMED = {ALWAYS: "always", SINKING: "sinking", RISING: "rising", AGAINST: "against_motion"}
_NORMAL_ENERGY: dict[int, tuple[Energy, Energy]] = {
    ALWAYS: ("conservative", "conservative"),
    SINKING: ("dissipative", "active"),
    RISING: ("active", "dissipative"),
    AGAINST: ("dissipative", "active"),
}
"""For c > 0 and c < 0; ALWAYS comes without a power of the rate only."""
_NORMALS = {ALWAYS: ((0, 1, 2), (0,)), SINKING: ((0, 1, 2), (0, 0.5, 1, 2)), RISING: ((0, 1, 2), (0, 1)), AGAINST: ((0, 1), (0, 1, 2))}
"""Phase -> exponents of depth and of rate."""
_NORMAL_EQUALS = {(SINKING, 0, 1): "soil_damping", (SINKING, 0, 2): "inertial_drag", (SINKING, 1, 0): "bearing_strength"}
SLIP, SLIDING = range(2)
_TANGENTS = {SLIP: ((0, 1), (0, 1, 2), (0, 1)), SLIDING: ((0, 1), (0,), (0, 1))}
"""Phase -> exponents of depth, slip and slide."""


def normal_terms() -> Iterator[Term]:
    """F_n += c (δ/0.01 m)^a (|δ̇|/0.1 m/s)^b by phase, per footpad, outward."""
    for phase, (depths, rates) in _NORMALS.items():
        for a in depths:
            for b in rates:
                yield _normal(phase, float(a), float(b), _NORMAL_EQUALS.get((phase, int(a), int(b)) if b != 0.5 else (-1, 0, 0), ""))


def _normal(phase: int, a: float, b: float, equals: str) -> Term:
    rate = {SINKING: "sink rate", RISING: "rise rate"}.get(phase, "rate")
    sign = " sgn δ̇" if phase == AGAINST else "" if phase == ALWAYS else f" {_WHEN[phase]}"
    return Term(
        f"normal_depth{WRITTEN[a]}_rate{WRITTEN[b]}_{_NAMED[phase]}",
        "soil.normal",
        "soil",
        f"pad normal, {manner((a, 'depth'), (b, rate))}, {_WHEN[phase]}",
        f"F_n += c{factor('δ', '0.01 m', a)}{factor('|δ̇|', '0.1 m/s', b)}{sign}",
        "soil.normal_term",
        (("soil.normal_term_depth", a), ("soil.normal_term_rate", b), ("soil.normal_term_phase", phase)),
        NORMAL / (DEPTH**a * RATE**b),
        "N",
        *_NORMAL_ENERGY[phase],
        equals,
    )


def tangential_terms() -> Iterator[Term]:
    """F_t -= c (δ/0.01 m)^a (|v|/0.1 m/s)^b (|s|/0.1 m)^d along the slip v or the slide s, per footpad."""
    for phase, (depths, speeds, slides) in _TANGENTS.items():
        for a in depths:
            for b in speeds:
                for d in slides:
                    yield _tangential(phase, float(a), float(b), float(d))


def _tangential(phase: int, a: float, b: float, d: float) -> Term:
    way, along = ("slip", "v/|v|") if phase == SLIP else ("slide", "s/|s|")
    restores = phase == SLIDING and a == 0.0 and b == 0.0
    energy: tuple[Energy, Energy] = ("dissipative", "active") if phase == SLIP else ("conservative",) * 2 if restores else ("active",) * 2
    return Term(
        f"tangent_depth{WRITTEN[a]}_speed{WRITTEN[b]}_slide{WRITTEN[d]}_{way}",
        "soil.tangential",
        "soil",
        f"pad tangential, {manner((a, 'depth'), (b, 'slip speed'), (d, 'slide'))}, against the {way}",
        f"F_t -= c{factor('δ', '0.01 m', a)}{factor('|v|', '0.1 m/s', b)}{factor('|s|', '0.1 m', d)} {along}",
        "soil.tangent_term",
        tuple((f"soil.tangent_term_{what}", value) for what, value in (("depth", a), ("speed", b), ("slide", d), ("phase", phase))),
        TANGENTIAL / (DEPTH**a * RATE**b * SLIDE**d),
        "N",
        *energy,
        "plowing" if restores and d == 1.0 else "",
    )
