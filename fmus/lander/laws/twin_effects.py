"""What acts on the twin's body beside legs and port: the engine's tail-off inside it, plume, slosh, reaction control, a generic term.

Within a step every wrench but the slosh's goes linearly from its value at the start to that at the end as extrapolated: second order.
The slosh's follows the accelerations that the stage solves for. Steps end where thrust or pulse have a corner.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .base_motion import BaseMotion, BaseState, base_at
from .body_term import Term, basis_value, term_wrench
from .compiled import jit
from .plume import Plume, plume_force
from .reaction_control import Pulse, fires
from .slosh import Pendulum
from .tailoff import thrust
from .vectors import ZERO, Vector, add, apply_transposed, axpy, rotation, sub, yaw_pitch_roll

Array = NDArray[np.float64]
ALIKE = 1e-9  # s: instants nearer than this are one
NEVER = 1e300  # s


class Tail(NamedTuple):
    """The engine inside the twin: GuidanceControl's law."""

    corners: Array  # (k, 2): time since first contact, s, and thrust, N
    before: float  # thrust before first contact, N
    offset: tuple[float, float]  # Y and Z of the line of thrust, m
    swirl: float  # m: torque about X by thrust


class Effects(NamedTuple):
    """All of them; the twin does not look at them where `active` is false."""

    active: bool
    tail: Tail
    plume: Plume
    pendulum: Pendulum
    pulse: Pulse  # its start is an absolute time
    term: Term
    start: float  # of the run, s


class Outside(NamedTuple):
    """A wrench in B over a step: at its start, and its change until its end."""

    force: Vector
    torque: Vector
    force_change: Vector
    torque_change: Vector


@jit
def no_effects() -> Effects:
    """Nothing."""
    tail = Tail(np.zeros((1, 2)), 0.0, (0.0, 0.0), 0.0)
    return Effects(False, tail, Plume(0.0, 1.0, 0.0), Pendulum(0.0, 1.0, 0.0, ZERO), Pulse(ZERO, 0.0, 0.0), Term(0.0, 1, 1, 1.0), 0.0)


@jit
def guided(tail: Tail) -> bool:
    """Whether there is an engine inside."""
    return tail.before != 0.0 or bool(np.any(tail.corners[:, 1] != 0.0))


@jit
def first_touch(touch: Array) -> float:
    """Instant of the first contact of any pad; -1 before."""
    first = -1.0
    for k in range(touch.shape[0]):
        if touch[k] >= 0.0 and (first < 0.0 or touch[k] < first):
            first = touch[k]
    return first


@jit
def tail_thrust(tail: Tail, contact: float, now: float, h: float) -> tuple[float, float]:
    """Thrust (N) at the start and the end of a step over which it is linear; contact: -1 before the first."""
    if contact < 0.0:
        return tail.before, tail.before
    tau = max(now - contact, 0.0)
    near, far = thrust(tau + 0.25 * h, tail.corners), thrust(tau + 0.75 * h, tail.corners)  # inside: a corner is nobody's
    return 1.5 * near - 0.5 * far, 1.5 * far - 0.5 * near


@jit
def next_corner(effects: Effects, contact: float, now: float) -> float:
    """The first instant after now at which thrust or pulse have a corner; for ever off where there is none."""
    end = NEVER
    if contact >= 0.0 and guided(effects.tail):
        for k in range(effects.tail.corners.shape[0]):
            corner = contact + effects.tail.corners[k, 0]
            if corner > now + ALIKE:
                end = min(end, corner)
    if effects.pulse.torque != ZERO:  # a step that ends where nothing happens would move the landing by the integrator's error
        for edge in (effects.pulse.start, effects.pulse.start + effects.pulse.duration):
            if edge > now + ALIKE:
                end = min(end, edge)
    return end


@jit
def wrench_at_body(effects: Effects, state: BaseState, own: float, ported: float, t: float) -> tuple[Vector, Vector]:
    """Force and torque on the body in B. own: thrust inside, ported: through the port, N; t: since the start of the run, s."""
    y, z = effects.tail.offset
    force = (own + plume_force(effects.plume, own + ported, state.position[0]), 0.0, 0.0)
    torque = (effects.tail.swirl * own, z * own, -y * own)
    if effects.term.coefficient != 0.0:
        velocity = apply_transposed(rotation(state.attitude), state.velocity)
        value = basis_value(effects.term, t, velocity, state.rate, yaw_pitch_roll(state.attitude), own + ported)
        f, m = term_wrench(effects.term, value)
        force, torque = add(force, f), add(torque, m)
    return force, torque


@jit
def outside_wrench(effects: Effects, state: BaseState, contact: float, now: float, h: float, ported: tuple[float, float]) -> Outside:
    """Wrench over a step of h (s) from a state; ported: thrust through the port at its start and its end, N."""
    own = tail_thrust(effects.tail, contact, now, h)
    motion = BaseMotion(state.position, state.attitude, state.velocity, state.rate, state.acceleration, ZERO, state.spin_up, ZERO)
    first, first_torque = wrench_at_body(effects, state, own[0], ported[0], now - effects.start)
    last, last_torque = wrench_at_body(effects, base_at(motion, h), own[1], ported[1], now + h - effects.start)
    jets = effects.pulse.torque if fires(effects.pulse, now + 0.5 * h) else ZERO
    return Outside(first, add(first_torque, jets), sub(last, first), sub(last_torque, first_torque))


@jit
def no_wrench() -> Outside:
    """Nothing over a step."""
    return Outside(ZERO, ZERO, ZERO, ZERO)


@jit
def within(outside: Outside, share: float) -> tuple[Vector, Vector]:
    """Force and torque at a share of the step."""
    return axpy(share, outside.force_change, outside.force), axpy(share, outside.torque_change, outside.torque)


__all__ = ["Effects", "Outside", "Tail", "first_touch", "guided", "next_corner", "no_effects", "no_wrench", "outside_wrench", "within"]
