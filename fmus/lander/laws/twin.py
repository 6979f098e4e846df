"""The monolithic twin: body, legs and soils as one system, accelerations as unknowns, solved together.

It shares the laws with the units, not the coupling. Unknowns at a stage, all in L: pull = a - g of B's origin, the body's angular
acceleration, and for each leg R p'' and its pad's angular acceleration: 6 + 6 n. Newton eliminates each leg's six unknowns first, so a
stage costs in proportion to the number of legs.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .blocks import put_vector, quaternion, vector
from .compiled import jit
from .footpad import NO_TANGENTS, POINTS, Footpad, PadMotion, PadTangents, Wrench, lever, pad_power, pad_wrench, pad_wrench_alone
from .leg import Crush, Leg, Shape, shape
from .leg_dynamics import Motion, motion_of_shape, tangents
from .leg_inertia import Base, accelerated, axial_mass, base_coupling, lateral_mass, times_diagonal
from .leg_joints import ball_torque
from .leg_reaction import mount_wrench
from .linear import put, solve_many
from .rigid_body import Body
from .slosh import Pendulum, Sway, slosh_wrench
from .soil import PUBLISHED, Soil
from .surface import Surface, depth_at, normal_at
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
SEARCH = 5  # trials of shorter steps before Newton's is taken even where more is missing afterwards
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


class Newton(NamedTuple):
    """When to stop solving a stage."""

    tolerance: float  # last change of any velocity, m/s
    steps: int  # before the stage is given up


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
    soft: PadTangents
    wrench: Wrench
    ball: Vector  # torque of the ball joint on the pad, B
    position: Vector  # of the ball joint, B
    residual: Vector  # force on p missing, N, L
    twist: Vector  # torque on the pad missing, N m, L
    force: Vector  # on the body, N, B
    torque: Vector  # on the body about B's origin, N m, B


class Blocks(NamedTuple):
    """Newton's blocks of one leg, all in L: of its own unknowns, and of the body's through the ball joint."""

    mass: Matrix  # with the struts' stiffness and damping
    straight: Matrix  # the base's acceleration on p
    spinning: Matrix  # its angular acceleration on p
    arm: Matrix  # [p x]
    k_xx: Matrix  # the soil's
    k_xr: Matrix
    k_rx: Matrix
    k_rr: Matrix  # with the pad's inertia


class BodyAt(NamedTuple):
    """The body at a trial of a stage."""

    position: Vector
    velocity: Vector  # L
    attitude: Quaternion
    rate: Vector  # B
    turned: Matrix  # B to L
    base: Base


@jit(inner=True)
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


class Explicit(NamedTuple):
    """What a leg's stage starts from."""

    position: Vector  # p, m, B
    velocity: Vector
    turn: Vector  # rotation vector of the pad since the step's start, L
    rate: Vector  # of the pad, L


@jit
def of_row(rows: Array, i: int, j: int) -> Vector:
    """rows[i, j:j+3] without a view, which counts its references."""
    return (rows[i, j], rows[i, j + 1], rows[i, j + 2])


class LegMoved(NamedTuple):
    """One leg's motion at trial accelerations."""

    pull: Vector  # R p'', m/s2, L
    spin_up: Vector  # of the pad, rad/s2, L
    acceleration: Vector  # p'', B
    position: Vector  # p, m, B
    velocity: Vector
    pad: PadMotion


@jit(inline=True, inner=True)
def leg_moved(body: BodyAt, explicit: Explicit, start: Quaternion, pull: Vector, spin_up: Vector, h: float) -> LegMoved:
    """Ball joint and pad at the end of a stage of h (s); start: the pad's attitude at the step's start."""
    r = body.turned
    acceleration = apply_transposed(r, pull)
    v = axpy(h, acceleration, explicit.velocity)
    p = axpy(h, v, explicit.position)
    w = axpy(h, spin_up, explicit.rate)
    attitude = rotation(normalise(multiply(from_rotation_vector(axpy(h, w, explicit.turn)), start)))
    carried = add(cross(body.rate, p), v)
    motion = PadMotion(add(body.position, apply(r, p)), attitude, add(body.velocity, apply(r, carried)), w)
    return LegMoved(pull, spin_up, acceleration, p, v, motion)


