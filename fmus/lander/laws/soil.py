"""Normal and tangential force of the regolith on one contact point (paper, eqs. 5 to 10).

Sign convention: δ > 0 in the soil, δ̇ > 0 sinking (eqs. 5, 8 and 9 are printed for the opposite sign). Forces never pull, but for adhesion
and a generic term against the motion (`soil_effects.py`, `generic_terms.py`).
"""

from math import cos, pi, sin, sqrt, tanh
from typing import NamedTuple

from .compiled import jit
from .generic_terms import AGAINST_MOTION, normal_term
from .normal import Normal
from .soil_effects import NO_EFFECTS, SoilEffects, adhesion, dragged, layer, rebound, stribeck
from .vectors import Vector

PUBLISHED = 1  # eq. 6 with w_b and w_r
RATE_INDEPENDENT = 2  # compaction without creep
UNLATCHED = -1.0  # δ_MAX before the point has come to rest for the first time


class Soil(NamedTuple):
    """Table 4, for ONE point: K_n, C_n and K_p are a fifth of the footpad's (physics.md)."""

    law: int
    bearing: float  # K_n, N/m^p
    exponent: float  # p
    damping: float  # C_n, N s/m
    ramp: float  # δ_d, m; 0 means w_d = 1
    band: float  # b, m
    residual: float  # residual sink rate, m/s
    friction: float  # μ
    plowing: float  # K_p, N/m
    slip_velocity: float  # regularises Coulomb's sign, m/s
    effects: SoilEffects = NO_EFFECTS


@jit
def damping_weight(soil: Soil, depth: float) -> tuple[float, float]:
    """w_d of eq. 7 and its derivative (1/m): ½ [1 - cos(π δ/δ_d)] up to δ_d, 1 beyond."""
    if depth >= soil.ramp:
        return 1.0, 0.0
    a = pi * depth / soil.ramp
    return 0.5 * (1.0 - cos(a)), 0.5 * pi / soil.ramp * sin(a)


@jit
def spring_force(soil: Soil, depth: float) -> tuple[float, float]:
    """K_n δ^p, with the layer's part where there is one, N; and its slope, N/m. δ > 0."""
    spring = soil.bearing * depth**soil.exponent
    slope = soil.exponent * spring / depth
    if soil.effects.layer_stiffness > 0.0:
        more, steeper = layer(soil.effects, depth)
        return spring + more, slope + steeper
    return spring, slope


@jit(inline=True)
def published_normal(soil: Soil, depth: float, rate: float, datum: float) -> Normal:
    """F_n = w_b w_r (K_n δ^p + w_d C_n δ̇) for δ > 0, never negative. Eqs. 6 to 9. A drag acts inside w_b.

    w_b = ½ [1 - tanh(6/b ((δ_MAX - δ) - b/2))], 1 before δ_MAX is latched, 0.9975 at the datum
    w_r = ½ [1 + tanh(6/ṙ (δ̇ - ṙ/2))]: F_n falls to zero with the sink rate, so a resting pad creeps at about half the residual
    rate (0.05 mm/s) by design, and a rebound is free of force.
    """
    spring, spring_slope = spring_force(soil, depth)
    w_d, w_d_slope = damping_weight(soil, depth)
    viscous = w_d * soil.damping
    inner = spring + viscous * rate
    if inner <= 0.0:
        return Normal(0.0, 0.0, 0.0)
    t = tanh(6.0 / soil.residual * (rate - 0.5 * soil.residual))
    w_r, w_r_slope = 0.5 * (1.0 + t), 3.0 / soil.residual * (1.0 - t * t)
    w_b, w_b_slope = 1.0, 0.0
    if datum >= 0.0:
        above = max(datum - depth, 0.0)
        u = tanh(6.0 / soil.band * (above - 0.5 * soil.band))
        w_b = 0.5 * (1.0 - u)
        w_b_slope = 3.0 / soil.band * (1.0 - u * u) if depth < datum else 0.0
    inner_slope = spring_slope + w_d_slope * soil.damping * rate
    own = Normal(
        w_b * w_r * inner,
        w_r * (w_b_slope * inner + w_b * inner_slope),
        w_b * (w_r_slope * inner + w_r * viscous),
    )
    if soil.effects.inertial_drag > 0.0:
        return dragged(soil.effects, own, w_b, w_b_slope, rate)
    return own


