"""Adaptive integration of the twin: SDIRK2, local error from the course of the accelerations, rejection, memories set once a step."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .base_motion import BaseState, as_base
from .blocks import put_quaternion, put_vector, quaternion, vector
from .compiled import jit
from .footpad import PadMotion, deepest, remember, start_memory
from .leg import Crush, crushed
from .leg_stepping import GAMMA, start_state
from .rigid_body import BodyState
from .slosh import Pendulum, Sway, sway_acceleration, swayed
from .twin import (
    BODY_COLUMNS,
    CRUSH,
    LEG_COLUMNS,
    QX,
    VX,
    WX,
    Attached,
    Engine,
    Flight,
    Newton,
    P,
    Q,
    Stage,
    V,
    Vehicle,
    W,
    X,
    scratch,
    stage,
)
from .twin_effects import Effects, Outside, first_touch, guided, next_corner, no_effects, outside_wrench, within
from .twin_nominal import BESIDE, KEPT, LENIENT, SAME, Ahead, Nominal, ahead_at, guess_first, keep_step, nominal_room, stage_beside
from .vectors import ZERO, add, apply, apply_transposed, axpy, cross, from_rotation_vector, multiply, normalise, rotation

Array = NDArray[np.float64]
ERROR_CONSTANT = 0.0404  # of SDIRK2: 3 γ² - 2 γ³ - 1/6
SMALLEST = 1e-9  # s
MOST = (2000, 5e5)  # tries of an interval, and more a second: one that takes more would seem to hang
LOCATED = 1e-5  # s: how near after the first contact a step ends, for an engine inside to act on it
TIGHTEST = 1e-10  # m/s, of Newton
NEWTON_STEPS = 12  # before a step is refused
EXACT = Newton(TIGHTEST, 40)
ENGINE, EFFECTS = 0, 1  # columns of the ledger in row 0, the body's
SOIL, STRUTS, BALL = range(3)  # columns in the rows of the legs


class Settings(NamedTuple):
    """How finely to integrate."""

    tolerance: float  # local error of any pad's or the body's velocity per step, m/s
    longest: float  # s
    first: float  # step to try first, s


class Progress(NamedTuple):
    """What an interval took."""

    ok: bool
    next_step: float  # s
    steps: int
    rejected: int


@jit
def copied(f: Flight) -> Flight:
    """A state of its own."""
    return Flight(f.body.copy(), f.legs.copy(), f.memory.copy())


@jit(inner=True)
def explicit_part(vehicle: Vehicle, f: Flight, rest: float, one: Array, mid: Flight, turns: Array) -> Flight:
    """State plus `rest` (s) times the first stage's derivative; `turns` gets the rotation vectors. rest = 0: the state itself."""
    n = len(vehicle.legs)
    out = copied(f)
    turns[:, :] = 0.0
    if rest == 0.0:
        return out
    g = vehicle.body.gravity
    r = rotation(quaternion(mid.body, QX))
    spin_body = apply_transposed(r, vector(one[0], 3))
    for j in range(3):
        out.body[X + j] += rest * mid.body[VX + j]
        out.body[VX + j] += rest * (one[0, j] - (g if j == 0 else 0.0))
        out.body[WX + j] += rest * spin_body[j]
        turns[0, j] = rest * mid.body[WX + j]
    for i in range(n):
        a = apply_transposed(r, vector(one[1 + i], 0))
        for j in range(3):
            out.legs[i, P + j] += rest * mid.legs[i, V + j]
            out.legs[i, V + j] += rest * a[j]
            out.legs[i, W + j] += rest * one[1 + i, 3 + j]
            turns[1 + i, j] = rest * mid.legs[i, W + j]
    return out


@jit(inner=True)
def stage_state(vehicle: Vehicle, start: Flight, explicit: Flight, turns: Array, a: Array, h: float) -> Flight:
    """State at a solved stage, memories as at the start."""
    out = copied(start)
    n = len(vehicle.legs)
    g = vehicle.body.gravity
    q = quaternion(start.body, QX)
    rate = vector(explicit.body, WX)
    attitude = q
    for _ in range(2):  # as in `body_at`
        r = rotation(attitude)
        spin = apply_transposed(r, vector(a[0], 3))
        rate = axpy(h, spin, vector(explicit.body, WX))
        attitude = normalise(multiply(q, from_rotation_vector(axpy(h, rate, vector(turns[0], 0)))))
    v = axpy(h, add(vector(a[0], 0), (-g, 0.0, 0.0)), vector(explicit.body, VX))
    put_vector(out.body, VX, v)
    put_vector(out.body, X, axpy(h, v, vector(explicit.body, X)))
    put_quaternion(out.body, QX, attitude)
    put_vector(out.body, WX, rate)
    r = rotation(attitude)
    for i in range(n):
        own = apply_transposed(r, vector(a[1 + i], 0))
        v = axpy(h, own, vector(explicit.legs[i], V))
        put_vector(out.legs[i], V, v)
        put_vector(out.legs[i], P, axpy(h, v, vector(explicit.legs[i], P)))
        w = axpy(h, vector(a[1 + i], 3), vector(explicit.legs[i], W))
        put_vector(out.legs[i], W, w)
        turn = axpy(h, w, vector(turns[1 + i], 0))
        put_quaternion(out.legs[i], Q, normalise(multiply(from_rotation_vector(turn), quaternion(start.legs[i], Q))))
    return out


