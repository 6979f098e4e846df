"""The monolithic twin: body, legs and soils as one system, accelerations as unknowns, solved together.

It shares the laws with the units, not the coupling. Unknowns at a stage, all in L: pull = a - g of B's origin, the body's angular
acceleration, and for each leg R p'' and its pad's angular acceleration: 6 + 6 n. Newton eliminates each leg's six unknowns first, so a
stage costs in proportion to the number of legs.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .blocks import quaternion, vector
from .compiled import jit
from .footpad import Footpad, PadMotion, Wrench, pad_power, pad_wrench
from .leg import Crush, Leg, Shape, shape
from .leg_dynamics import Motion, leg_motion, tangents
from .leg_inertia import Base, accelerated, axial_mass, base_coupling, lateral_mass, times_diagonal
from .leg_joints import ball_torque
from .leg_reaction import mount_wrench
from .linear import put, solve_many
from .rigid_body import Body
from .soil import Soil
from .surface import Surface
from .vectors import (
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
    outer,
    plus,
    product,
    rotation,
    scale,
    skew,
    sub,
    times,
    transpose,
)

Array = NDArray[np.float64]
NEWTON_LIMIT = 40
VELOCITY_TOLERANCE = 1e-10  # m/s
GYRATION = 0.3  # m: weighs rotations against translations in norms
# columns of a leg's row in `Flight.legs`
P, V, Q, W, CRUSH, LEG_COLUMNS = 0, 3, 6, 10, 13, 18
# columns of the body's row
X, VX, QX, WX, BODY_COLUMNS = 0, 3, 6, 10, 13


class Vehicle(NamedTuple):
    """What is constant: the composite body, its legs, one surface, soil and pad for each leg."""

    body: Body
    legs: tuple[Leg, ...]
    soils: tuple[Soil, ...]
    surfaces: tuple[Surface, ...]
    pad: Footpad


class Flight(NamedTuple):
    """State: body row (x, v in L, quaternion, ω in B); leg rows (p, v in B, pad's quaternion, pad's ω in L, crush); soil memories."""

    body: Array  # (13,)
    legs: Array  # (n, 18)
    memory: Array  # (n, 5, 8)


class Engine(NamedTuple):
    """Wrench of the engine and other effects about B's origin, B, going on linearly from the start of the interval."""

    force: Vector
    torque: Vector
    force_slope: Vector
    torque_slope: Vector


class Work(NamedTuple):
    """Scratch of the solver, made once an interval."""

    left: Array  # (6, 6)
    right: Array  # (6, 7)
    legs: Array  # (n, 6, 7): eliminated legs
    body: Array  # (6, 6)
    rest: Array  # (6, 1)


@jit
def scratch(n: int) -> Work:
    """Room for n legs."""
    return Work(np.zeros((6, 6)), np.zeros((6, 7)), np.zeros((n, 6, 7)), np.zeros((6, 6)), np.zeros((6, 1)))


class LegAt(NamedTuple):
    """One leg at a trial of a stage."""

    at: Shape
    motion: Motion
    pad: PadMotion
    wrench: Wrench
    ball: Vector  # torque of the ball joint on the pad, B
    residual: Vector  # force on p missing, N, L
    twist: Vector  # torque on the pad missing, N m, L
    force: Vector  # on the body, N, B
    torque: Vector  # on the body about B's origin, N m, B


class BodyAt(NamedTuple):
    """The body at a trial of a stage."""

    position: Vector
    velocity: Vector  # L
    attitude: Quaternion
    rate: Vector  # B
    turned: Matrix  # B to L
    base: Base


