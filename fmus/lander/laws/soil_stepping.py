"""Integration of one footpad against its soil over a communication interval, with the leg as a reduced interface model.

The leg says how its pad will move (coupling.md, scheme B): a = a_f + Y F + A_x (x - x_n - V_b t - A_b t²/2) + A_v (v - v_n - A_b t),
and gives the
pad's inertia and joint damping. The soil integrates that pad against its own law: SDIRK2 with Newton and backtracking, because the law's
rate in the residual-sink band reaches 1e7 1/s. Without a model (all zero) the pad goes on at its last velocity. L throughout.

A mismatch of the last pass between leg and model is added to the model's velocity in proportion to time: the points then move as the
leg did.
"""

from math import ceil
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compiled import jit
from .footpad import Footpad, PadMotion, PadTangents, Wrench, deepest, pad_power, pad_wrench, remember
from .leg_stepping import GAMMA, NEWTON_LIMIT, SMALLEST_SHARE, VELOCITY_TOLERANCE
from .linear import put, solve_many
from .soil import Soil
from .surface import Surface
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
    sub,
    times,
    transpose,
)

Array = NDArray[np.float64]
GYRATION = 0.3  # m: weighs rotation against translation in norms


class InterfaceModel(NamedTuple):
    """How the pad answers, linearised at the start of the interval."""

    acceleration: Vector  # a_f, m/s2
    mobility: Matrix  # Y, 1/kg
    stiffness: Matrix  # A_x, 1/s2
    damping: Matrix  # A_v, 1/s
    base_velocity: Vector  # V_b, m/s
    base_acceleration: Vector  # A_b, m/s2
    inertia: Vector  # of the pad, pad axes, kg m2; zero: the pad does not answer torques
    joint_damping: float  # N m s/rad
    strut_rate: Vector  # rad/s


class PadStart(NamedTuple):
    """The pad at the start of the interval."""

    position: Vector
    attitude: Quaternion
    velocity: Vector
    rate: Vector


class Shift(NamedTuple):
    """Velocity mismatch at the end of the interval, m/s and rad/s, growing linearly from zero."""

    velocity: Vector
    rate: Vector


class SoilCourse(NamedTuple):
    """Integrals over the time stepped: of the wrench, of the wrench times time since the start, and of its power."""

    impulse: Vector
    angular_impulse: Vector
    moment_impulse: Vector  # N s2
    moment_angular_impulse: Vector
    work: float  # J, done on the pad
    displacement_moment: Vector  # of the pad's velocity times time, m s
    stiffness: Matrix  # time integrals of the ground's tangents
    damping: Matrix
    touch: float  # s since the start, of the first point entering the soil; -1: none


class Travel(NamedTuple):
    """Model state relative to the start: displacement, rotation vector, velocity, rate."""

    displacement: Vector
    turn: Vector
    velocity: Vector
    rate: Vector


@jit(inner=True)
def seen(start: PadStart, travel: Travel, shift: Shift, t: float, interval: float) -> PadMotion:
    """Motion of the pad as the soil meets it: model plus mismatch."""
    share = t / interval
    turn = axpy(0.5 * t * share, shift.rate, travel.turn)
    attitude = rotation(normalise(multiply(from_rotation_vector(turn), start.attitude)))
    return PadMotion(
        add(start.position, axpy(0.5 * t * share, shift.velocity, travel.displacement)),
        attitude,
        axpy(share, shift.velocity, travel.velocity),
        axpy(share, shift.rate, travel.rate),
    )


@jit(inner=True)
def inverse_inertia(model: InterfaceModel, attitude: Matrix) -> Matrix:
    """Inverse inertia of the pad in L; zero where the model gives none."""
    i = model.inertia
    if i[0] <= 0.0 or i[1] <= 0.0 or i[2] <= 0.0:
        return identity(0.0)
    inverse = (scale(1.0 / i[0], (1.0, 0.0, 0.0)), scale(1.0 / i[1], (0.0, 1.0, 0.0)), scale(1.0 / i[2], (0.0, 0.0, 1.0)))
    return product(attitude, product(inverse, transpose(attitude)))