@jit
def pad_motion(f: Flight, i: int) -> PadMotion:
    """Pad i in L."""
    r = rotation(quaternion(f.body, QX))
    p, v = vector(f.legs[i], P), vector(f.legs[i], V)
    carried = add(cross(vector(f.body, WX), p), v)
    return PadMotion(
        add(vector(f.body, X), apply(r, p)),
        rotation(quaternion(f.legs[i], Q)),
        add(vector(f.body, VX), apply(r, carried)),
        vector(f.legs[i], W),
    )


@jit(inner=True)
def latch(vehicle: Vehicle, f: Flight, touch: Array, t: float, h: float) -> None:
    """Bring all memories up to the state at t + h; touch (n,) gets the instants of first contact (-1 before)."""
    for i in range(len(vehicle.legs)):
        row = f.legs[i]
        before = Crush(row[CRUSH], row[CRUSH + 1], row[CRUSH + 2], row[CRUSH + 3], row[CRUSH + 4])
        now = crushed(vehicle.legs[i], vector(row, P), before)
        row[CRUSH], row[CRUSH + 1], row[CRUSH + 2] = now.primary, now.right_tension, now.right_compression
        row[CRUSH + 3], row[CRUSH + 4] = now.left_tension, now.left_compression
        above = deepest(f.memory[i])
        remember(vehicle.soils[i], vehicle.surfaces[i], vehicle.pad, pad_motion(f, i), f.memory[i])
        depth = deepest(f.memory[i])
        if touch[i] < 0.0 and depth > 0.0:
            touch[i] = t + h * above / (above - depth) if above <= 0.0 else t


@jit(inner=True)
def local_error(before: Array, one: Array, two: Array, h: float) -> float:
    """Largest local error of a velocity over the step, m/s: C h³ a'' from three instants of the accelerations (n + 1, 6).

    Leg rows are relative to the body. Rotations of the pads are left to the contact forces they cause.
    """
    worst = 0.0
    c1 = GAMMA * h
    for i in range(before.shape[0]):
        square = 0.0
        for j in range(3):
            first = (one[i, j] - before[i, j]) / c1
            second = (two[i, j] - one[i, j]) / (h - c1)
            square += (2.0 * (second - first) / h) ** 2
        worst = max(worst, square)
    return float(ERROR_CONSTANT * h * h * h * worst**0.5)


@jit(inner=True)
def stage_of(explicit: Flight, turns: Array, engine: Engine, t: float, h: float, attached: Attached) -> Stage:
    """A stage at a time t after the start of the interval."""
    force, torque = axpy(t, engine.force_slope, engine.force), axpy(t, engine.torque_slope, engine.torque)
    return Stage(explicit.body, explicit.legs, turns, force, torque, h, attached)


@jit
def nothing_attached() -> Attached:
    """No effects."""
    return Attached(False, ZERO, ZERO, Pendulum(0.0, 1.0, 0.0, ZERO), Sway(ZERO, ZERO))


@jit(inner=True)
def attached_at(effects: Effects, outside: Outside, share: float, sway: Sway) -> Attached:
    """The effects at a share of a step."""
    force, torque = within(outside, share)
    return Attached(effects.active, force, torque, effects.pendulum, sway)


@jit
def state_of(f: Flight, a: Array, gravity: float) -> BaseState:
    """The body frame; a (6): pull and angular acceleration in L."""
    q = quaternion(f.body, QX)
    acceleration = add(vector(a, 0), (-gravity, 0.0, 0.0))
    spin_up = apply_transposed(rotation(q), vector(a, 3))
    return BaseState(vector(f.body, X), q, vector(f.body, VX), vector(f.body, WX), acceleration, spin_up)


@jit
def sway_of(bob: Array) -> Sway:
    """The pendulum's row: place and velocity across X, (4,)."""
    return Sway((0.0, bob[0], bob[1]), (0.0, bob[2], bob[3]))


@jit
def newton_of(tolerance: float) -> Newton:
    """Newton's share of a local error (m/s): three hundredths of 1e-2, and falling with its square to what rounding leaves."""
    return Newton(max(TIGHTEST, 3.0 * tolerance * tolerance), NEWTON_STEPS)