@jit
def body_at(start: Quaternion, explicit: Array, turn: Vector, a: Array, gravity: float, h: float) -> BodyAt:
    """Body at a stage: explicit row plus h times the unknown accelerations. start: attitude at the step's start; turn: explicit part."""
    pull = vector(a, 0)
    v = axpy(h, add(pull, (-gravity, 0.0, 0.0)), vector(explicit, VX))
    x = axpy(h, v, vector(explicit, X))
    rate, q = vector(explicit, WX), start
    for _ in range(2):  # the angular acceleration is known in L, the rate in B: the second sweep turns it exactly enough (h^3)
        rate = axpy(h, apply_transposed(rotation(q), vector(a, 3)), vector(explicit, WX))
        q = normalise(multiply(start, from_rotation_vector(axpy(h, rate, turn))))
    r = rotation(q)
    return BodyAt(x, v, q, rate, r, Base(apply_transposed(r, pull), rate, apply_transposed(r, vector(a, 3))))


@jit
def leg_trial(
    leg: Leg,
    soil: Soil,
    surface: Surface,
    pad: Footpad,
    body: BodyAt,
    explicit: Array,
    start: Quaternion,
    turn: Vector,
    a: Array,
    crush: Crush,
    memory: Array,
    h: float,
) -> tuple[LegAt, Array]:
    """A leg with its soil at trial accelerations a (6): what is missing in its equations, and its Newton blocks (6, 6) as [M] first."""
    r = body.turned
    acceleration = apply_transposed(r, vector(a, 0))
    v = axpy(h, acceleration, vector(explicit, V))
    p = axpy(h, v, vector(explicit, P))
    w = axpy(h, vector(a, 3), vector(explicit, W))
    attitude = rotation(normalise(multiply(from_rotation_vector(axpy(h, w, turn)), start)))
    carried = add(cross(body.rate, p), v)
    motion = PadMotion(add(body.position, apply(r, p)), attitude, add(body.velocity, apply(r, carried)), w)
    wrench, soft = pad_wrench(soil, surface, pad, motion, memory)
    at = shape(leg, p, v)
    ball = ball_torque(leg, body.base, at, apply_transposed(r, w))
    own = apply_transposed(r, wrench.force)
    law = leg_motion(leg, body.base, p, v, own, ball, crush)
    missing = sub(law.acceleration, acceleration)
    m_e, m_n = axial_mass(leg), lateral_mass(leg, at)
    along = dot(at.axis, missing)
    residual = apply(r, add(scale(m_n, missing), scale((m_e - m_n) * along, at.axis)))
    own_rate = apply_transposed(attitude, w)
    spin = apply_transposed(attitude, vector(a, 3))
    inertial = add(times_diagonal(leg.pad_inertia, spin), cross(own_rate, times_diagonal(leg.pad_inertia, own_rate)))
    twist = sub(add(wrench.torque, apply(r, ball)), apply(attitude, inertial))
    nodes = accelerated(leg, at, law.nodes, scale(-1.0, missing))
    force, torque = mount_wrench(leg, body.base, p, at, nodes, own, ball)

    stiffness, damping = tangents(leg, at, law.loads, law.damping)
    struts = plus(times(h, damping), times(h * h, stiffness))
    mass = plus(identity(m_n), times(m_e - m_n, outer(at.axis, at.axis)))
    straight, spinning = base_coupling(leg, at, p)
    blocks = np.zeros((18, 6))
    turned = transpose(r)
    put(blocks, 0, 0, product(r, product(plus(mass, struts), turned)))
    put(blocks, 0, 3, product(r, product(straight, turned)))
    h2 = h * h
    put(blocks, 6, 0, plus(times(h, soft.c_xx), times(h2, soft.k_xx)))
    put(blocks, 6, 3, plus(times(h, soft.c_xr), times(h2, soft.k_xr)))
    put(blocks, 9, 0, plus(times(h, soft.c_rx), times(h2, soft.k_rx)))
    inertia = product(attitude, product(diagonal(leg.pad_inertia), transpose(attitude)))
    turning = plus(inertia, identity(h * leg.joint_damping))
    put(blocks, 9, 3, plus(turning, plus(times(h, soft.c_rr), times(h2, soft.k_rr))))
    put(blocks, 12, 0, skew(apply(r, p)))
    put(blocks, 12, 3, product(r, product(spinning, turned)))
    return LegAt(at, law, motion, wrench, ball, residual, twist, force, torque), blocks


