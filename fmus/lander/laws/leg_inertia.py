"""Inertia of a leg: accelerations and consistent masses of its points, coupling to the base, kinetic energy. Vectors in B.

The base's accelerations are those of a frame in free fall removed (a - g).
"""

from typing import NamedTuple

from .compiled import jit
from .leg import Leg, Shape
from .vectors import Matrix, Vector, across, add, axpy, cross, dot, identity, outer, plus, product, scale, skew, times


class Base(NamedTuple):
    """Motion of the body frame at one instant, expressed in B."""

    pull: Vector  # acceleration of B's origin less gravity, m/s2
    rate: Vector  # angular velocity, rad/s
    spin_up: Vector  # angular acceleration, rad/s2


class Nodes(NamedTuple):
    """A vector at each of the leg's points (accelerations, or forces)."""

    upper: Vector
    joint: Vector
    pad: Vector
    head: Vector
    right: Vector
    left: Vector


@jit
def carried(base: Base, r: Vector) -> Vector:
    """Acceleration less gravity of a point r fixed in B: a + ω' x r + ω x (ω x r), m/s2."""
    return add(base.pull, add(cross(base.spin_up, r), cross(base.rate, cross(base.rate, r))))


@jit
def moving(base: Base, r: Vector, v: Vector) -> Vector:
    """As `carried`, with the Coriolis term of a point moving at v relative to B."""
    return axpy(2.0, cross(base.rate, v), carried(base, r))


@jit(inline=True)
def bias(leg: Leg, base: Base, at: Shape, p: Vector, v: Vector) -> Nodes:
    """Accelerations of the leg's points for p'' = 0."""
    g = leg.geometry
    bend = scale(-2.0 * at.stretch / at.length, at.swing)
    bend = axpy(-dot(at.swing, at.swing), at.axis, bend)  # e'' for p'' = 0
    return Nodes(
        carried(base, g.upper),
        axpy(g.cylinder, bend, moving(base, at.joint, at.joint_velocity)),
        moving(base, p, v),
        axpy(-g.piston, bend, moving(base, at.head, at.head_velocity)),
        carried(base, g.right),
        carried(base, g.left),
    )


@jit(inline=True)
def accelerated(leg: Leg, at: Shape, still: Nodes, a: Vector) -> Nodes:
    """`still` with the relative acceleration p'' = a (m/s2) added."""
    lateral = scale(1.0 / at.length, across(at.axis, a))
    return Nodes(
        still.upper,
        axpy(leg.geometry.cylinder, lateral, still.joint),
        add(still.pad, a),
        axpy(-leg.geometry.piston, lateral, add(still.head, a)),
        still.right,
        still.left,
    )


@jit(inline=True)
def nodal_inertia(leg: Leg, a: Nodes) -> Nodes:
    """Mass times acceleration lumped to the points by the rods' consistent masses, N."""
    c, k, m = leg.cylinder_mass / 6.0, leg.piston_mass / 6.0, leg.secondary_mass / 6.0
    at_joint = add(
        scale(c, axpy(2.0, a.joint, a.upper)),
        scale(m, add(axpy(4.0, a.joint, a.right), a.left)),
    )
    return Nodes(
        scale(c, axpy(2.0, a.upper, a.joint)),
        at_joint,
        axpy(leg.pad_mass, a.pad, scale(k, axpy(2.0, a.pad, a.head))),
        scale(k, axpy(2.0, a.head, a.pad)),
        scale(m, axpy(2.0, a.right, a.joint)),
        scale(m, axpy(2.0, a.left, a.joint)),
    )


@jit
def axial_mass(leg: Leg) -> float:
    """m_e: what moves along the primary, kg."""
    return leg.piston_mass + leg.pad_mass


@jit
def lateral_mass(leg: Leg, at: Shape) -> float:
    """m_n: what the ball joint feels across the primary, kg."""
    arm = leg.geometry.cylinder / at.length
    k = 1.0 - leg.geometry.piston / at.length
    swinging = (leg.cylinder_mass + 2.0 * leg.secondary_mass) / 3.0
    return arm * arm * swinging + leg.piston_mass / 3.0 * (1.0 + k + k * k) + leg.pad_mass


@jit(inline=True)
def base_coupling(leg: Leg, at: Shape, p: Vector) -> tuple[Matrix, Matrix]:
    """How the base's accelerations load p, kg and kg m: inertia force on p = M_c pull + S spin_up.

    The body feels p'' through the transposes.
    """
    g, e = leg.geometry, at.axis
    arm = g.cylinder / at.length
    k = 1.0 - g.piston / at.length
    c, m, w = leg.cylinder_mass / 6.0, leg.secondary_mass / 6.0, leg.piston_mass / 6.0
    swinging = arm * (3.0 * c + 6.0 * m) + 3.0 * w * (1.0 + k) + leg.pad_mass
    ends = add(scale(c, g.upper), scale(m, add(g.right, g.left)))
    q_n = axpy(arm, axpy(2.0 * c + 4.0 * m, at.joint, ends), axpy(w * (2.0 + k) + leg.pad_mass, p, scale(w * (1.0 + 2.0 * k), at.head)))
    q_e = axpy(3.0 * w + leg.pad_mass, p, scale(3.0 * w, at.head))
    along = outer(e, e)
    lateral = plus(identity(1.0), times(-1.0, along))
    straight = plus(times(swinging, lateral), times(axial_mass(leg), along))
    turning = times(-1.0, plus(product(along, skew(q_e)), product(lateral, skew(q_n))))
    return straight, turning


@jit
def times_diagonal(d: Vector, a: Vector) -> Vector:
    """diag(d) a."""
    return (d[0] * a[0], d[1] * a[1], d[2] * a[2])


@jit
def first_moment(leg: Leg, r: Nodes) -> Vector:
    """Mass times centre of mass, kg m, of the leg with its points at r."""
    rods = add(
        scale(0.5 * leg.cylinder_mass, add(r.upper, r.joint)),
        scale(0.5 * leg.piston_mass, add(r.pad, r.head)),
    )
    sides = scale(0.5 * leg.secondary_mass, add(axpy(2.0, r.joint, r.right), r.left))
    return axpy(leg.pad_mass, r.pad, add(rods, sides))


@jit
def rod_energy(mass: float, a: Vector, b: Vector) -> float:
    """Kinetic energy of a rod whose ends move at a and b (m/s), J."""
    return mass / 6.0 * (dot(a, a) + dot(a, b) + dot(b, b))


@jit
def leg_kinetic(leg: Leg, velocity: Nodes, pad_rate: Vector) -> float:
    """Kinetic energy, J, from the points' absolute velocities and the pad's angular velocity in pad axes."""
    moving_rods = (
        rod_energy(leg.cylinder_mass, velocity.upper, velocity.joint)
        + rod_energy(leg.piston_mass, velocity.pad, velocity.head)
        + rod_energy(leg.secondary_mass, velocity.right, velocity.joint)
        + rod_energy(leg.secondary_mass, velocity.left, velocity.joint)
    )
    spin = 0.5 * dot(pad_rate, times_diagonal(leg.pad_inertia, pad_rate))
    return moving_rods + 0.5 * leg.pad_mass * dot(velocity.pad, velocity.pad) + spin
