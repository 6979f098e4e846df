"""Motion of the body frame within a communication interval, from its state at the start and its acceleration's course."""

from typing import NamedTuple

from .compiled import jit
from .leg_inertia import Base
from .vectors import Quaternion, Vector, add, apply_transposed, axpy, cross, from_rotation_vector, multiply, normalise, rotation, scale


class BaseMotion(NamedTuple):
    """Pose, twist and acceleration of B at the start of an interval; accelerations go on linearly."""

    position: Vector  # of B's origin, m, L
    attitude: Quaternion  # B to L
    velocity: Vector  # m/s, L
    rate: Vector  # rad/s, B
    acceleration: Vector  # m/s2, L
    acceleration_slope: Vector  # m/s3, L
    spin_up: Vector  # rad/s2, B
    spin_up_slope: Vector  # rad/s3, B


class BaseState(NamedTuple):
    """The same at one instant."""

    position: Vector
    attitude: Quaternion
    velocity: Vector
    rate: Vector
    acceleration: Vector
    spin_up: Vector


@jit
def base_at(motion: BaseMotion, t: float) -> BaseState:
    """The body frame t seconds into the interval. Attitude by the Magnus series to third order in t."""
    a, k = motion.acceleration, motion.acceleration_slope
    b, j = motion.spin_up, motion.spin_up_slope
    w = motion.rate
    position = axpy(t, motion.velocity, axpy(0.5 * t * t, a, axpy(t * t * t / 6.0, k, motion.position)))
    turn = axpy(t, w, axpy(0.5 * t * t, b, axpy(t * t * t / 6.0, j, scale(t * t * t / 12.0, cross(w, b)))))
    return BaseState(
        position,
        normalise(multiply(motion.attitude, from_rotation_vector(turn))),
        axpy(t, a, axpy(0.5 * t * t, k, motion.velocity)),
        axpy(t, b, axpy(0.5 * t * t, j, w)),
        axpy(t, k, a),
        axpy(t, j, b),
    )


@jit
def as_base(state: BaseState, gravity: float) -> Base:
    """What the leg feels: acceleration less gravity in B; gravity (m/s2) pulls along -x of L."""
    pull = apply_transposed(rotation(state.attitude), add(state.acceleration, (gravity, 0.0, 0.0)))
    return Base(pull, state.rate, state.spin_up)
