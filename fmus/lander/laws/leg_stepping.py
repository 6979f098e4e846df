"""Integration of one leg over a communication interval: SDIRK2 (Alexander 1977, L-stable, order 2) with Newton and backtracking.

Implicit, because a virgin strut's damping (about 1e6 N s/m on 25 kg) has a rate of 4e4 1/s. The pad's rotation on its ball joint is
integrated
beside it: its coupling to the swing is weak, so one block sweep a Newton iteration solves both.
"""

from math import ceil, sqrt
from typing import NamedTuple

from .base_motion import BaseMotion, BaseState, as_base, base_at
from .compiled import jit
from .leg import Crush, Leg, crushed, shape
from .leg_dynamics import Motion, leg_motion, mobility, motion_of_shape, tangents
from .leg_inertia import Base, times_diagonal
from .leg_joints import ball_torque
from .leg_reaction import mount_wrench
from .vectors import (
    ZERO,
    Matrix,
    Quaternion,
    Vector,
    add,
    apply,
    apply_transposed,
    axpy,
    cross,
    dot,
    from_rotation_vector,
    identity,
    multiply,
    normalise,
    plus,
    product,
    rotation,
    scale,
    solve,
    sub,
    times,
    transpose,
)

GAMMA = 1.0 - sqrt(0.5)
NEWTON_LIMIT = 25
VELOCITY_TOLERANCE = 1e-11  # m/s: four orders below the residual sink rate of the soil
SMALLEST_SHARE = 1.0 / 4096.0  # of a substep, before the leg gives up


class LegState(NamedTuple):
    """p, v relative to B in B; the pad's attitude (pad to L) and angular velocity in pad axes; the cores' memories."""

    position: Vector  # m
    velocity: Vector  # m/s
    attitude: Quaternion
    rate: Vector  # rad/s
    crush: Crush


class PadLoad(NamedTuple):
    """Wrench on the pad at the start of the interval and its slopes, about the ball joint, L; and how it answers the pad's motion.

    The force holds for a pad that moves as the soil predicted; it changes by -C (v - v_pred) - K (x - x_pred).
    """

    force: Vector  # N
    torque: Vector  # N m
    force_slope: Vector
    torque_slope: Vector
    stiffness: Matrix = (ZERO, ZERO, ZERO)  # K, N/m
    damping: Matrix = (ZERO, ZERO, ZERO)  # C, N s/m
    predicted: Vector = ZERO  # v_pred at the start, m/s
    predicted_slope: Vector = ZERO  # m/s2
    place: Vector = ZERO  # x_pred, m: the pad's own place at the start


class Course(NamedTuple):
    """Integrals over the time stepped."""

    impulse: Vector  # of the wrench on the body, N s, B
    angular_impulse: Vector  # N m s, about B's origin, B
    mount_work: float  # done on the body, J
    pad_work: float  # done by the pad's wrench on the leg, J
    dissipated: float  # taken up inside the leg, J


class Stage(NamedTuple):
    """Solution of one implicit stage."""

    position: Vector
    velocity: Vector
    attitude: Quaternion
    rate: Vector
    spin_up: Vector
    motion: Motion
    ball: Vector
    base: Base
    force: Vector  # on the pad, B
    ok: bool


@jit(inner=True)
def pad_spin(leg: Leg, torque: Vector, rate: Vector, now: Vector, joint: Vector, h: float) -> Vector:
    """Angular acceleration of the pad, rad/s2, pad axes, implicit in its own joint damping over h.

    torque  of the soil on the pad, N m, pad axes;  rate  explicit part of its angular velocity, now  its last iterate
    joint   what the joint would leave it at
    """
    c = leg.joint_damping
    i = leg.pad_inertia
    push = add(sub(torque, cross(now, times_diagonal(i, now))), scale(c, sub(joint, rate)))
    return (push[0] / (i[0] + h * c), push[1] / (i[1] + h * c), push[2] / (i[2] + h * c))


