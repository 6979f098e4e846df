"""A generic wrench on the body along or about one of its axes: a coefficient times one of eight bases."""

from math import exp
from typing import NamedTuple

from .compiled import jit
from .vectors import ZERO, Vector

CONSTANT, FADING, SPEED, SPEED_SQUARED, RATE, RATE_SQUARED, TILT, THRUST = range(1, 9)


class Term(NamedTuple):
    """What acts, and what it follows."""

    coefficient: float  # N along an axis, N m about one; 0: none
    axis: int  # 1 to 6: Fx, Fy, Fz, Tx, Ty, Tz in B
    basis: int  # 1 to 8
    time: float  # s, of the fading basis


@jit
def basis_value(term: Term, t: float, velocity: Vector, rate: Vector, tilt: Vector, thrust: float) -> float:
    """What the term follows, without unit.

    1 constant; 2 exp(-t/τ); 3 v/(0.1 m/s); 4 the same times its absolute value; 5 ω/(0.1 rad/s); 6 the same times its absolute value;
    7 angle/(0.1 rad); 8 T/(1000 N); with the components along or about the term's own axis.

    t since the start of the run, s; velocity (m/s) and rate (rad/s) in B; tilt: yaw, pitch, roll angle, rad; thrust, N
    """
    i = (term.axis - 1) % 3
    v, w = velocity[i] / 0.1, rate[i] / 0.1
    if term.basis == CONSTANT:
        return 1.0
    if term.basis == FADING:
        return exp(-t / term.time)
    if term.basis == SPEED:
        return v
    if term.basis == SPEED_SQUARED:
        return v * abs(v)
    if term.basis == RATE:
        return w
    if term.basis == RATE_SQUARED:
        return w * abs(w)
    if term.basis == TILT:
        return tilt[i] / 0.1
    return thrust / 1000.0


@jit
def term_wrench(term: Term, value: float) -> tuple[Vector, Vector]:
    """Force (N) and torque (N m, about B's origin) in B."""
    f = term.coefficient * value
    i = (term.axis - 1) % 3
    on_axis = (f if i == 0 else 0.0, f if i == 1 else 0.0, f if i == 2 else 0.0)
    if term.axis <= 3:
        return on_axis, ZERO
    return ZERO, on_axis