class Ride(NamedTuple):
    """What changes in place over an interval."""

    flight: Flight
    a: Array  # accelerations, (n + 1, 6): kept up to date, where Newton and the error estimate start
    ledger: Array  # (n + 1, 4) energies, J: row 0 port, effects; rows 1.. soil, struts, ball joint: integrals of the powers
    touch: Array  # (n,) instants of first contact, s; -1 before
    bob: Array  # (4,) of the slosh pendulum


@jit
def integrate(
    vehicle: Vehicle, engine: Engine, settings: Settings, f: Flight, a: Array, ledger: Array, touch: Array, time: float, interval: float
) -> Progress:
    """`fly` without effects on the body, on its own."""
    ride = Ride(f, a, ledger, touch, np.zeros(4))
    return fly(vehicle, no_effects(), engine, settings, ride, nominal_room(0, 0), time, interval)


@jit
def fly(
    vehicle: Vehicle, effects: Effects, engine: Engine, settings: Settings, ride: Ride, nominal: Nominal, time: float, interval: float
) -> Progress:
    """Take the ride over `interval` (s) from `time`, in place; not ok where Newton fails or the steps grow too many.

    nominal  gets the steps, or gives them, as its mode says
    """
    f, a, ledger, touch, bob = ride
    n = len(vehicle.legs)
    work, newton = scratch(n), newton_of(settings.tolerance)
    turns, delta = np.zeros((n + 1, 3)), np.zeros((n + 1, 6))
    t, h = 0.0, min(settings.first, settings.longest)
    steps, rejected = 0, 0
    along, ahead = True, Ahead(-1, False, 0.0)
    locating = effects.active and guided(effects.tail)
    early, late, sway = nothing_attached(), nothing_attached(), sway_of(bob)
    while interval - t > 1e-12:
        if steps + rejected > MOST[0] + MOST[1] * interval:
            return Progress(False, h, steps, rejected)
        left = interval - t
        contact = first_touch(touch)
        if effects.active:
            left = min(left, next_corner(effects, contact, time + t) - (time + t))
        if nominal.use[0] == BESIDE:
            ahead = ahead_at(nominal, time + t)
        if ahead.place >= 0:
            h = min(left, ahead.left) if along else min(h, min(left, ahead.left))
        else:
            h = left if h > 0.999 * left else (0.5 * left if h > 0.5 * left else h)
        same = ahead.place >= 0 and ahead.whole and abs(h - nominal.steps[ahead.place]) < SAME
        g = GAMMA * h
        if effects.active:
            now = state_of(f, a[0], vehicle.body.gravity)
            ported = engine.force[0] + t * engine.force_slope[0]
            outside = outside_wrench(effects, now, contact, time + t, h, (ported, ported + h * engine.force_slope[0]))
            swaying = sway_acceleration(effects.pendulum, as_base(now, vehicle.body.gravity), sway)
            early = attached_at(effects, outside, GAMMA, swayed(sway, swaying, g))
            late = attached_at(effects, outside, 1.0, swayed(sway, swaying, h))
        begin = explicit_part(vehicle, f, 0.0, a, f, turns)
        one, ok, power_1 = a.copy(), False, ledger
        first = stage_of(begin, turns, engine, t + g, g, early)
        if same:
            guess_first(nominal, ahead.place, a, one)
            ok, power_1 = stage_beside(vehicle, newton, f, first, one, nominal.inverse[ahead.place, 0], nominal.share)
            one = one if ok else a.copy()
        if not ok:
            ok, power_1 = stage(vehicle, newton, f, first, one, delta, work)
        middle = stage_state(vehicle, f, begin, turns, one, g)
        after = turns.copy()
        between = explicit_part(vehicle, f, h - g, one, middle, after)
        second = stage_of(between, after, engine, t + h, g, late)
        two, error, power_2 = one.copy(), 1e300, power_1
        if ok:
            ok = False
            if same:
                two += nominal.solved[ahead.place, 1] - nominal.solved[ahead.place, 0]
                ok, power_2 = stage_beside(vehicle, newton, f, second, two, nominal.inverse[ahead.place, 1], nominal.share)
                two = two if ok else one.copy()
            if not ok:
                ok, power_2 = stage(vehicle, newton, f, second, two, delta, work)
            error = local_error(a, one, two, h) if ok else 1e300
        if error > settings.tolerance * (LENIENT if same else 1.0) and h > SMALLEST:
            rejected += 1
            h *= max(0.2, 0.9 * (settings.tolerance / error) ** (1.0 / 3.0))
            along = False
            continue
        if not ok:
            return Progress(False, h, steps, rejected)
        end = stage_state(vehicle, f, between, after, two, g)
        seen = touch.copy()
        latch(vehicle, end, seen, time + t, h)
        if locating and contact < 0.0 and first_touch(seen) >= 0.0 and time + t + h - first_touch(seen) > LOCATED:
            rejected += 1
            h = first_touch(seen) - (time + t) + 0.5 * LOCATED
            along = False
            continue
        if nominal.use[0] == KEPT:
            keep_step(vehicle, nominal, time + t, h, f, (first, second), one, two)
        if effects.active and effects.pendulum.mass != 0.0:
            sway = carried_on(vehicle, effects.pendulum, sway, early, late, middle, end, one, two, h)
            bob[0], bob[1], bob[2], bob[3] = sway.place[1], sway.place[2], sway.velocity[1], sway.velocity[2]
        f.body[:], f.legs[:, :], f.memory[:, :, :] = end.body, end.legs, end.memory
        a[:, :], touch[:] = two, seen
        ledger += (h - g) * power_1 + g * power_2
        t += h
        steps += 1
        along = ahead.left - h < SAME
        grown = 0.9 * (settings.tolerance / max(error, 1e-300)) ** (1.0 / 3.0)
        h = min(settings.longest, h * min(2.0, max(0.2, grown)))
    return Progress(True, h, steps, rejected)


