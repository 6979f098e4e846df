"""Effects of the regolith beyond the paper's law, for one contact point: layer, inertial drag, adhesion, rebound, Stribeck's friction.

Signs as in `soil.py`. All are null by default, and a soil without them takes the old path.
"""

from math import exp, tanh
from typing import NamedTuple

from .compiled import jit
from .generic_terms import NormalTerm
from .normal import Normal
from .tangent_term import TangentTerm


class SoilEffects(NamedTuple):
    """For ONE point: stiffness, drag, adhesion and the terms' coefficients are a fifth of the footpad's."""

    normal: bool = False  # whether rebound, adhesion or a normal term acts
    layer_stiffness: float = 0.0  # N/m
    layer_depth: float = 0.02  # m
    inertial_drag: float = 0.0  # N s2/m2
    adhesion: float = 0.0  # N
    rebound_share: float = 0.0  # ρ
    rebound_depth: float = 5e-3  # b_r, m
    stribeck_rise: float = 0.0  # of μ at rest
    stribeck_velocity: float = 0.05  # m/s
    normal_term: NormalTerm = NormalTerm()
    tangent_term: TangentTerm = TangentTerm()


NO_EFFECTS = SoilEffects()


@jit
def layer(effects: SoilEffects, depth: float) -> tuple[float, float]:
    """K_l max(0, δ - δ_l), N, and its slope, N/m: a stiffer layer that begins at depth δ_l. Part of the spring."""
    below = depth - effects.layer_depth
    if below <= 0.0:
        return 0.0, 0.0
    return effects.layer_stiffness * below, effects.layer_stiffness


@jit
def dragged(effects: SoilEffects, own: Normal, weight: float, weight_slope: float, rate: float) -> Normal:
    """The law's own force with w A δ̇² added while sinking: momentum given to the soil that is pushed away. Dissipative.

    weight  w and its slope by δ (1/m): that of contact with the ground, w_b or φ
    """
    if rate <= 0.0:
        return own
    drag = effects.inertial_drag * rate * rate
    return Normal(
        own.force + weight * drag,
        own.stiffness + weight_slope * drag,
        own.damping + 2.0 * weight * effects.inertial_drag * rate,
    )


@jit
def rebound(effects: SoilEffects, bearing: float, exponent: float, depth: float, datum: float) -> Normal:
    """ρ K_n δ_m^p max(0, 1 - (δ_m - δ)/b), N, at any sink rate, δ_m = max(δ_MAX, δ): the ground gives part of its force back.

    b = min(b_r, 2 δ_m/(p + 1)), so that ½ ρ K_n δ_m^p b, what comes back, never exceeds the work K_n δ_m^(p+1)/(p + 1) put in: dissipative.
    Nothing before δ_MAX is latched.
    """
    if datum < 0.0:
        return Normal(0.0, 0.0, 0.0)
    deepest = max(datum, depth)
    full = effects.rebound_share * bearing * deepest**exponent
    if depth >= datum:
        return Normal(full, exponent * full / depth, 0.0)
    band = min(effects.rebound_depth, 2.0 * deepest / (exponent + 1.0))
    share = 1.0 - (deepest - depth) / band
    if share <= 0.0:
        return Normal(0.0, 0.0, 0.0)
    return Normal(share * full, full / band, 0.0)


@jit
def adhesion(effects: SoilEffects, residual: float, rate: float) -> Normal:
    """-A tanh(-δ̇/ṙ) while a point in the soil rises, N: it pulls the pad down. Dissipative."""
    if rate >= 0.0:
        return Normal(0.0, 0.0, 0.0)
    t = tanh(rate / residual)
    return Normal(effects.adhesion * t, 0.0, effects.adhesion * (1.0 - t * t) / residual)


@jit
def stribeck(effects: SoilEffects, speed: float) -> tuple[float, float]:
    """Δμ = rise exp(-(v/v_s)²), added to μ, and Δμ'/v, s2/m2: a slow slide sticks more than a fast one."""
    rise = effects.stribeck_rise * exp(-((speed / effects.stribeck_velocity) ** 2))
    return rise, -2.0 * rise / (effects.stribeck_velocity * effects.stribeck_velocity)