@jit(inline=True, inner=True)
def leg_answer(leg: Leg, body: BodyAt, moved: LegMoved, crush: Crush, wrench: Wrench, soft: PadTangents) -> LegAt:
    """A leg under its soil's wrench: what is missing in its equations. soft: the soil's tangents, kept beside."""
    r, p, v = body.turned, moved.position, moved.velocity
    attitude, w = moved.pad.attitude, moved.pad.rate
    at = shape(leg, p, v)
    ball = ball_torque(leg, body.base, at, apply_transposed(r, w))
    own = apply_transposed(r, wrench.force)
    law = motion_of_shape(leg, body.base, at, p, v, own, ball, crush)
    missing = sub(law.acceleration, moved.acceleration)
    m_e, m_n = axial_mass(leg), lateral_mass(leg, at)
    along = dot(at.axis, missing)
    residual = apply(r, add(scale(m_n, missing), scale((m_e - m_n) * along, at.axis)))
    own_rate = apply_transposed(attitude, w)
    spin = apply_transposed(attitude, moved.spin_up)
    inertial = add(times_diagonal(leg.pad_inertia, spin), cross(own_rate, times_diagonal(leg.pad_inertia, own_rate)))
    twist = sub(add(wrench.torque, apply(r, ball)), apply(attitude, inertial))
    nodes = accelerated(leg, at, law.nodes, scale(-1.0, missing))
    force, torque = mount_wrench(leg, body.base, p, at, nodes, own, ball)
    return LegAt(at, law, moved.pad, soft, wrench, ball, p, residual, twist, force, torque)


@jit(inline=True, inner=True)
def leg_blocks(leg: Leg, body: BodyAt, trial: LegAt, h: float) -> Blocks:
    """Newton's blocks at a trial: how what is missing answers the accelerations."""
    r, at, soft, attitude = body.turned, trial.at, trial.soft, trial.pad.attitude
    m_e, m_n = axial_mass(leg), lateral_mass(leg, at)
    stiffness, damping = tangents(leg, at, trial.motion.loads, trial.motion.damping, trial.motion.joints)
    struts = plus(times(h, damping), times(h * h, stiffness))
    mass = plus(identity(m_n), times(m_e - m_n, outer(at.axis, at.axis)))
    straight, spinning = base_coupling(leg, at, trial.position)
    turned = transpose(r)
    h2 = h * h
    inertia = product(attitude, product(diagonal(leg.pad_inertia), transpose(attitude)))
    turning = plus(inertia, identity(h * leg.joint_damping))
    return Blocks(
        product(r, product(plus(mass, struts), turned)),
        product(r, product(straight, turned)),
        product(r, product(spinning, turned)),
        skew(apply(r, trial.position)),
        plus(times(h, soft.c_xx), times(h2, soft.k_xx)),
        plus(times(h, soft.c_xr), times(h2, soft.k_xr)),
        plus(times(h, soft.c_rx), times(h2, soft.k_rx)),
        plus(turning, plus(times(h, soft.c_rr), times(h2, soft.k_rr))),
    )


@jit
def diagonal(d: Vector) -> Matrix:
    """diag(d)."""
    return ((d[0], 0.0, 0.0), (0.0, d[1], 0.0), (0.0, 0.0, d[2]))


