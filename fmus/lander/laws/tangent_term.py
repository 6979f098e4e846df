"""The generic term of a point's tangential force, a product of powers, with its tangents in the plane."""

from math import sqrt, tanh
from typing import NamedTuple

from .compiled import jit
from .generic_terms import LENGTH, SMOOTHING, power
from .vectors import Matrix, Vector, dot, outer, plus, scale, times

AGAINST_SLIP, AGAINST_SLIDE = range(2)  # phases
SLIDE = 0.1  # m: unit of the slide's power
SPEED = 0.1  # m/s


class TangentTerm(NamedTuple):
    """For ONE point: the coefficient is a fifth of the footpad's."""

    coefficient: float = 0.0  # N
    depth: float = 0.0  # exponent
    speed: float = 0.0  # exponent
    slide: float = 0.0  # exponent
    phase: int = AGAINST_SLIP


class Tangential(NamedTuple):
    """A force in the tangent plane with minus its derivatives by the point's place and velocity."""

    force: Vector  # N
    stiffness: Matrix  # N/m
    damping: Matrix  # N s/m


@jit
def directed(x: float, unit: float, exponent: float) -> tuple[float, float]:
    """g = (x/unit)^exponent tanh(x/1e-3)/x, so that g times a vector of length x is the power along it, and g'/x."""
    if x < 1e-9:
        return (1.0 / SMOOTHING if exponent == 0.0 else 0.0), 0.0
    value, slope = power(x, unit, exponent)
    t = tanh(x / SMOOTHING)
    g = value * t / x
    return g, ((slope * t + value * (1.0 - t * t) / SMOOTHING) / x - g / x) / x


@jit
def tangent_term(term: TangentTerm, depth: float, slip: Vector, slide: Vector, normal: Vector, plane: Matrix) -> Tangential:
    """F_t = -c (δ/0.01 m)^a (|v|/0.1 m/s)^b (|s|/0.1 m)^d times the direction of slip v (phase 0) or of slide s (phase 1), N.

    plane  projector on the tangent plane. For c > 0 phase 0 is dissipative; phase 1 conservative for a = b = 0 and active else.
    """
    c = term.coefficient
    speed, way = sqrt(dot(slip, slip)), sqrt(dot(slide, slide))
    by_depth, depth_slope = power(depth, LENGTH, term.depth)
    if term.phase == AGAINST_SLIP:
        along, length, unit, exponent = slip, speed, SPEED, term.speed
        other, size, other_unit, other_exponent = slide, way, SLIDE, term.slide
    else:
        along, length, unit, exponent = slide, way, SLIDE, term.slide
        other, size, other_unit, other_exponent = slip, speed, SPEED, term.speed
    g, bend = directed(length, unit, exponent)
    weight, weight_slope = power(size, other_unit, other_exponent)
    own = times(c * by_depth * weight, plus(times(g, plane), times(bend, outer(along, along))))
    cross = times(c * by_depth * g * (weight_slope / size if size > 0.0 else 0.0), outer(along, other))
    sinking = times(-c * depth_slope * weight * g, outer(along, normal))
    force = scale(-c * by_depth * weight * g, along)
    if term.phase == AGAINST_SLIP:
        return Tangential(force, plus(sinking, cross), own)
    return Tangential(force, plus(sinking, own), cross)
