"""Propellant that sloshes: a spherical pendulum at small angles whose mass is already part of the vehicle's. Vectors in B.

The bob hangs at rest at r = hinge - l x̂ and sways by q across X. With c = a - g + ω' x r + ω x (ω x r), the apparent acceleration there,

    q'' = -c_⊥ - 2 ζ ω_0 q' - ω_0² q,   ω_0² = c_x / l  (none where c_x < 0)

On the body acts only what differs from the same mass frozen at r:

    F = -m q'',   M = -m (r x q'' + q x (c + q''))

so that without damping the rod pulls through the hinge: nothing about it.
"""

from math import sqrt
from typing import NamedTuple

from .compiled import jit
from .leg_inertia import Base, carried
from .vectors import Vector, add, axpy, cross, scale


class Pendulum(NamedTuple):
    """The part of the propellant that sloshes."""

    mass: float  # kg; 0: none
    length: float  # m
    damping: float  # ζ
    hinge: Vector  # m, B


class Sway(NamedTuple):
    """Sideways place and velocity of the bob relative to its rest, in B; no part along X."""

    place: Vector  # m
    velocity: Vector  # m/s


@jit
def rest_place(pendulum: Pendulum) -> Vector:
    """r: where the bob hangs, m."""
    return add(pendulum.hinge, (-pendulum.length, 0.0, 0.0))


@jit
def sway_acceleration(pendulum: Pendulum, base: Base, sway: Sway) -> Vector:
    """q'', m/s2."""
    c = carried(base, rest_place(pendulum))
    stiffness = max(c[0], 0.0) / pendulum.length
    damping = 2.0 * pendulum.damping * sqrt(stiffness)
    y = -c[1] - damping * sway.velocity[1] - stiffness * sway.place[1]
    z = -c[2] - damping * sway.velocity[2] - stiffness * sway.place[2]
    return (0.0, y, z)


@jit
def slosh_wrench(pendulum: Pendulum, base: Base, sway: Sway) -> tuple[Vector, Vector]:
    """Force (N) and torque about B's origin (N m) on the body."""
    r = rest_place(pendulum)
    a = sway_acceleration(pendulum, base, sway)
    m = -pendulum.mass
    return scale(m, a), scale(m, add(cross(r, a), cross(sway.place, add(carried(base, r), a))))


@jit
def swayed(sway: Sway, a: Vector, h: float) -> Sway:
    """The sway h seconds on at constant acceleration."""
    return Sway(axpy(h, sway.velocity, axpy(0.5 * h * h, a, sway.place)), axpy(h, a, sway.velocity))
