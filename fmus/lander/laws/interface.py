"""What a leg tells about itself at an instant: its pad's motion, its reduced interface model, its energy."""

from typing import NamedTuple

from .base_motion import BaseState, as_base
from .compiled import jit
from .leg import Leg, shape
from .leg_dynamics import mobility, motion_of_shape, tangents
from .leg_inertia import Nodes, carried, first_moment, leg_kinetic
from .leg_stepping import LegState
from .soil_stepping import InterfaceModel
from .vectors import (
    Matrix,
    Quaternion,
    Vector,
    add,
    apply,
    apply_transposed,
    axpy,
    cross,
    product,
    rotation,
    scale,
    sub,
    times,
    transpose,
)


class PadState(NamedTuple):
    """Pose and twist of the pad at its ball joint, L."""

    position: Vector  # m
    attitude: Quaternion
    velocity: Vector  # m/s
    rate: Vector  # rad/s


@jit
def pad_state(base: BaseState, state: LegState) -> PadState:
    """The pad in L from the body and the leg."""
    body = rotation(base.attitude)
    velocity = add(cross(base.rate, state.position), state.velocity)
    return PadState(
        add(base.position, apply(body, state.position)),
        state.attitude,
        add(base.velocity, apply(body, velocity)),
        apply(rotation(state.attitude), state.rate),
    )


@jit
def turned(body: Matrix, m: Matrix) -> Matrix:
    """R m Rᵀ: a matrix of B in L."""
    return product(body, product(m, transpose(body)))


@jit
def interface_model(leg: Leg, gravity: float, base: BaseState, state: LegState, force: Vector, ball: Vector) -> InterfaceModel:
    """How the pad will answer a force, linearised about the last one (coupling.md, scheme B).

    force   last wrench's force on the pad, N, L;  ball  torque of the ball joint on the pad, N m, B
    """
    body = rotation(base.attitude)
    frame = as_base(base, gravity)
    own = apply_transposed(body, force)
    at = shape(leg, state.position, state.velocity)
    motion = motion_of_shape(leg, frame, at, state.position, state.velocity, own, ball, state.crush)
    y = mobility(leg, at)
    stiffness, damping = tangents(leg, at, motion.loads, motion.damping, motion.joints)
    free = sub(motion.nodes.pad, apply(y, own))
    fall = (-gravity, 0.0, 0.0)
    return InterfaceModel(
        add(apply(body, free), fall),
        turned(body, y),
        turned(body, times(-1.0, product(y, stiffness))),
        turned(body, times(-1.0, product(y, damping))),
        add(base.velocity, apply(body, cross(base.rate, state.position))),
        add(apply(body, carried(frame, state.position)), fall),
        leg.pad_inertia,
        leg.joint_damping,
        apply(body, add(base.rate, cross(at.axis, at.swing))),
    )


@jit
def leg_energy(leg: Leg, gravity: float, base: BaseState, state: LegState) -> tuple[float, float]:
    """Kinetic and potential energy of the leg less those of the undeformed leg rigid with the body, J: the body carries the latter."""
    g = leg.geometry
    body = rotation(base.attitude)
    v = apply_transposed(body, base.velocity)
    at = shape(leg, state.position, state.velocity)
    e = scale(1.0 / g.length, sub(g.pad, g.upper))
    now = Nodes(g.upper, at.joint, state.position, at.head, g.right, g.left)
    rest = Nodes(g.upper, axpy(g.cylinder, e, g.upper), g.pad, axpy(-g.piston, e, g.pad), g.right, g.left)
    moving = Nodes(
        carried_velocity(v, base.rate, now.upper),
        add(carried_velocity(v, base.rate, now.joint), at.joint_velocity),
        add(carried_velocity(v, base.rate, now.pad), state.velocity),
        add(carried_velocity(v, base.rate, now.head), at.head_velocity),
        carried_velocity(v, base.rate, now.right),
        carried_velocity(v, base.rate, now.left),
    )
    rigid = Nodes(
        carried_velocity(v, base.rate, rest.upper),
        carried_velocity(v, base.rate, rest.joint),
        carried_velocity(v, base.rate, rest.pad),
        carried_velocity(v, base.rate, rest.head),
        carried_velocity(v, base.rate, rest.right),
        carried_velocity(v, base.rate, rest.left),
    )
    kinetic = leg_kinetic(leg, moving, state.rate) - leg_kinetic(leg, rigid, base.rate)
    shifted = apply(body, sub(first_moment(leg, now), first_moment(leg, rest)))
    return kinetic, gravity * shifted[0]


@jit
def carried_velocity(v: Vector, rate: Vector, r: Vector) -> Vector:
    """v + ω x r, m/s."""
    return add(v, cross(rate, r))
