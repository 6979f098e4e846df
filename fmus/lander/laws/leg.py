"""Dynamics of one cantilever leg in minimal coordinates: the position p of its footpad's ball joint in the body frame.

The primary strut runs from the upper joint U along the unit vector e to the ball joint, p = U + s e; its cylinder ends at
C = U + l_c e, where both secondaries from T_right and T_left arrive; its piston's head is H = p - l_p e. So p fixes everything:
three stroking freedoms, no constraint equation. Struts are thin rods, whose mass between end points i and j acts as the consistent
mass m/6 [2 1; 1 2] on the accelerations of those points (exact for momentum and its moment; the secondaries' rods stretch). The pad's mass
sits at the ball joint; its rotation is a separate equation (`pad_spin`). With N = I - e eᵀ the mass matrix is m_e e eᵀ + m_n N: it
inverts by hand, and the lateral half solves before the axial one, so that bearing friction, which needs the wall force, closes no loop.

All vectors in B unless said otherwise; the base's accelerations are those of a frame in free fall removed (a - g).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compiled import jit
from .generic_terms import PRIMARIES, SECONDARIES, StrutTerm, strut_term
from .honeycomb import Core, Stop, Tangent, primary_force, secondary_force
from .leg_geometry import LegGeometry
from .vectors import ZERO, Vector, axpy, dot, norm, scale, sub


class Leg(NamedTuple):
    """Everything constant about one leg."""

    geometry: LegGeometry
    cylinder_mass: float  # kg
    piston_mass: float
    secondary_mass: float
    pad_mass: float
    pad_inertia: Vector  # about the pad's own axes, kg m2
    primary: Core
    tension: Core  # of each secondary
    compression: Core
    stop: Stop
    bearing: float  # μ_B
    bearing_slip: float  # v_b, m/s
    joint_damping: float  # N s/m in sliding joints, N m s/rad in turning ones
    term: StrutTerm = StrutTerm()  # generic, null


class Crush(NamedTuple):
    """Memory of the five cores: d_MAX, m. Latched by `crushed`."""

    primary: float
    right_tension: float
    right_compression: float
    left_tension: float
    left_compression: float


class Shape(NamedTuple):
    """Where the leg is and how it moves relative to the body."""

    axis: Vector  # e
    length: float  # s, m
    stretch: float  # ds/dt, m/s
    swing: Vector  # de/dt, rad/s
    joint: Vector  # C, m
    joint_velocity: Vector
    head: Vector  # H, m
    head_velocity: Vector
    right: Vector  # unit vector T_right -> C
    right_length: float
    left: Vector
    left_length: float


class Loads(NamedTuple):
    """Axial forces with tangents; primary: compression pushes out; secondaries: tension."""

    primary: Tangent
    right: Tangent
    left: Tangent


@jit(inline=True)
def shape(leg: Leg, p: Vector, v: Vector) -> Shape:
    """Kinematics from the ball joint's position p (m) and velocity v (m/s) relative to B."""
    g = leg.geometry
    w = sub(p, g.upper)
    s = norm(w)
    e = scale(1.0 / s, w)
    stretch = dot(e, v)
    swing = scale(1.0 / s, axpy(-stretch, e, v))
    joint = axpy(g.cylinder, e, g.upper)
    to_right, to_left = sub(joint, g.right), sub(joint, g.left)
    right, left = norm(to_right), norm(to_left)
    return Shape(
        e,
        s,
        stretch,
        swing,
        joint,
        scale(g.cylinder, swing),
        axpy(-g.piston, e, p),
        axpy(-g.piston, swing, v),
        scale(1.0 / right, to_right),
        right,
        scale(1.0 / left, to_left),
        left,
    )


@jit(inline=True)
def strut_loads(leg: Leg, at: Shape, crush: Crush) -> Loads:
    """Core and stop forces of the three struts, N."""
    g = leg.geometry
    primary = primary_force(leg.primary, leg.stop, g.length - at.length, -at.stretch, crush.primary)
    right = secondary_force(
        leg.tension,
        leg.compression,
        leg.stop,
        at.right_length - g.right_length,
        dot(at.right, at.joint_velocity),
        crush.right_tension,
        crush.right_compression,
    )
    left = secondary_force(
        leg.tension,
        leg.compression,
        leg.stop,
        at.left_length - g.left_length,
        dot(at.left, at.joint_velocity),
        crush.left_tension,
        crush.left_compression,
    )
    if leg.term.coefficient != 0.0:
        return with_term(leg, at, Loads(primary, right, left))
    return Loads(primary, right, left)


