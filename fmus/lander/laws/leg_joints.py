"""Viscous damping and bearing friction in the joints of a leg, against the ball joint's motion. Vectors in B."""

from .compiled import jit
from .honeycomb import Tangent, bearing_friction
from .leg import Leg, Shape
from .leg_inertia import Base
from .vectors import Matrix, Vector, across, add, axpy, cross, dot, identity, norm, outer, plus, product, scale, skew, sub, times, transpose


@jit
def on_pad(leg: Leg, at: Shape, force: Vector) -> Vector:
    """Generalised force on p of a force at the connection C: (l_c/s) N f."""
    return scale(leg.geometry.cylinder / at.length, across(at.axis, force))


@jit(inline=True)
def rod_damping(leg: Leg, at: Shape, u: Vector, length: float) -> Matrix:
    """Damping of one secondary's joints against p', N s/m: sliding, turning at the truss and turning at the connection."""
    arm = leg.geometry.cylinder / at.length
    along = scale(arm, across(at.axis, u))  # d(length)/dp
    lateral = plus(identity(1.0), times(-1.0, outer(at.axis, at.axis)))
    turn = times(arm / length, product(skew(u), lateral))  # rod's rate from p'
    cylinder = times(1.0 / at.length, skew(at.axis))
    free = plus(identity(1.0), times(-1.0, outer(u, u)))  # a rod does not feel torque about itself
    bend = plus(turn, times(-1.0, product(free, cylinder)))
    both = plus(product(transpose(turn), turn), product(transpose(bend), bend))
    return times(leg.joint_damping, plus(outer(along, along), both))


@jit(inline=True)
def joint_damping(leg: Leg, at: Shape) -> Matrix:
    """All joints' viscous damping but the ball joint's against p', N s/m (paper: of the order of 100 in every joint)."""
    lateral = plus(identity(1.0), times(-1.0, outer(at.axis, at.axis)))
    primary = plus(outer(at.axis, at.axis), times(1.0 / (at.length * at.length), lateral))
    secondaries = plus(rod_damping(leg, at, at.right, at.right_length), rod_damping(leg, at, at.left, at.left_length))
    return plus(times(leg.joint_damping, primary), secondaries)


@jit
def ball_torque(leg: Leg, base: Base, at: Shape, pad_rate: Vector) -> Vector:
    """Torque of the ball joint on the pad, N m, in B; pad_rate is the pad's angular velocity, rad/s, in B.

    The piston turns with the body and with the strut's swing (a constant-velocity joint at U; a Hooke joint differs in second order).
    """
    return scale(-leg.joint_damping, sub(pad_rate, add(base.rate, cross(at.axis, at.swing))))


@jit(inline=True)
def side_friction(leg: Leg, u: Vector, rate: float, truss: Vector, joint: Vector) -> Tangent:
    """Bearing friction of a secondary, N: its wall force is what its own inertia puts across its end at the connection."""
    wall = across(u, scale(leg.secondary_mass / 6.0, axpy(2.0, joint, truss)))
    return bearing_friction(leg.bearing, norm(wall), rate, leg.bearing_slip)


@jit
def apply_damping(d: Matrix, v: Vector) -> Vector:
    """-D v."""
    return (-dot(d[0], v), -dot(d[1], v), -dot(d[2], v))