@jit
def compacted_normal(soil: Soil, depth: float, rate: float, datum: float) -> Normal:
    """F_n = φ (K_n δ_m^p + w_d C_n max(δ̇, 0)), φ = 1 - (δ_m - δ)/b_m in [0, 1], δ_m = max(δ_MAX, δ): rate-independent compaction.

    Plastic flow on the virgin curve K_n δ^p, elastic unloading along the band b_m = min(b, 2 δ_m/(p + 1)), so that a print shallower than
    the band gives back no more than the work put in; no creep. Damping acts while sinking. Same parameters as the published law; our
    second law (physics.md), not the paper's. A drag acts inside φ.
    """
    deepest = max(datum, depth)
    if deepest <= 0.0:
        return Normal(0.0, 0.0, 0.0)
    band = min(soil.band, 2.0 * deepest / (soil.exponent + 1.0))
    share = 1.0 - (deepest - depth) / band
    if share <= 0.0:
        return Normal(0.0, 0.0, 0.0)
    spring, spring_slope = spring_force(soil, deepest)
    sinking = max(rate, 0.0)
    w_d, w_d_slope = damping_weight(soil, depth)
    inner = spring + w_d * soil.damping * sinking
    if depth >= datum:
        slope = spring_slope + w_d_slope * soil.damping * sinking
    else:
        slope = inner / band + share * w_d_slope * soil.damping * sinking
    own = Normal(share * inner, slope, share * w_d * soil.damping if rate > 0.0 else 0.0)
    if soil.effects.inertial_drag > 0.0:
        return dragged(soil.effects, own, share, 1.0 / band if depth < datum else 0.0, rate)
    return own


@jit(inline=True)
def affected_normal(soil: Soil, own: Normal, depth: float, rate: float, datum: float) -> Normal:
    """The law's own force with the effects that stand beside it: the larger of it and the rebound, plus generic term, plus adhesion.

    A generic term does not make the soil pull, unless it acts against the motion.
    """
    effects = soil.effects
    if effects.rebound_share > 0.0:
        back = rebound(effects, soil.bearing, soil.exponent, depth, datum)
        if back.force > own.force:
            own = back
    if effects.normal_term.coefficient != 0.0:
        term = normal_term(effects.normal_term, depth, rate)
        own = Normal(own.force + term.force, own.stiffness + term.stiffness, own.damping + term.damping)
        if own.force < 0.0 and effects.normal_term.phase != AGAINST_MOTION:
            own = Normal(0.0, 0.0, 0.0)
    if effects.adhesion > 0.0:
        pull = adhesion(effects, soil.residual, rate)
        own = Normal(own.force + pull.force, own.stiffness + pull.stiffness, own.damping + pull.damping)
    return own


@jit(inline=True)
def normal_force(soil: Soil, depth: float, rate: float, datum: float) -> Normal:
    """F_n (N) at depth δ (m) and sink rate δ̇ (m/s); datum is δ_MAX (m), or UNLATCHED. Zero above the surface."""
    if depth <= 0.0:
        return Normal(0.0, 0.0, 0.0)
    own = compacted_normal(soil, depth, rate, datum) if soil.law == RATE_INDEPENDENT else published_normal(soil, depth, rate, datum)
    if soil.effects.normal:
        return affected_normal(soil, own, depth, rate, datum)
    return own


@jit
def latched(soil: Soil, depth: float, rate: float, datum: float) -> float:
    """δ_MAX (m) after an instant at depth δ and sink rate δ̇: latches when the sink rate first falls to ṙ, then only grows.

    The rate-independent law needs no rest: its datum is the greatest depth.
    """
    if depth <= 0.0:
        return datum
    if datum < 0.0 and soil.law == PUBLISHED and rate > soil.residual:
        return datum
    return max(datum, depth)


@jit
def friction_scale(soil: Soil, speed: float) -> float:
    """k = μ / sqrt(v² + v_s²), s/m: Coulomb's force is F_n times this times the slip velocity, against it."""
    mu = soil.friction
    if soil.effects.stribeck_rise > 0.0:
        mu += stribeck(soil.effects, speed)[0]
    return mu / sqrt(speed * speed + soil.slip_velocity * soil.slip_velocity)


@jit
def friction_bend(soil: Soil, speed: float, k: float) -> float:
    """k'/(k v), s2/m2: how Coulomb's scale k follows the slip's speed v; 0 without friction."""
    if soil.effects.stribeck_rise > 0.0:
        rise, slope = stribeck(soil.effects, speed)
        mu = soil.friction + rise
        return (slope / mu if mu > 0.0 else 0.0) - 1.0 / (speed * speed + soil.slip_velocity * soil.slip_velocity)
    return -((k / soil.friction) ** 2) if soil.friction > 0.0 else 0.0


@jit
def tangential_force(soil: Soil, normal: float, slip: Vector, slide: Vector) -> Vector:
    """F_t = -μ F_n v/|v| - K_p δ_t, N, both vectors in the tangent plane. Eq. 6, second line.

    normal  F_n, N;  slip  velocity, m/s;  slide  path of this point in the soil since first contact, m
    """
    k = normal * friction_scale(soil, sqrt(slip[0] * slip[0] + slip[1] * slip[1] + slip[2] * slip[2]))
    return (-k * slip[0] - soil.plowing * slide[0], -k * slip[1] - soil.plowing * slide[1], -k * slip[2] - soil.plowing * slide[2])


def predicted_depth(mass: float, gravity: float, bearing: float, exponent: float) -> float:
    """δ = ((p + 1) m g / K_n)^(1/p), m: where a mass set down on the surface comes to rest. Eq. 10."""
    return float(((exponent + 1.0) * mass * gravity / bearing) ** (1.0 / exponent))