@jit(inner=True)
def answers(
    model: InterfaceModel, start: PadStart, travel: Travel, at: PadMotion, wrench: Wrench, flexible: Matrix, t: float
) -> tuple[Vector, Vector]:
    """Accelerations of the model under the wrench, m/s2 and rad/s2."""
    away = sub(travel.displacement, axpy(t, model.base_velocity, scale(0.5 * t * t, model.base_acceleration)))
    faster = sub(sub(travel.velocity, start.velocity), scale(t, model.base_acceleration))
    strut = add(apply(model.stiffness, away), apply(model.damping, faster))
    a = add(model.acceleration, add(apply(model.mobility, wrench.force), strut))
    own = apply_transposed(at.attitude, travel.rate)
    i = model.inertia
    gyroscopic = apply(at.attitude, cross(own, (i[0] * own[0], i[1] * own[1], i[2] * own[2])))
    torque = sub(wrench.torque, axpy(model.joint_damping, sub(travel.rate, model.strut_rate), gyroscopic))
    return a, apply(flexible, torque)


@jit(inner=True)
def newton_matrix(model: InterfaceModel, t: PadTangents, flexible: Matrix, h: float, out: Array) -> None:
    """d(residual)/d(accelerations), (6, 6), into out: I + h (damping) + h² (stiffness), soil's and strut's."""
    out[:, :] = 0.0
    y, h2 = model.mobility, h * h
    strut = plus(times(h, model.damping), times(h2, model.stiffness))
    put(out, 0, 0, plus(identity(1.0), plus(product(y, plus(times(h, t.c_xx), times(h2, t.k_xx))), times(-1.0, strut))))
    put(out, 0, 3, product(y, plus(times(h, t.c_xr), times(h2, t.k_xr))))
    put(out, 3, 0, product(flexible, plus(times(h, t.c_rx), times(h2, t.k_rx))))
    turning = plus(identity(h * model.joint_damping), plus(times(h, t.c_rr), times(h2, t.k_rr)))
    put(out, 3, 3, plus(identity(1.0), product(flexible, turning)))


@jit(inner=True)
def soil_stage(
    soil: Soil,
    surface: Surface,
    pad: Footpad,
    model: InterfaceModel,
    start: PadStart,
    shift: Shift,
    memory: Array,
    before: Travel,
    t: float,
    h: float,
    interval: float,
    a: Vector,
    b: Vector,
    matrix: Array,
    step: Array,
) -> tuple[Travel, Vector, Vector, Wrench, PadMotion, bool, PadTangents]:
    """One stage at time t: (a, b) with v = v0 + h a(v, ...), Newton with backtracking. before: explicit part; h is γ times the substep."""
    best, share, ok = 1e300, 1.0, False
    da, db = ZERO, ZERO
    travel = before
    at = seen(start, travel, shift, t, interval)
    wrench, tangents = pad_wrench(soil, surface, pad, at, memory)
    for _ in range(NEWTON_LIMIT * 2):
        v, w = axpy(h, a, before.velocity), axpy(h, b, before.rate)
        travel = Travel(axpy(h, v, before.displacement), axpy(h, w, before.turn), v, w)
        at = seen(start, travel, shift, t, interval)
        wrench, tangents = pad_wrench(soil, surface, pad, at, memory)
        if ok:
            break
        flexible = inverse_inertia(model, at.attitude)
        a_law, b_law = answers(model, start, travel, at, wrench, flexible, t)
        r, q = sub(a_law, a), sub(b_law, b)
        size = dot(r, r) + GYRATION * GYRATION * dot(q, q)
        if size > best and share > 1e-4:
            share *= 0.5
            a, b = axpy(-share, da, a), axpy(-share, db, b)
            continue
        best, share = size, 1.0
        newton_matrix(model, tangents, flexible, h, matrix)
        for j in range(3):
            step[j, 0], step[3 + j, 0] = r[j], q[j]
        if not solve_many(matrix, step):
            break
        da, db = (step[0, 0], step[1, 0], step[2, 0]), (step[3, 0], step[4, 0], step[5, 0])
        a, b = add(a, da), add(b, db)
        ok = h * h * (dot(da, da) + GYRATION * GYRATION * dot(db, db)) < VELOCITY_TOLERANCE * VELOCITY_TOLERANCE
    return travel, a, b, wrench, at, ok, tangents