@jit(inline=True, inner=True)
def eliminate(trial: LegAt, b: Blocks, work: Work, i: int) -> None:
    """Solve leg i for its unknowns in terms of the body's, and add what remains to the body's equations.

    A y + C β = r with A = [[M + S + K, K_xr], [K_rx, I + K_rr]], C = [[(M_c + K) J], [K_rx J]], J = [1, -[p x]]: K is the soil's, S
    the struts'.
    """
    back = times(-1.0, b.arm)
    work.left[:, :] = 0.0
    work.right[:, :] = 0.0
    put(work.left, 0, 0, plus(b.mass, b.k_xx))
    put(work.left, 0, 3, b.k_xr)
    put(work.left, 3, 0, b.k_rx)
    put(work.left, 3, 3, b.k_rr)
    put(work.right, 0, 0, plus(b.straight, b.k_xx))
    put(work.right, 0, 3, plus(b.spinning, product(b.k_xx, back)))
    put(work.right, 3, 0, b.k_rx)
    put(work.right, 3, 3, product(b.k_rx, back))
    for j in range(3):
        work.right[j, 6] = trial.residual[j]
        work.right[3 + j, 6] = trial.twist[j]
    solve_many(work.left, work.right)
    work.legs[i, :, :] = work.right
    # body: B β + Jᵀ [K J β + K y_x + K_xr y_r] + M_bᵀ y_x = r_b, with y = solved - (solved columns) β
    put(work.body, 0, 0, b.k_xx)
    put(work.body, 0, 3, product(b.k_xx, back))
    put(work.body, 3, 0, product(b.arm, b.k_xx))
    put(work.body, 3, 3, product(b.arm, product(b.k_xx, back)))
    for column in range(7):
        y_x = (work.right[0, column], work.right[1, column], work.right[2, column])
        y_r = (work.right[3, column], work.right[4, column], work.right[5, column])
        soft = add(apply(b.k_xx, y_x), apply(b.k_xr, y_r))
        f = add(soft, apply_transposed(b.straight, y_x))
        m = add(apply(b.arm, soft), apply_transposed(b.spinning, y_x))
        for j in range(3):
            if column < 6:
                work.body[j, column] -= f[j]
                work.body[3 + j, column] -= m[j]
            else:
                work.rest[j, 0] -= f[j]
                work.rest[3 + j, 0] -= m[j]


class Trial(NamedTuple):
    """Everything at trial accelerations."""

    body: BodyAt
    legs: Any  # a list of LegAt
    force: Vector  # missing in the body's equations, N, L
    torque: Vector  # N m, L
    size: float  # of all that is missing, (m/s2)²


class Attached(NamedTuple):
    """Effects on the body at a stage; not looked at where `active` is false."""

    active: bool
    force: Vector  # N, B
    torque: Vector  # N m, about B's origin, B
    pendulum: Pendulum
    sway: Sway


class Stage(NamedTuple):
    """What is given about a stage."""

    body: Array  # explicit row
    legs: Array  # explicit rows
    turns: Array  # explicit rotation vectors since the step's start, (n + 1, 3): the body's in B, the pads' in L
    force: Vector  # through the port on the body, N, B
    torque: Vector  # N m, B
    h: float  # s: velocity = explicit + h acceleration
    attached: Attached


@jit(inline=True, inner=True)
def crush_of(start: Flight, i: int) -> Crush:
    """Leg i's memory."""
    r = start.legs
    return Crush(r[i, CRUSH], r[i, CRUSH + 1], r[i, CRUSH + 2], r[i, CRUSH + 3], r[i, CRUSH + 4])


@jit(inline=True, inner=True)
def moved_at(start: Flight, body: BodyAt, given: Stage, a: Array, i: int) -> LegMoved:
    """Leg i's motion at trial accelerations a (n + 1, 6)."""
    r, k, explicit = start.legs, 1 + i, given.legs
    attitude = (r[i, Q], r[i, Q + 1], r[i, Q + 2], r[i, Q + 3])
    known = Explicit(of_row(explicit, i, P), of_row(explicit, i, V), of_row(given.turns, k, 0), of_row(explicit, i, W))
    return leg_moved(body, known, attitude, of_row(a, k, 0), of_row(a, k, 3), given.h)


@jit(inline=True, inner=True)
def leg_at(vehicle: Vehicle, start: Flight, body: BodyAt, given: Stage, a: Array, i: int) -> LegAt:
    """Leg i at trial accelerations a (n + 1, 6)."""
    moved = moved_at(start, body, given, a, i)
    wrench, soft = pad_wrench(vehicle.soils[i], vehicle.surfaces[i], vehicle.pad, moved.pad, start.memory[i])
    return leg_answer(vehicle.legs[i], body, moved, crush_of(start, i), wrench, soft)