@jit(inner=True)
def answer(load: PadLoad, here: BaseState, body: Matrix, rate: Vector, p: Vector, v: Vector) -> Vector:
    """Force on the pad at the instant of `load`, N, B, with the pad where it is."""
    away = sub(add(here.position, apply(body, p)), load.place)
    faster = sub(add(here.velocity, apply(body, add(cross(rate, p), v))), load.predicted)
    held = add(apply(load.damping, faster), apply(load.stiffness, away))
    return apply_transposed(body, sub(load.force, held))


@jit(inner=True)
def solve_stage(
    leg: Leg,
    base: Base,
    here: BaseState,
    body: Matrix,
    p0: Vector,
    v0: Vector,
    q0: Quaternion,
    turn0: Vector,
    w0: Vector,
    load: PadLoad,
    crush: Crush,
    h: float,
    guess: Vector,
) -> Stage:
    """One stage: v = v0 + h a, p = p0 + h v, with a from the leg's law at (p, v). h is γ times the substep.

    body   rotation B to L;  load  wrench at the stage's instant;  turn0  explicit part of the pad's rotation since q0
    """
    a, spin_up = guess, ZERO
    v = axpy(h, a, v0)
    p = axpy(h, v, p0)
    w, q, ball = w0, q0, ZERO
    force = answer(load, here, body, base.rate, p, v)
    ground_damping = product(transpose(body), product(load.damping, body))
    ground_stiffness = product(transpose(body), product(load.stiffness, body))
    motion = leg_motion(leg, base, p, v, force, ball, crush)
    size = 1e300
    step, share, ok = ZERO, 1.0, False
    for _ in range(NEWTON_LIMIT):
        at = shape(leg, p, v)
        pad = rotation(q)
        swing = apply_transposed(pad, apply(body, add(base.rate, cross(at.axis, at.swing))))
        spin_up = pad_spin(leg, apply_transposed(pad, load.torque), w0, w, swing, h)
        w = axpy(h, spin_up, w0)
        q = normalise(multiply(q0, from_rotation_vector(axpy(h, w, turn0))))
        ball = ball_torque(leg, base, at, apply_transposed(body, apply(rotation(q), w)))
        force = answer(load, here, body, base.rate, p, v)
        motion = motion_of_shape(leg, base, at, p, v, force, ball, crush)
        residual = sub(motion.acceleration, a)
        now = dot(residual, residual)
        if now > size and share > 0.01:  # no progress: go back half of the last step
            share *= 0.5
            a = axpy(-share, step, a)
        else:
            size, share = now, 1.0
            stiffness, damping = tangents(leg, at, motion.loads, motion.damping, motion.joints)
            slope = plus(times(h, plus(damping, ground_damping)), times(h * h, plus(stiffness, ground_stiffness)))
            implicit = product(mobility(leg, at), slope)
            step = solve(plus(identity(1.0), implicit), residual)
            a = add(a, step)
            if h * h * dot(step, step) * h * h < (h * VELOCITY_TOLERANCE) ** 2:
                ok = True
        v = axpy(h, a, v0)
        p = axpy(h, v, p0)
        if ok:
            break
    return Stage(p, v, q, w, spin_up, motion, ball, base, force, ok)


@jit(inner=True)
def stage_course(leg: Leg, stage: Stage, body: Matrix, velocity: Vector, load: PadLoad, h: float) -> Course:
    """Contribution of one stage, weighted by h (s). velocity is that of B's origin, in B."""
    at = shape(leg, stage.position, stage.velocity)
    force, torque = mount_wrench(leg, stage.base, stage.position, at, stage.motion.nodes, stage.force, stage.ball)
    pad_velocity = add(velocity, add(cross(stage.base.rate, stage.position), stage.velocity))
    pad_rate = apply(rotation(stage.attitude), stage.rate)
    relative = sub(apply_transposed(body, pad_rate), add(stage.base.rate, cross(at.axis, at.swing)))
    return Course(
        scale(h, force),
        scale(h, torque),
        h * (dot(force, velocity) + dot(torque, stage.base.rate)),
        h * (dot(stage.force, pad_velocity) + dot(load.torque, pad_rate)),
        -h * (stage.motion.power + dot(stage.ball, relative)),
    )


@jit(inner=True)
def join(a: Course, b: Course) -> Course:
    """Sum of two courses."""
    return Course(
        add(a.impulse, b.impulse),
        add(a.angular_impulse, b.angular_impulse),
        a.mount_work + b.mount_work,
        a.pad_work + b.pad_work,
        a.dissipated + b.dissipated,
    )


