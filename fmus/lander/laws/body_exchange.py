"""The body between its arrays: the blocks of a unit's memory in, one interval, the blocks out."""

import numpy as np
from numpy.typing import NDArray

from .blocks import put_quaternion, put_vector, quaternion, vector
from .compiled import jit
from .impedance import corrections
from .rigid_body import Body, BodyLoad, BodyState, body_energy, body_rate, step_body, wrench_work
from .vectors import Vector, add, apply_transposed, rotation, scale, sub, yaw_pitch_roll

Array = NDArray[np.float64]
RATES, ENERGY = 3, 12  # places behind the attitude's angles: value, mean, slope of each rate; energies
WRENCH = 18  # numbers of a port: force, slope, socket, torque, slope, socket
VALID = 6  # place of `reference_valid` behind the reference's velocity and rate


@jit(inner=True)
def read_wrench(row: Array) -> BodyLoad:
    """One port's wrench, its socket included."""
    return BodyLoad(add(vector(row, 0), vector(row, 6)), add(vector(row, 9), vector(row, 15)), vector(row, 3), vector(row, 12))


@jit(inner=True)
def with_change(load: BodyLoad, change: Array) -> BodyLoad:
    """The wrench with a constant (6) added."""
    return BodyLoad(add(load.force, vector(change, 0)), add(load.torque, vector(change, 3)), load.force_slope, load.torque_slope)


@jit(inner=True)
def total_load(wrenches: Array, changes: Array) -> BodyLoad:
    """Sum over the ports (n, WRENCH), with each port's change (n, 6)."""
    row, change = np.zeros(WRENCH), np.zeros(6)
    for k in range(wrenches.shape[0]):
        row += wrenches[k]
        change += changes[k]
    return with_change(read_wrench(row), change)


@jit(inner=True)
def changes_of(body: Body, before: BodyState, wrenches: Array, models: Array, reference: Array, step: float, longest: float) -> Array:
    """Change of each port's wrench (n, 6) because the body moves otherwise than in the pass before; zero without such a pass.

    models     (m, NUMBERS), of the first m ports
    reference  velocity (L) and rate (B) the body reached in that pass, and whether there was one (7)
    """
    changes = np.zeros((wrenches.shape[0], 6))
    if reference[VALID] == 0.0:
        return changes
    trial = step_body(body, before, total_load(wrenches, changes), step, longest)
    moved = apply_transposed(rotation(trial.attitude), sub(trial.velocity, vector(reference, 0)))
    turned = sub(trial.rate, vector(reference, 3))
    changes[: models.shape[0]] = corrections(models, body.mass, body.inertia, moved, turned, step)
    return changes


@jit
def write_body(body: Body, now: BodyState, out: Array, angles: Array) -> None:
    """out: position, quaternion, velocity, rate (13 first); angles: attitude, each rate with companions, kinetic and potential energy."""
    put_vector(out, 0, now.position)
    put_quaternion(out, 3, now.attitude)
    put_vector(out, 7, now.velocity)
    put_vector(out, 10, now.rate)
    put_vector(angles, 0, yaw_pitch_roll(now.attitude))
    for j in range(3):
        angles[RATES + 3 * j] = now.rate[j]
    angles[ENERGY], angles[ENERGY + 1] = body_energy(body, now)


@jit(inner=True)
def write_rates(before: Vector, now: Vector, step: float, angles: Array) -> None:
    """Mean and slope of each rate: those of the straight line through both ends, which a listener follows to the end value exactly."""
    for j in range(3):
        angles[RATES + 3 * j + 1] = 0.5 * (before[j] + now[j])
        angles[RATES + 3 * j + 2] = (now[j] - before[j]) / step


@jit(inner=True)
def write_course(out: Array, place: int, before: Vector, now: Vector, first: Vector, last: Vector, step: float) -> None:
    """An acceleration at `place`: at the end, its mean, its slope over the interval (9 numbers)."""
    put_vector(out, place, last)
    put_vector(out, place + 3, scale(1.0 / step, sub(now, before)))
    put_vector(out, place + 6, scale(1.0 / step, sub(last, first)))


@jit
def advance_body(
    body: Body, longest: float, step: float, wrenches: Array, models: Array, reference: Array, out: Array, angles: Array, work: Array
) -> None:
    """Take the body over `step` seconds and fill its outputs; work (n) is counted up."""
    before = BodyState(vector(out, 0), quaternion(out, 3), vector(out, 7), vector(out, 10))
    changes = changes_of(body, before, wrenches, models, reference, step, longest)
    load = total_load(wrenches, changes)
    first = body_rate(body, before, load, 0.0)
    now = step_body(body, before, load, step, longest)
    last = body_rate(body, now, load, step)
    write_body(body, now, out, angles)
    write_rates(before.rate, now.rate, step, angles)
    write_course(out, 13, before.velocity, now.velocity, first.acceleration, last.acceleration, step)
    write_course(out, 22, before.rate, now.rate, first.spin_up, last.spin_up, step)
    for k in range(wrenches.shape[0]):
        work[k] += wrench_work(before, now, with_change(read_wrench(wrenches[k]), changes[k]), step)
