"""Six-degree-of-freedom rigid body under a wrench in its own axes: Newton-Euler, quaternion attitude, classical Runge-Kutta.

The wrench acts at the origin of B, which is the centre of mass; it turns with the body and goes on linearly within the interval.
"""

from math import ceil
from typing import NamedTuple

from .compiled import jit
from .vectors import Matrix, Quaternion, Vector, add, apply, apply_transposed, axpy, cross, dot, normalise, rotation, scale, solve, sub


class Body(NamedTuple):
    """Mass properties about the centre of mass, and gravity (m/s2, along -x of L)."""

    mass: float  # kg
    inertia: Matrix  # kg m2, B
    gravity: float


class BodyState(NamedTuple):
    """Position and velocity of the centre of mass in L, attitude B to L, angular velocity in B."""

    position: Vector  # m
    attitude: Quaternion
    velocity: Vector  # m/s
    rate: Vector  # rad/s


class BodyLoad(NamedTuple):
    """Wrench about B's origin in B at the start of the interval, and its slopes."""

    force: Vector  # N
    torque: Vector  # N m
    force_slope: Vector
    torque_slope: Vector


class BodyRate(NamedTuple):
    """Time derivative of a BodyState."""

    velocity: Vector
    attitude: Quaternion
    acceleration: Vector  # m/s2, L
    spin_up: Vector  # rad/s2, B


@jit
def inertia_matrix(diagonal: Vector, products: Vector) -> Matrix:
    """Inertia from Ixx, Iyy, Izz and the PRODUCTS of inertia ∫xy dm, ∫xz dm, ∫yz dm (they enter with a minus), kg m2."""
    xy, xz, yz = -products[0], -products[1], -products[2]
    return ((diagonal[0], xy, xz), (xy, diagonal[1], yz), (xz, yz, diagonal[2]))


@jit
def wrench_at(load: BodyLoad, t: float) -> tuple[Vector, Vector]:
    """Force and torque t seconds into the interval."""
    return axpy(t, load.force_slope, load.force), axpy(t, load.torque_slope, load.torque)


@jit
def body_rate(body: Body, state: BodyState, load: BodyLoad, t: float) -> BodyRate:
    """Newton-Euler: m a = R f - m g x̂, I ω' = τ - ω x I ω, q' = ½ q ω."""
    force, torque = wrench_at(load, t)
    a = axpy(1.0 / body.mass, apply(rotation(state.attitude), force), (-body.gravity, 0.0, 0.0))
    spin_up = solve(body.inertia, sub(torque, cross(state.rate, apply(body.inertia, state.rate))))
    w, x, y, z = state.attitude
    p, q, r = state.rate
    turn = (
        0.5 * (-x * p - y * q - z * r),
        0.5 * (w * p + y * r - z * q),
        0.5 * (w * q + z * p - x * r),
        0.5 * (w * r + x * q - y * p),
    )
    return BodyRate(state.velocity, turn, a, spin_up)


@jit
def moved(state: BodyState, rate: BodyRate, h: float) -> BodyState:
    """state + h rate, the quaternion made unit again."""
    q, dq = state.attitude, rate.attitude
    return BodyState(
        axpy(h, rate.velocity, state.position),
        normalise((q[0] + h * dq[0], q[1] + h * dq[1], q[2] + h * dq[2], q[3] + h * dq[3])),
        axpy(h, rate.acceleration, state.velocity),
        axpy(h, rate.spin_up, state.rate),
    )


@jit
def mean_rate(a: BodyRate, b: BodyRate, c: BodyRate, d: BodyRate) -> BodyRate:
    """(a + 2 b + 2 c + d)/6."""
    qa, qb, qc, qd = a.attitude, b.attitude, c.attitude, d.attitude
    k = 1.0 / 6.0
    return BodyRate(
        scale(k, add(axpy(2.0, b.velocity, a.velocity), axpy(2.0, c.velocity, d.velocity))),
        (
            k * (qa[0] + 2.0 * qb[0] + 2.0 * qc[0] + qd[0]),
            k * (qa[1] + 2.0 * qb[1] + 2.0 * qc[1] + qd[1]),
            k * (qa[2] + 2.0 * qb[2] + 2.0 * qc[2] + qd[2]),
            k * (qa[3] + 2.0 * qb[3] + 2.0 * qc[3] + qd[3]),
        ),
        scale(k, add(axpy(2.0, b.acceleration, a.acceleration), axpy(2.0, c.acceleration, d.acceleration))),
        scale(k, add(axpy(2.0, b.spin_up, a.spin_up), axpy(2.0, c.spin_up, d.spin_up))),
    )


@jit
def step_body(body: Body, state: BodyState, load: BodyLoad, interval: float, longest: float) -> BodyState:
    """State after `interval` (s), by Runge-Kutta steps of order 4 of at most `longest` (s)."""
    n = ceil(interval / longest - 1e-9)
    h = interval / n
    for i in range(n):
        t = i * h
        a = body_rate(body, state, load, t)
        b = body_rate(body, moved(state, a, 0.5 * h), load, t + 0.5 * h)
        c = body_rate(body, moved(state, b, 0.5 * h), load, t + 0.5 * h)
        d = body_rate(body, moved(state, c, h), load, t + h)
        state = moved(state, mean_rate(a, b, c, d), h)
    return state


@jit
def wrench_work(start: BodyState, end: BodyState, load: BodyLoad, interval: float) -> float:
    """Work of the wrench on the body over the interval, J, by Simpson's rule with the twist at the middle from both ends."""
    f0, m0 = wrench_at(load, 0.0)
    f1, m1 = wrench_at(load, 0.5 * interval)
    f2, m2 = wrench_at(load, interval)
    v0 = apply_transposed(rotation(start.attitude), start.velocity)
    v2 = apply_transposed(rotation(end.attitude), end.velocity)
    v1, w1 = scale(0.5, add(v0, v2)), scale(0.5, add(start.rate, end.rate))
    power0 = dot(f0, v0) + dot(m0, start.rate)
    power1 = dot(f1, v1) + dot(m1, w1)
    power2 = dot(f2, v2) + dot(m2, end.rate)
    return interval / 6.0 * (power0 + 4.0 * power1 + power2)


@jit
def body_energy(body: Body, state: BodyState) -> tuple[float, float]:
    """Kinetic energy and potential energy m g x (zero at L's origin), J."""
    kinetic = 0.5 * body.mass * dot(state.velocity, state.velocity) + 0.5 * dot(state.rate, apply(body.inertia, state.rate))
    return kinetic, body.mass * body.gravity * state.position[0]