@jit
def diagonal(d: Vector) -> Matrix:
    """diag(d)."""
    return ((d[0], 0.0, 0.0), (0.0, d[1], 0.0), (0.0, 0.0, d[2]))


@jit
def block(a: Array, i: int, j: int) -> Matrix:
    """3x3 block of a at (i, j)."""
    return (
        (a[i, j], a[i, j + 1], a[i, j + 2]),
        (a[i + 1, j], a[i + 1, j + 1], a[i + 1, j + 2]),
        (a[i + 2, j], a[i + 2, j + 1], a[i + 2, j + 2]),
    )


@jit
def eliminate(trial: LegAt, b: Array, work: Work, i: int) -> None:
    """Solve leg i for its unknowns in terms of the body's, and add what remains to the body's equations.

    A y + C β = r with A = [[M + S + K, K_xr], [K_rx, I + K_rr]], C = [[(M_c + K) J], [K_rx J]], J = [1, -[p x]]: K is the soil's, S
    the struts'.
    """
    k_xx, k_xr, k_rx, k_rr = block(b, 6, 0), block(b, 6, 3), block(b, 9, 0), block(b, 9, 3)
    mass, straight, arm, spinning = block(b, 0, 0), block(b, 0, 3), block(b, 12, 0), block(b, 12, 3)
    back = times(-1.0, arm)
    joint = plus(straight, k_xx)
    turn = plus(spinning, product(k_xx, back))
    work.left[:, :] = 0.0
    work.right[:, :] = 0.0
    put(work.left, 0, 0, plus(mass, k_xx))
    put(work.left, 0, 3, k_xr)
    put(work.left, 3, 0, k_rx)
    put(work.left, 3, 3, k_rr)
    put(work.right, 0, 0, joint)
    put(work.right, 0, 3, turn)
    put(work.right, 3, 0, k_rx)
    put(work.right, 3, 3, product(k_rx, back))
    for j in range(3):
        work.right[j, 6] = trial.residual[j]
        work.right[3 + j, 6] = trial.twist[j]
    solve_many(work.left, work.right)
    work.legs[i, :, :] = work.right
    # body: B β + Jᵀ [K J β + K y_x + K_xr y_r] + M_bᵀ y_x = r_b, with y = solved - (solved columns) β
    direct = k_xx
    put(work.body, 0, 0, direct)
    put(work.body, 0, 3, product(direct, back))
    put(work.body, 3, 0, product(arm, direct))
    put(work.body, 3, 3, product(arm, product(direct, back)))
    for column in range(7):
        y_x = (work.right[0, column], work.right[1, column], work.right[2, column])
        y_r = (work.right[3, column], work.right[4, column], work.right[5, column])
        soft = add(apply(k_xx, y_x), apply(k_xr, y_r))
        f = add(soft, apply_transposed(straight, y_x))
        m = add(apply(arm, soft), apply_transposed(spinning, y_x))
        for j in range(3):
            if column < 6:
                work.body[j, column] -= f[j]
                work.body[3 + j, column] -= m[j]
            else:
                work.rest[j, 0] -= f[j]
                work.rest[3 + j, 0] -= m[j]