@jit
def with_term(leg: Leg, at: Shape, own: Loads) -> Loads:
    """The struts' own loads with the generic term in those that it is meant for."""
    g, term = leg.geometry, leg.term
    primary, right, left = own.primary, own.right, own.left
    if term.struts != SECONDARIES:
        primary = with_force(primary, term, g.length - at.length, -at.stretch)
    if term.struts != PRIMARIES:
        right = with_force(right, term, at.right_length - g.right_length, dot(at.right, at.joint_velocity))
        left = with_force(left, term, at.left_length - g.left_length, dot(at.left, at.joint_velocity))
    return Loads(primary, right, left)


@jit
def with_force(own: Tangent, term: StrutTerm, stroke: float, rate: float) -> Tangent:
    """A strut's load with the generic term at its stroke (m) and rate (m/s)."""
    more = strut_term(term, stroke, rate)
    return Tangent(own.force + more.force, own.stiffness + more.stiffness, own.damping + more.damping)


@jit
def strokes(leg: Leg, p: Vector) -> Vector:
    """Primary compression, right and left elongation, m."""
    at = shape(leg, p, ZERO)
    g = leg.geometry
    return (g.length - at.length, at.right_length - g.right_length, at.left_length - g.left_length)


@jit
def bottomed(leg: Leg, primary: float, right: float, left: float) -> bool:
    """Whether any strut is beyond the end of its cartridge; strokes as `strokes` gives them, m."""
    near, far = -leg.compression.limit, leg.tension.limit
    return primary > leg.primary.limit or not (near <= right <= far and near <= left <= far)


@jit
def crushed(leg: Leg, p: Vector, crush: Crush) -> Crush:
    """Memories after the leg has been at p: each d_MAX only grows."""
    d = strokes(leg, p)
    return Crush(
        max(crush.primary, d[0]),
        max(crush.right_tension, d[1]),
        max(crush.right_compression, -d[1]),
        max(crush.left_tension, d[2]),
        max(crush.left_compression, -d[2]),
    )


def leg_mass(leg: Leg) -> float:
    """Mass of the whole leg, kg."""
    return leg.cylinder_mass + leg.piston_mass + 2.0 * leg.secondary_mass + leg.pad_mass


def rigid_inertia(leg: Leg) -> NDArray[np.float64]:
    """Inertia of the undeformed leg about B's origin, frame B, kg m2 (3, 3): rods by their consistent masses, and the pad's disc.

    Of a rod from a to b ∫ r r' dm = m/6 (2 a a' + a b' + b a' + 2 b b').
    """
    upper, pad, right, left = (np.array(point) for point in (leg.geometry.upper, leg.geometry.pad, leg.geometry.right, leg.geometry.left))
    axis = (pad - upper) / leg.geometry.length
    joint, head = upper + leg.geometry.cylinder * axis, pad - leg.geometry.piston * axis
    rods = ((leg.cylinder_mass, upper, joint), (leg.piston_mass, pad, head), (leg.secondary_mass, right, joint),
            (leg.secondary_mass, left, joint))  # fmt: skip
    second = leg.pad_mass * np.outer(pad, pad)
    for mass, a, b in rods:
        second += mass / 6.0 * (2.0 * np.outer(a, a) + np.outer(a, b) + np.outer(b, a) + 2.0 * np.outer(b, b))
    return np.asarray(np.trace(second) * np.eye(3) - second + np.diag(leg.pad_inertia))


def disc_inertia(mass: float, radius: float) -> Vector:
    """Principal inertia of a thin disc with its axis along x, kg m2: ½ m r², ¼ m r², ¼ m r²."""
    return (0.5 * mass * radius * radius, 0.25 * mass * radius * radius, 0.25 * mass * radius * radius)