@jit(inner=True)
def load_at(load: PadLoad, t: float) -> PadLoad:
    """The pad's wrench t seconds into the interval."""
    return PadLoad(
        axpy(t, load.force_slope, load.force),
        axpy(t, load.torque_slope, load.torque),
        load.force_slope,
        load.torque_slope,
        load.stiffness,
        load.damping,
        axpy(t, load.predicted_slope, load.predicted),
        load.predicted_slope,
        axpy(t, load.predicted, axpy(0.5 * t * t, load.predicted_slope, load.place)),
    )


@jit(inner=True)
def substep(
    leg: Leg, gravity: float, motion: BaseMotion, load: PadLoad, state: LegState, t: float, h: float, guess: Vector
) -> tuple[LegState, Course, Stage]:
    """One SDIRK2 step from t to t + h."""
    g = GAMMA * h
    s1 = base_at(motion, t + g)
    r1 = rotation(s1.attitude)
    l1 = load_at(load, t + g)
    b1 = as_base(s1, gravity)
    one = solve_stage(leg, b1, s1, r1, state.position, state.velocity, state.attitude, ZERO, state.rate, l1, state.crush, g, guess)
    rest = h - g
    s2 = base_at(motion, t + h)
    r2 = rotation(s2.attitude)
    l2 = load_at(load, t + h)
    b2 = as_base(s2, gravity)
    p0, v0 = axpy(rest, one.velocity, state.position), axpy(rest, one.motion.acceleration, state.velocity)
    w0 = axpy(rest, one.spin_up, state.rate)
    two = solve_stage(leg, b2, s2, r2, p0, v0, state.attitude, scale(rest, one.rate), w0, l2, state.crush, g, one.motion.acceleration)
    course = join(
        stage_course(leg, one, r1, apply_transposed(r1, s1.velocity), l1, rest),
        stage_course(leg, two, r2, apply_transposed(r2, s2.velocity), l2, g),
    )
    crush = crushed(leg, two.position, state.crush)
    end = LegState(two.position, two.velocity, two.attitude, two.rate, crush)
    if not one.ok:  # one flag for the substep
        two = Stage(two.position, two.velocity, two.attitude, two.rate, two.spin_up, two.motion, two.ball, two.base, two.force, False)
    return end, course, two


@jit
def step_leg(
    leg: Leg, gravity: float, motion: BaseMotion, load: PadLoad, state: LegState, interval: float, longest: float, guess: Vector
) -> tuple[LegState, Course, Stage]:
    """Integrate over `interval` (s) in substeps of at most `longest` (s); halves a substep whose Newton iteration fails.

    guess   acceleration of p to start Newton from, m/s2. The last stage's `ok` tells whether the interval was completed.
    """
    full = interval / ceil(interval / longest - 1e-9)
    t, h = 0.0, full
    course = Course(ZERO, ZERO, 0.0, 0.0, 0.0)
    end, part, last = substep(leg, gravity, motion, load, state, t, h, guess)
    while True:
        if last.ok:
            state, course = end, join(course, part)
            guess = last.motion.acceleration
            t += h
            h = min(full, 2.0 * h)
        else:
            h *= 0.5
            if h < SMALLEST_SHARE * full:
                return state, course, last
        left = interval - t
        if left < 1e-9 * interval:
            return state, course, last
        end, part, last = substep(leg, gravity, motion, load, state, t, min(h, left), guess)
        h = min(h, left)


@jit
def start_state(leg: Leg, attitude: Quaternion, rate: Vector) -> LegState:
    """Undeformed leg at rest relative to the body: virgin cores start with d_MAX = s (physics.md). Pad level with the body.

    attitude  B to L;  rate  of the body, rad/s, B (the pad's axes start aligned with B's)
    """
    t, c, p = leg.tension.width, leg.compression.width, leg.primary.width
    return LegState(leg.geometry.pad, ZERO, attitude, rate, Crush(p, t, c, t, c))


__all__ = ["Course", "LegState", "PadLoad", "Stage", "start_state", "step_leg"]
