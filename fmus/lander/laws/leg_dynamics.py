"""Equation of motion of a leg: the ball joint's acceleration relative to the body, its tangents and its mobility. Vectors in B.

The lateral half of the equations solves before the axial one, so that bearing friction, which needs the wall force, closes no loop.
"""

from typing import NamedTuple

from .compiled import jit
from .honeycomb import bearing_friction
from .leg import Crush, Leg, Loads, Shape, shape, strut_loads
from .leg_inertia import Base, Nodes, accelerated, axial_mass, bias, lateral_mass, nodal_inertia
from .leg_joints import apply_damping, joint_damping, on_pad, side_friction
from .vectors import ZERO, Matrix, Vector, across, add, axpy, cross, dot, identity, norm, outer, plus, scale, sub, times


class Motion(NamedTuple):
    """Answer of the leg at one instant."""

    acceleration: Vector  # of p relative to B, m/s2
    nodes: Nodes  # accelerations less gravity, m/s2
    loads: Loads  # without bearing friction
    primary: float  # axial force incl. bearing friction, compression positive, N
    right: float  # axial force incl. bearing friction, tension positive, N
    left: float
    damping: float  # dF/dv of the primary's bearing friction, N s/m
    joints: Matrix  # viscous damping of the joints against p', N s/m
    power: float  # of all forces inside the leg; negative: taken from the motion, W


@jit
def leg_motion(leg: Leg, base: Base, p: Vector, v: Vector, force: Vector, ball: Vector, crush: Crush) -> Motion:
    """Acceleration of the ball joint relative to B, and what the struts carry.

    p, v    ball joint's position (m) and velocity (m/s) relative to B
    force   on the pad at the ball joint, N;  ball  torque of the ball joint on the pad, N m
    """
    return motion_of_shape(leg, base, shape(leg, p, v), p, v, force, ball, crush)


@jit(inline=True)
def motion_of_shape(leg: Leg, base: Base, at: Shape, p: Vector, v: Vector, force: Vector, ball: Vector, crush: Crush) -> Motion:
    """`leg_motion` where the shape is known."""
    loads = strut_loads(leg, at, crush)
    e = at.axis
    still = bias(leg, base, at, p, v)
    joints = joint_damping(leg, at)
    drag = apply_damping(joints, v)
    lever = scale(1.0 / at.length, cross(e, ball))  # reaction -ball on the piston, as a force on p
    outside = add(force, add(drag, lever))
    m_n = lateral_mass(leg, at)

    right, left = loads.right.force, loads.left.force
    lateral = lateral_acceleration(leg, at, still, outside, right, left, m_n)
    joint = axpy(leg.geometry.cylinder / at.length, lateral, still.joint)
    right_rate, left_rate = dot(at.right, at.joint_velocity), dot(at.left, at.joint_velocity)
    right += side_friction(leg, at.right, right_rate, still.right, joint).force
    left += side_friction(leg, at.left, left_rate, still.left, joint).force
    lateral = lateral_acceleration(leg, at, still, outside, right, left, m_n)

    k = 1.0 - leg.geometry.piston / at.length
    middle = add(axpy(0.5, add(still.pad, still.head), ZERO), scale(0.5 * (1.0 + k), lateral))
    carried_load = axpy(leg.pad_mass, add(still.pad, lateral), scale(leg.piston_mass, middle))
    wall = norm(across(e, sub(carried_load, force)))
    friction = bearing_friction(leg.bearing, wall, -at.stretch, leg.bearing_slip)
    primary = loads.primary.force + friction.force
    inertia = nodal_inertia(leg, still)
    axial = (dot(e, sub(outside, add(inertia.pad, inertia.head))) + primary) / axial_mass(leg)

    a = axpy(axial, e, lateral)
    power = primary * at.stretch - right * right_rate - left * left_rate + dot(drag, v)
    return Motion(a, accelerated(leg, at, still, a), loads, primary, right, left, friction.damping, joints, power)


@jit
def lateral_acceleration(leg: Leg, at: Shape, still: Nodes, outside: Vector, right: float, left: float, m_n: float) -> Vector:
    """N p'' from the forces across the primary, m/s2."""
    inertia = nodal_inertia(leg, still)
    struts = on_pad(leg, at, add(scale(-right, at.right), axpy(-left, at.left, scale(-1.0, inertia.joint))))
    k = 1.0 - leg.geometry.piston / at.length
    rest = sub(outside, add(inertia.pad, scale(k, inertia.head)))
    return scale(1.0 / m_n, add(across(at.axis, rest), struts))


@jit(inline=True)
def tangents(leg: Leg, at: Shape, loads: Loads, friction: float, joints: Matrix) -> tuple[Matrix, Matrix]:
    """-dQ/dp (N/m) and -dQ/dv (N s/m) of the struts' forces on p, for Newton's matrix and the reduced interface model.

    Material and geometric stiffness of the struts and all damping; inertia's dependence on p is left out (a thousandth of these).
    friction   slope of the primary's bearing friction, N s/m;  joints  viscous damping of the joints, N s/m
    """
    e, s = at.axis, at.length
    arm = leg.geometry.cylinder / s
    lateral = plus(identity(1.0), times(-1.0, outer(e, e)))
    p = loads.primary
    stiffness = plus(times(p.stiffness, outer(e, e)), times(-p.force / s, lateral))
    damping = plus(times(p.damping + friction, outer(e, e)), joints)
    for u, length, load in ((at.right, at.right_length, loads.right), (at.left, at.left_length, loads.left)):
        along = scale(arm, across(e, u))
        side = across(e, u)
        turn = plus(lateral, times(-1.0, outer(side, side)))
        lean = plus(times(dot(e, u), lateral), plus(outer(e, side), outer(side, e)))  # how (l_c/s) N u follows e and s
        geometric = times(load.force, plus(times(arm * arm / length, turn), times(-arm / s, lean)))
        stiffness = plus(stiffness, plus(times(load.stiffness, outer(along, along)), geometric))
        damping = plus(damping, times(load.damping, outer(along, along)))
    return stiffness, damping


@jit
def mobility(leg: Leg, at: Shape) -> Matrix:
    """Y = e eᵀ/m_e + N/m_n: acceleration of the ball joint by a force on it, 1/kg."""
    axial, lateral = 1.0 / axial_mass(leg), 1.0 / lateral_mass(leg, at)
    return plus(identity(lateral), times(axial - lateral, outer(at.axis, at.axis)))
