"""A leg between its arrays: the blocks of a unit's memory in, one interval, the blocks out. The order is that of the unit's variables."""

import numpy as np
from numpy.typing import NDArray

from .base_motion import BaseMotion, BaseState, as_base, base_at
from .blocks import matrix, put_matrix, put_quaternion, put_vector, quaternion, vector
from .compiled import jit
from .interface import interface_model, leg_energy, pad_state
from .leg import Crush, Leg, Loads, bottomed, shape, strokes
from .leg_dynamics import leg_motion, tangents
from .leg_inertia import axial_mass, base_coupling, lateral_mass
from .leg_joints import joint_damping
from .leg_reaction import mount_wrench
from .leg_stepping import LegState, PadLoad, Stage, start_state, step_leg
from .soil_stepping import InterfaceModel
from .vectors import (
    ZERO,
    Vector,
    add,
    apply,
    apply_transposed,
    identity,
    outer,
    plus,
    product,
    rotation,
    scale,
    sub,
    times,
    transpose,
)

Array = NDArray[np.float64]
GAVE_UP, DONE, BOTTOMED = range(3)
MOUNT_WORK, PAD_WORK, KINETIC, POTENTIAL, DISSIPATED = range(5)  # the ledger's places


@jit(inner=True)
def read_base(body: Array) -> BaseMotion:
    """Port `body`: position, quaternion, velocity, rate, acceleration with slope, angular acceleration with slope (25 numbers)."""
    return BaseMotion(
        vector(body, 0),
        quaternion(body, 3),
        vector(body, 7),
        vector(body, 10),
        vector(body, 13),
        vector(body, 16),
        vector(body, 19),
        vector(body, 22),
    )


@jit(inner=True)
def read_load(pad: Array, contact: Array, place: Vector) -> PadLoad:
    """Wrench on the pad: force, slope, socket, torque, slope, socket (18 numbers); contact: the ground's stiffness and damping, predicted
    velocity and its slope (24 numbers); place: the pad's at the start, m, L."""
    return PadLoad(
        add(vector(pad, 0), vector(pad, 6)),
        add(vector(pad, 9), vector(pad, 15)),
        vector(pad, 3),
        vector(pad, 12),
        matrix(contact, 0),
        matrix(contact, 9),
        vector(contact, 18),
        vector(contact, 21),
        place,
    )


@jit(inner=True)
def read_state(s: Array) -> LegState:
    """Hidden states: p, v, pad's quaternion and rate, five memories (18 numbers)."""
    return LegState(vector(s, 0), vector(s, 3), quaternion(s, 6), vector(s, 10), Crush(s[13], s[14], s[15], s[16], s[17]))


@jit(inner=True)
def write_state(s: Array, now: LegState, guess: Vector) -> None:
    """Hidden states back, and where Newton starts next time."""
    put_vector(s, 0, now.position)
    put_vector(s, 3, now.velocity)
    put_quaternion(s, 6, now.attitude)
    put_vector(s, 10, now.rate)
    s[13], s[14], s[15] = now.crush.primary, now.crush.right_tension, now.crush.right_compression
    s[16], s[17] = now.crush.left_tension, now.crush.left_compression
    put_vector(s, 18, guess)


@jit(inner=True)
def write_model(out: Array, m: InterfaceModel) -> None:
    """Port members `model_*` (43 numbers)."""
    put_vector(out, 0, m.acceleration)
    put_matrix(out, 3, m.mobility)
    put_matrix(out, 12, m.stiffness)
    put_matrix(out, 21, m.damping)
    put_vector(out, 30, m.base_velocity)
    put_vector(out, 33, m.base_acceleration)
    put_vector(out, 36, m.inertia)
    out[39] = m.joint_damping
    put_vector(out, 40, m.strut_rate)


@jit(inner=True)
def write_mount_model(leg: Leg, base: BaseState, now: LegState, loads: Loads, friction: float, contact: Array, out: Array) -> None:
    """Port members `mount.model_*` (66 numbers, as `impedance.read_mount` takes them); contact: the ground's tangents in L (18)."""
    at = shape(leg, now.position, now.velocity)
    m_e, m_n = axial_mass(leg), lateral_mass(leg, at)
    straight, turning = base_coupling(leg, at, now.position)
    stiffness, damping = tangents(leg, at, loads, friction, joint_damping(leg, at))
    body = rotation(base.attitude)
    back = transpose(body)
    put_vector(out, 0, now.position)
    put_matrix(out, 3, plus(identity(m_n), times(m_e - m_n, outer(at.axis, at.axis))))
    put_matrix(out, 12, straight)
    put_matrix(out, 21, turning)
    put_matrix(out, 30, stiffness)
    put_matrix(out, 39, damping)
    put_matrix(out, 48, product(back, product(matrix(contact, 0), body)))
    put_matrix(out, 57, product(back, product(matrix(contact, 9), body)))


