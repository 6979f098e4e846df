"""Generic terms: products of powers, for an effect that has no name yet. One for a point's normal force, one for a strut.

Signs: soil as in `soil.py` (δ > 0 in the soil, δ̇ > 0 sinking, force outward); struts as in `honeycomb.py`. A coefficient of 0 is no term.
Where a sign changes, tanh takes it over within 1 mm/s (of a stroke or a slide: 1 mm), so that Newton has a slope.
"""

from math import tanh
from typing import NamedTuple

from .compiled import jit
from .normal import Normal

ALWAYS, SINKING, RISING, AGAINST_MOTION = range(4)  # phases
SMOOTHING = 1e-3  # m/s, and m
ALL_STRUTS, PRIMARIES, SECONDARIES = range(3)
LENGTH, SPEED = 0.01, 0.1  # m and m/s: the units of the powers


class NormalTerm(NamedTuple):
    """For ONE point: the coefficient is a fifth of the footpad's."""

    coefficient: float = 0.0  # N
    depth: float = 0.0  # exponent
    rate: float = 0.0  # exponent
    phase: int = ALWAYS


class StrutTerm(NamedTuple):
    """For each of the struts it is meant for."""

    coefficient: float = 0.0  # N
    stroke: float = 0.0  # exponent
    rate: float = 0.0  # exponent
    phase: int = ALWAYS  # 0 against the stroke, 3 against the motion
    struts: int = ALL_STRUTS


@jit
def power(x: float, unit: float, exponent: float) -> tuple[float, float]:
    """(x/unit)^exponent for a magnitude x ≥ 0, and its derivative by x; 1 for exponent 0."""
    if exponent == 0.0:
        return 1.0, 0.0
    if x <= 0.0:
        return 0.0, 0.0
    value = (x / unit) ** exponent
    return value, exponent * value / x


@jit
def signed(x: float) -> tuple[float, float]:
    """tanh(x / 1e-3), the smoothed sign, and its derivative."""
    t = tanh(x / SMOOTHING)
    return t, (1.0 - t * t) / SMOOTHING


@jit
def phase_weight(phase: int, rate: float) -> tuple[float, float]:
    """1 always; |sign| while sinking or while rising, else 0; the sign itself against the motion. With derivative by the rate."""
    if phase == ALWAYS or (phase == SINKING and rate <= 0.0) or (phase == RISING and rate >= 0.0):
        return (1.0 if phase == ALWAYS else 0.0), 0.0
    sign, slope = signed(rate)
    if phase == RISING:
        return -sign, -slope
    return sign, slope


@jit
def normal_term(term: NormalTerm, depth: float, rate: float) -> Normal:
    """F = c (δ/0.01 m)^a (|δ̇|/0.1 m/s)^b times the phase's weight, N, outward.

    Energy for c > 0: phase 1 and 3 dissipative, phase 2 active, phase 0 conservative for b = 0 and active else.
    """
    by_depth, depth_slope = power(depth, LENGTH, term.depth)
    by_rate, rate_slope = power(abs(rate), SPEED, term.rate)
    weight, weight_slope = phase_weight(term.phase, rate)
    turn = rate_slope if rate >= 0.0 else -rate_slope
    scale = term.coefficient * by_depth
    steepness = term.coefficient * depth_slope * by_rate * weight
    return Normal(scale * by_rate * weight, steepness, scale * (turn * weight + by_rate * weight_slope))


@jit
def strut_term(term: StrutTerm, stroke: float, rate: float) -> Normal:
    """F = c (|d|/0.01 m)^a (|ḋ|/0.1 m/s)^b times the sign of d (phase 0) or of ḋ (phase 3), N; the force resists a stroke d > 0.

    Primary: d compression, the force pushes out; secondary: d elongation, the force is tension.
    Energy for c > 0: phase 3 dissipative, phase 0 conservative for b = 0 and active else. Derivatives by d and ḋ.
    """
    by_stroke, stroke_slope = power(abs(stroke), LENGTH, term.stroke)
    by_rate, rate_slope = power(abs(rate), SPEED, term.rate)
    stroke_turn = stroke_slope if stroke >= 0.0 else -stroke_slope
    rate_turn = rate_slope if rate >= 0.0 else -rate_slope
    c = term.coefficient
    if term.phase == AGAINST_MOTION:
        sign, slope = signed(rate)
        by_motion = c * (rate_turn * sign + by_rate * slope)
        return Normal(c * by_stroke * by_rate * sign, c * stroke_turn * by_rate * sign, by_stroke * by_motion)
    sign, slope = signed(stroke)
    by_way = c * (stroke_turn * sign + by_stroke * slope)
    return Normal(c * by_stroke * by_rate * sign, by_rate * by_way, c * by_stroke * rate_turn * sign)