@jit
def attached_wrench(attached: Attached, base: Base) -> tuple[Vector, Vector]:
    """Force (N) and torque (N m, about B's origin) of the effects, B."""
    if attached.pendulum.mass == 0.0:
        return attached.force, attached.torque
    force, torque = slosh_wrench(attached.pendulum, base, attached.sway)
    return add(attached.force, force), add(attached.torque, torque)


@jit(inner=True)
def trial_at(vehicle: Vehicle, start: Flight, given: Stage, a: Array) -> Trial:
    """What is missing at trial accelerations a (n + 1, 6)."""
    n, mass = len(vehicle.legs), vehicle.body.mass
    body = body_at(quaternion(start.body, QX), given.body, vector(given.turns[0], 0), a[0], vehicle.body.gravity, given.h)
    legs = [leg_at(vehicle, start, body, given, a, i) for i in range(n)]
    size, f, m = 0.0, given.force, given.torque
    if given.attached.active:
        force, torque = attached_wrench(given.attached, body.base)
        f, m = add(f, force), add(m, torque)
    for i in range(n):
        trial = legs[i]
        f, m = add(f, trial.force), add(m, trial.torque)
        unit = 1.0 / axial_mass(vehicle.legs[i])
        size += unit * unit * dot(trial.residual, trial.residual)
        spin = GYRATION / vehicle.legs[i].pad_inertia[0]
        size += spin * spin * dot(trial.twist, trial.twist)
    r_f, r_m = body_missing(vehicle.body, body, f, m)
    return Trial(body, legs, r_f, r_m, size + (dot(r_f, r_f) + dot(r_m, r_m)) / (mass * mass))


@jit(inner=True)
def body_missing(own: Body, at: BodyAt, force: Vector, torque: Vector) -> tuple[Vector, Vector]:
    """What is missing in the body's equations under force and torque about B's origin, in B: N and N m, L."""
    f = axpy(-own.mass, at.base.pull, force)
    m = sub(sub(torque, cross(at.rate, apply(own.inertia, at.rate))), apply(own.inertia, at.base.spin_up))
    return apply(at.turned, f), apply(at.turned, m)


@jit(inner=True)
def missing_at(vehicle: Vehicle, start: Flight, given: Stage, a: Array, missing: Array, power: Array) -> None:
    """`trial_at` and `powers` without what Newton's matrix alone needs.

    missing  (6 n + 6,) gets the body's force and torque, then each leg's;  power  (n + 1, 4) the powers
    """
    body = body_at(quaternion(start.body, QX), given.body, vector(given.turns[0], 0), a[0], vehicle.body.gravity, given.h)
    f, m = given.force, given.torque
    if given.attached.active:
        force, torque = attached_wrench(given.attached, body.base)
        f, m = add(f, force), add(m, torque)
    body_powers(body, given, power)
    for i in range(len(vehicle.legs)):
        moved = moved_at(start, body, given, a, i)
        wrench = pad_wrench_alone(vehicle.soils[i], vehicle.surfaces[i], vehicle.pad, moved.pad, start.memory[i])
        leg = leg_answer(vehicle.legs[i], body, moved, crush_of(start, i), wrench, NO_TANGENTS)
        f, m = add(f, leg.force), add(m, leg.torque)
        put_vector(missing, 6 * i + 6, leg.residual)
        put_vector(missing, 6 * i + 9, leg.twist)
        leg_powers(body, leg, power[1 + i])
    r_f, r_m = body_missing(vehicle.body, body, f, m)
    put_vector(missing, 0, r_f)
    put_vector(missing, 3, r_m)


@jit(inner=True)
def standstill_share(vehicle: Vehicle, before: Trial, now: Trial) -> float:
    """The smallest share of a step at which a point in the soil stops sinking, where the published law's force jumps; 1: none does."""
    share = 1.0
    for i in range(len(vehicle.legs)):
        soil, was, new = vehicle.soils[i], before.legs[i].pad, now.legs[i].pad
        if soil.law != PUBLISHED:
            continue
        for j in range(POINTS):
            arm = lever(vehicle.pad, new.attitude, j)
            place = add(new.position, arm)
            if depth_at(vehicle.surfaces[i], place) > 0.0:
                normal = normal_at(vehicle.surfaces[i], place)
                above = -dot(normal, add(was.velocity, cross(was.rate, arm))) - 0.5 * soil.residual
                below = -dot(normal, add(new.velocity, cross(new.rate, arm))) - 0.5 * soil.residual
                if above * below < 0.0:
                    share = min(share, above / (above - below))
    return share