@jit(inner=True)
def write_pad(leg: Leg, gravity: float, base: BaseState, now: LegState, force: Vector, ball: Vector, pad: Array, model: Array) -> None:
    """The pad's motion (13 numbers) and the interface model."""
    at = pad_state(base, now)
    put_vector(pad, 0, at.position)
    put_quaternion(pad, 3, at.attitude)
    put_vector(pad, 7, at.velocity)
    put_vector(pad, 10, at.rate)
    write_model(model, interface_model(leg, gravity, base, now, force, ball))


@jit(inner=True)
def write_struts(leg: Leg, now: LegState, primary: float, right: float, left: float, struts: Array) -> None:
    """Strokes, loads, peak strokes (9 numbers)."""
    put_vector(struts, 0, strokes(leg, now.position))
    put_vector(struts, 3, (primary, right, left))
    for i in range(3):
        struts[6 + i] = max(struts[6 + i], struts[i])


@jit(inner=True)
def write_energy(leg: Leg, gravity: float, base: BaseState, now: LegState, ledger: Array) -> None:
    """Kinetic and potential energy into the ledger."""
    ledger[KINETIC], ledger[POTENTIAL] = leg_energy(leg, gravity, base, now)


@jit(inner=True)
def write_mount(leg: Leg, last: Stage, impulse: Vector, angular_impulse: Vector, step: float, mount: Array) -> None:
    """Wrench on the body: end value, mean over the interval, slope from the last end to this one (18 numbers)."""
    at = shape(leg, last.position, last.velocity)
    force, torque = mount_wrench(leg, last.base, last.position, at, last.motion.nodes, last.force, last.ball)
    k = 1.0 / step
    put_vector(mount, 6, scale(k, sub(force, vector(mount, 0))))
    put_vector(mount, 15, scale(k, sub(torque, vector(mount, 9))))
    put_vector(mount, 0, force)
    put_vector(mount, 9, torque)
    put_vector(mount, 3, scale(k, impulse))
    put_vector(mount, 12, scale(k, angular_impulse))


@jit
def start_leg(
    leg: Leg,
    gravity: float,
    stroke_rate: float,
    body: Array,
    load: Array,
    contact: Array,
    mount: Array,
    impedance: Array,
    pad: Array,
    model: Array,
    struts: Array,
    ledger: Array,
    s: Array,
) -> None:
    """States and outputs at the start: undeformed, virgin, pad level with the body; only the primary may move, at stroke_rate (m/s)."""
    base = base_at(read_base(body), 0.0)
    now = start_state(leg, base.attitude, base.rate)
    axis = shape(leg, now.position, ZERO).axis
    now = LegState(now.position, scale(-stroke_rate, axis), now.attitude, now.rate, now.crush)
    write_state(s, now, ZERO)
    force = read_load(load, contact, ZERO).force
    frame = as_base(base, gravity)
    own = apply_transposed(rotation(base.attitude), force)
    at = shape(leg, now.position, now.velocity)
    motion = leg_motion(leg, frame, now.position, now.velocity, own, ZERO, now.crush)
    on_body = mount_wrench(leg, frame, now.position, at, motion.nodes, own, ZERO)
    for i in range(2):
        put_vector(mount, 9 * i, on_body[i])
        put_vector(mount, 9 * i + 3, on_body[i])
    write_mount_model(leg, base, now, motion.loads, motion.damping, contact, impedance)
    write_pad(leg, gravity, base, now, force, ZERO, pad, model)
    write_struts(leg, now, motion.primary, motion.right, motion.left, struts)
    write_energy(leg, gravity, base, now, ledger)


@jit
def advance_leg(
    leg: Leg,
    gravity: float,
    longest: float,
    step: float,
    body: Array,
    load: Array,
    contact: Array,
    mount: Array,
    impedance: Array,
    pad: Array,
    model: Array,
    struts: Array,
    ledger: Array,
    s: Array,
) -> int:
    """Take the leg over `step` seconds and fill its outputs: GAVE_UP where Newton did (nothing is written then), DONE, or BOTTOMED."""
    motion, before = read_base(body), read_state(s)
    wrench = read_load(load, contact, pad_state(base_at(motion, 0.0), before).position)
    now, course, last = step_leg(leg, gravity, motion, wrench, before, step, longest, vector(s, 18))
    if not last.ok:
        return GAVE_UP
    write_state(s, now, last.motion.acceleration)
    write_mount(leg, last, course.impulse, course.angular_impulse, step, mount)
    ledger[MOUNT_WORK] -= course.mount_work
    ledger[PAD_WORK] += course.pad_work
    ledger[DISSIPATED] += course.dissipated
    base = base_at(motion, step)
    write_mount_model(leg, base, now, last.motion.loads, last.motion.damping, contact, impedance)
    write_pad(leg, gravity, base, now, apply(rotation(base.attitude), last.force), last.ball, pad, model)
    write_struts(leg, now, last.motion.primary, last.motion.right, last.motion.left, struts)
    write_energy(leg, gravity, base, now, ledger)
    return BOTTOMED if bottomed(leg, struts[0], struts[1], struts[2]) else DONE