@jit(inner=True)
def add_stage(c: SoilCourse, wrench: Wrench, ground: PadTangents, at: PadMotion, t: float, h: float) -> SoilCourse:
    """The course with a stage of weight h (s) at time t added."""
    return SoilCourse(
        axpy(h, wrench.force, c.impulse),
        axpy(h, wrench.torque, c.angular_impulse),
        axpy(h * t, wrench.force, c.moment_impulse),
        axpy(h * t, wrench.torque, c.moment_angular_impulse),
        c.work + h * pad_power(wrench, at),
        axpy(h * t, at.velocity, c.displacement_moment),
        plus(c.stiffness, times(h, ground.k_xx)),
        plus(c.damping, times(h, ground.c_xx)),
        c.touch,
    )


@jit(inner=True)
def touched(c: SoilCourse, t: float) -> SoilCourse:
    """The course with the instant of contact."""
    return SoilCourse(
        c.impulse,
        c.angular_impulse,
        c.moment_impulse,
        c.moment_angular_impulse,
        c.work,
        c.displacement_moment,
        c.stiffness,
        c.damping,
        t,
    )


@jit
def step_soil(
    soil: Soil,
    surface: Surface,
    pad: Footpad,
    model: InterfaceModel,
    start: PadStart,
    shift: Shift,
    memory: Array,
    interval: float,
    longest: float,
) -> tuple[PadMotion, Quaternion, Wrench, SoilCourse, bool]:
    """Integrate over `interval` (s) in substeps of at most `longest` (s); memory is brought up to the end.

    Returns the predicted pad at the end, its attitude, the wrench there, the integrals, and whether Newton always converged.
    """
    matrix, step = np.zeros((6, 6)), np.zeros((6, 1))
    full = interval / ceil(interval / longest - 1e-9)
    t, h = 0.0, full
    now = Travel(ZERO, ZERO, start.velocity, start.rate)
    course = SoilCourse(ZERO, ZERO, ZERO, ZERO, 0.0, ZERO, identity(0.0), identity(0.0), -1.0)
    a, b = ZERO, ZERO
    at = seen(start, now, shift, 0.0, interval)
    wrench, _ = pad_wrench(soil, surface, pad, at, memory)
    while interval - t > 1e-9 * interval:
        h = min(h, interval - t)
        g = GAMMA * h
        one = soil_stage(soil, surface, pad, model, start, shift, memory, now, t + g, g, interval, a, b, matrix, step)
        rest = h - g
        between = Travel(
            axpy(rest, one[0].velocity, now.displacement),
            axpy(rest, one[0].rate, now.turn),
            axpy(rest, one[1], now.velocity),
            axpy(rest, one[2], now.rate),
        )
        two = soil_stage(soil, surface, pad, model, start, shift, memory, between, t + h, g, interval, one[1], one[2], matrix, step)
        if not (one[5] and two[5]):
            h *= 0.5
            a, b = ZERO, ZERO
            if h < SMALLEST_SHARE * full:
                return at, attitude_of(start, now, shift, t, interval), wrench, course, False
            continue
        course = add_stage(add_stage(course, one[3], one[6], one[4], t + g, rest), two[3], two[6], two[4], t + h, g)
        now, a, b, wrench, at = two[0], two[1], two[2], two[3], two[4]
        above = deepest(memory)
        remember(soil, surface, pad, at, memory)
        if course.touch < 0.0 and above <= 0.0 < deepest(memory):
            course = touched(course, t + h * above / (above - deepest(memory)))
        t += h
        h = min(full, 2.0 * h)
    return at, attitude_of(start, now, shift, interval, interval), wrench, course, True


@jit(inner=True)
def attitude_of(start: PadStart, travel: Travel, shift: Shift, t: float, interval: float) -> Quaternion:
    """Quaternion that belongs to `seen`."""
    turn = axpy(0.5 * t * t / interval, shift.rate, travel.turn)
    return normalise(multiply(from_rotation_vector(turn), start.attitude))