@jit(inner=True)
def carried_on(
    vehicle: Vehicle,
    pendulum: Pendulum,
    sway: Sway,
    early: Attached,
    late: Attached,
    middle: Flight,
    end: Flight,
    one: Array,
    two: Array,
    h: float,
) -> Sway:
    """The sway after a step, by the weights of its stages: momentum goes over to the body exactly."""
    gravity, g = vehicle.body.gravity, GAMMA * h
    first = sway_acceleration(pendulum, as_base(state_of(middle, one[0], gravity), gravity), early.sway)
    last = sway_acceleration(pendulum, as_base(state_of(end, two[0], gravity), gravity), late.sway)
    velocity = axpy(h - g, first, axpy(g, last, sway.velocity))
    return Sway(axpy(h - g, early.sway.velocity, axpy(g, late.sway.velocity, sway.place)), velocity)


@jit
def start_flight(vehicle: Vehicle, body: BodyState, f: Flight) -> None:
    """Undeformed legs, virgin struts and soils."""
    put_vector(f.body, X, body.position)
    put_vector(f.body, VX, body.velocity)
    put_quaternion(f.body, QX, body.attitude)
    put_vector(f.body, WX, body.rate)
    r = rotation(body.attitude)
    for i in range(len(vehicle.legs)):
        s = start_state(vehicle.legs[i], body.attitude, body.rate)
        put_vector(f.legs[i], P, s.position)
        put_vector(f.legs[i], V, s.velocity)
        put_quaternion(f.legs[i], Q, s.attitude)
        put_vector(f.legs[i], W, apply(r, s.rate))
        c = s.crush
        f.legs[i, CRUSH], f.legs[i, CRUSH + 1], f.legs[i, CRUSH + 2] = c.primary, c.right_tension, c.right_compression
        f.legs[i, CRUSH + 3], f.legs[i, CRUSH + 4] = c.left_tension, c.left_compression
        start_memory(vehicle.surfaces[i], vehicle.pad, pad_motion(f, i), f.memory[i])


@jit
def start_accelerations(vehicle: Vehicle, engine: Engine, f: Flight, a: Array) -> bool:
    """Accelerations at the start, (n + 1, 6), by stages of no length.

    One is not enough: a stage judges its Newton steps by the velocity they change, which over no time is none.
    """
    n = len(vehicle.legs)
    a[:, :] = 0.0
    step, turns, work = np.zeros((n + 1, 6)), np.zeros((n + 1, 3)), scratch(n)
    for _ in range(50):
        ok, _power = stage(vehicle, EXACT, f, stage_of(f, turns, engine, 0.0, 1e-12, nothing_attached()), a, step, work)
        if not ok or np.abs(step).max() < 1e-9:  # m/s2, rad/s2
            return ok
    return True


@jit
def push_at_start(effects: Effects, engine: Engine, f: Flight, time: float) -> Engine:
    """The port's wrench with that of the effects at the start of a run."""
    if not effects.active:
        return engine
    state = BaseState(vector(f.body, X), quaternion(f.body, QX), vector(f.body, VX), vector(f.body, WX), ZERO, ZERO)
    outside = outside_wrench(effects, state, -1.0, time, 1e-9, (engine.force[0], engine.force[0]))
    return Engine(add(engine.force, outside.force), add(engine.torque, outside.torque), engine.force_slope, engine.torque_slope)


def empty_flight(n: int) -> Flight:
    """Room for n legs."""
    return Flight(np.zeros(BODY_COLUMNS), np.zeros((n, LEG_COLUMNS)), np.zeros((n, 5, 8)))


__all__ = ["Ride", "Settings", "empty_flight", "fly", "integrate", "push_at_start", "start_accelerations", "start_flight"]