@jit(inner=True)
def searched(vehicle: Vehicle, start: Flight, given: Stage, before: Trial, a: Array, step: Array) -> Trial:
    """The trial after Newton's step, or after a part of it where more is missing than before; a goes back with it."""
    now = trial_at(vehicle, start, given, a)
    share, half = 1.0, 1.0
    for k in range(SEARCH):
        if now.size <= before.size:
            break
        new = standstill_share(vehicle, before, now) if k == 0 else 1.0
        if new == 1.0:
            half *= 0.5
            new = half
        for i in range(a.shape[0]):
            for j in range(6):
                a[i, j] += (new - share) * step[i, j]
        share = new
        now = trial_at(vehicle, start, given, a)
    return now


@jit(inner=True)
def newton_step(vehicle: Vehicle, at: Trial, h: float, a: Array, step: Array, work: Work) -> float:
    """Add Newton's step to a; gives its weighted square, (m/s2)², negative where there is none."""
    r = at.body.turned
    work.body[:, :] = 0.0
    work.rest[:, :] = 0.0
    for i in range(len(vehicle.legs)):
        eliminate(at.legs[i], leg_blocks(vehicle.legs[i], at.body, at.legs[i], h), work, i)
    put(work.body, 0, 0, identity(vehicle.body.mass))
    put(work.body, 3, 3, product(r, product(vehicle.body.inertia, transpose(r))))
    for j in range(3):
        work.rest[j, 0] += at.force[j]
        work.rest[3 + j, 0] += at.torque[j]
    if not solve_many(work.body, work.rest):
        return -1.0
    return advance_unknowns(a, step, work, len(vehicle.legs))


@jit(inner=True)
def body_powers(body: BodyAt, given: Stage, power: Array) -> None:
    """power (n + 1, 4): row 0 gets that through the port and that of the effects on the body, W."""
    own = apply_transposed(body.turned, body.velocity)
    power[0, 0] = dot(given.force, own) + dot(given.torque, body.rate)
    if given.attached.active:
        force, torque = attached_wrench(given.attached, body.base)
        power[0, 1] = dot(force, own) + dot(torque, body.rate)


@jit(inner=True)
def leg_powers(body: BodyAt, leg: LegAt, power: Array) -> None:
    """power (4,) gets those of soil, struts and ball joint of a leg, W."""
    relative = sub(apply_transposed(body.turned, leg.pad.rate), add(body.rate, cross(leg.at.axis, leg.at.swing)))
    power[0] = pad_power(leg.wrench, leg.pad)
    power[1] = leg.motion.power
    power[2] = dot(leg.ball, relative)


@jit(inner=True)
def powers(body: BodyAt, legs: Any, given: Stage) -> Array:
    """(n + 1, 4): `body_powers`, then `leg_powers` of each leg."""
    power = np.zeros((1 + len(legs), 4))
    body_powers(body, given, power)
    for i in range(len(legs)):
        leg_powers(body, legs[i], power[1 + i])
    return power


@jit(inner=True)
def stage(vehicle: Vehicle, newton: Newton, start: Flight, given: Stage, a: Array, step: Array, work: Work) -> tuple[bool, Array]:
    """Solve one stage for the accelerations a (n + 1, 6), row 0 the body's; they hold the guess on entry.

    Returns whether Newton converged and the powers, before its last, negligible step.
    """
    now = trial_at(vehicle, start, given, a)
    for _ in range(newton.steps):
        size = newton_step(vehicle, now, given.h, a, step, work)
        if size < 0.0:
            break
        if given.h * given.h * size < newton.tolerance * newton.tolerance:
            return True, powers(now.body, now.legs, given)
        now = searched(vehicle, start, given, now, a, step)
    return False, np.zeros((a.shape[0], 4))


@jit(inner=True)
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