@jit
def stage(
    vehicle: Vehicle,
    engine: Engine,
    t: float,
    h: float,
    start: Flight,
    explicit_body: Array,
    explicit_legs: Array,
    turns: Array,
    a: Array,
    step: Array,
    work: Work,
) -> tuple[bool, Array]:
    """Solve one stage for the accelerations a (n + 1, 6), row 0 the body's; they hold the guess on entry.

    turns  explicit rotation vectors since the step's start, (n + 1, 3): the body's in B, the pads' in L
    Returns whether Newton converged and a row (n + 1, 4) of powers: engine; per leg soil, struts, ball joint.
    """
    n = len(vehicle.legs)
    power = np.zeros((n + 1, 4))
    best, share, done = 1e300, 1.0, False
    gravity, mass = vehicle.body.gravity, vehicle.body.mass
    force = axpy(t, engine.force_slope, engine.force)
    torque = axpy(t, engine.torque_slope, engine.torque)
    for _ in range(NEWTON_LIMIT):
        body = body_at(quaternion(start.body, QX), explicit_body, vector(turns[0], 0), a[0], gravity, h)
        r = body.turned
        f, m = force, torque
        work.body[:, :] = 0.0
        work.rest[:, :] = 0.0
        size = 0.0
        for i in range(n):
            row = start.legs[i]
            crush = Crush(row[CRUSH], row[CRUSH + 1], row[CRUSH + 2], row[CRUSH + 3], row[CRUSH + 4])
            trial, blocks = leg_trial(
                vehicle.legs[i],
                vehicle.soils[i],
                vehicle.surfaces[i],
                vehicle.pad,
                body,
                explicit_legs[i],
                quaternion(row, Q),
                vector(turns[1 + i], 0),
                a[1 + i],
                crush,
                start.memory[i],
                h,
            )
            f, m = add(f, trial.force), add(m, trial.torque)
            unit = 1.0 / axial_mass(vehicle.legs[i])
            size += unit * unit * dot(trial.residual, trial.residual)
            spin = GYRATION / vehicle.legs[i].pad_inertia[0]
            size += spin * spin * dot(trial.twist, trial.twist)
            eliminate(trial, blocks, work, i)
            if done:
                relative = sub(apply_transposed(r, trial.pad.rate), add(body.rate, cross(trial.at.axis, trial.at.swing)))
                power[1 + i, 0] = pad_power(trial.wrench, trial.pad)
                power[1 + i, 1] = trial.motion.power
                power[1 + i, 2] = dot(trial.ball, relative)
        if done:
            power[0, 0] = dot(force, apply_transposed(r, body.velocity)) + dot(torque, body.rate)
            return True, power
        inertia = vehicle.body.inertia
        r_f = apply(r, axpy(-mass, body.base.pull, f))
        gyroscopic = cross(body.rate, apply(inertia, body.rate))
        r_m = apply(r, sub(sub(m, gyroscopic), apply(inertia, body.base.spin_up)))
        size += (dot(r_f, r_f) + dot(r_m, r_m)) / (mass * mass)
        if size > best and share > 1e-4:
            share *= 0.5
            for i in range(n + 1):
                for j in range(6):
                    a[i, j] -= share * step[i, j]
            continue
        best, share = size, 1.0
        put(work.body, 0, 0, identity(mass))
        put(work.body, 3, 3, product(r, product(inertia, transpose(r))))
        for j in range(3):
            work.rest[j, 0] += r_f[j]
            work.rest[3 + j, 0] += r_m[j]
        if not solve_many(work.body, work.rest):
            return False, power
        done = h * h * advance_unknowns(a, step, work, n) < VELOCITY_TOLERANCE * VELOCITY_TOLERANCE
    return False, power


@jit
def advance_unknowns(a: Array, step: Array, work: Work, n: int) -> float:
    """Back-substitute the legs, add the Newton step to a, and return its weighted square, (m/s2)²."""
    size = 0.0
    for j in range(6):
        step[0, j] = work.rest[j, 0]
    for i in range(n):
        for j in range(6):
            y = work.legs[i, j, 6]
            for k in range(6):
                y -= work.legs[i, j, k] * step[0, k]
            step[1 + i, j] = y
    for i in range(n + 1):
        for j in range(6):
            weight = 1.0 if j < 3 else GYRATION
            size += (weight * step[i, j]) ** 2
            a[i, j] += step[i, j]
    return size
