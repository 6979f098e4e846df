"""What the twin shows of its state: the blocks of a unit's memory, in the order of its variables."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .blocks import put_quaternion, put_vector, quaternion, vector
from .compiled import Kept, jit
from .footpad import DEPTH, POINTS, lever, pad_wrench_alone, slid
from .interface import leg_energy
from .leg import Crush, bottomed, shape, strokes, strut_loads
from .leg_stepping import LegState
from .rigid_body import BodyState, body_energy
from .surface import gap_at, normal_at
from .twin import CRUSH, Engine, Flight, P, Q, V, Vehicle, W
from .twin_effects import Effects
from .twin_nominal import Nominal
from .twin_stepping import BALL, EFFECTS, ENGINE, SMALLEST, SOIL, STRUTS, Ride, Settings, fly, pad_motion, state_of
from .vectors import add, apply_transposed, dot, rotation, yaw_pitch_roll

Array = NDArray[np.float64]
LEG_REPORT = 24  # numbers a leg shows


@jit(inner=True)
def leg_state(f: Flight, i: int) -> LegState:
    """Leg i as its own unit keeps it: the pad's rate in pad axes."""
    row = f.legs[i]
    q = quaternion(row, Q)
    crush = Crush(row[CRUSH], row[CRUSH + 1], row[CRUSH + 2], row[CRUSH + 3], row[CRUSH + 4])
    return LegState(vector(row, P), vector(row, V), q, apply_transposed(rotation(q), vector(row, W)), crush)


@jit(inner=True)
def show_body(vehicle: Vehicle, f: Flight, a: Array, body: Array, energy: Array) -> None:
    """body: position, quaternion, velocity, rate, acceleration, angular acceleration, attitude angles, rates (25); energy: kinetic,
    potential of the whole vehicle."""
    base = state_of(f, a[0], vehicle.body.gravity)
    put_vector(body, 0, base.position)
    put_quaternion(body, 3, base.attitude)
    put_vector(body, 7, base.velocity)
    put_vector(body, 10, base.rate)
    put_vector(body, 13, base.acceleration)
    put_vector(body, 16, base.spin_up)
    put_vector(body, 19, yaw_pitch_roll(base.attitude))
    put_vector(body, 22, base.rate)
    kinetic, potential = body_energy(vehicle.body, BodyState(base.position, base.attitude, base.velocity, base.rate))
    for i in range(len(vehicle.legs)):
        k, p = leg_energy(vehicle.legs[i], vehicle.body.gravity, base, leg_state(f, i))
        kinetic += k
        potential += p
    energy[0], energy[1] = kinetic, potential


@jit(inner=True)
def show_leg(vehicle: Vehicle, f: Flight, ledger: Array, touch: Array, i: int, out: Array) -> None:
    """Leg i: pad position and velocity, strokes, loads, peak strokes, bottomed, dissipated, pad work, then its soil's penetration, gap,
    skid, normal force, contact, contact time (24 numbers)."""
    leg = vehicle.legs[i]
    motion = pad_motion(f, i)
    state = leg_state(f, i)
    at = shape(leg, state.position, state.velocity)
    loads = strut_loads(leg, at, state.crush)
    d = strokes(leg, state.position)
    put_vector(out, 0, motion.position)
    put_vector(out, 3, motion.velocity)
    put_vector(out, 6, d)
    put_vector(out, 9, (loads.primary.force, loads.right.force, loads.left.force))
    for j in range(3):
        out[12 + j] = max(out[12 + j], d[j])
    out[15] = 1.0 if bottomed(leg, d[0], d[1], d[2]) else 0.0
    out[16] = -(ledger[1 + i, STRUTS] + ledger[1 + i, BALL])
    out[17] = ledger[1 + i, SOIL]
    wrench = pad_wrench_alone(vehicle.soils[i], vehicle.surfaces[i], vehicle.pad, motion, f.memory[i])
    gap = 1e300
    for j in range(POINTS):
        gap = min(gap, gap_at(vehicle.surfaces[i], add(motion.position, lever(vehicle.pad, motion.attitude, j))))
    out[18] = max(f.memory[i, 0, DEPTH], 0.0)
    out[19] = gap
    out[20] = slid(f.memory[i])
    out[21] = dot(wrench.force, normal_at(vehicle.surfaces[i], motion.position))
    out[22] = 1.0 if gap < 0.0 else 0.0
    out[23] = touch[i]


@jit
def show(vehicle: Vehicle, f: Flight, a: Array, ledger: Array, touch: Array, body: Array, energy: Array, legs: Array) -> None:
    """Everything the twin shows. energy: kinetic, potential, work through the port, of the effects; legs: (n, LEG_REPORT)."""
    show_body(vehicle, f, a, body, energy)
    energy[2], energy[3] = ledger[0, ENGINE], ledger[0, EFFECTS]
    for i in range(len(vehicle.legs)):
        show_leg(vehicle, f, ledger, touch, i, legs[i])


class Run(NamedTuple):
    """What stays the same objects throughout a run."""

    vehicle: Vehicle
    effects: Effects
    ride: Ride
    settings: Settings
    nominal: Nominal
    port: Array  # (6, 3): force, its slope, force added, torque, its slope, torque added; N, N/s, N m, N m/s, B
    first: Array  # (1,): step to try first, s
    taken: Array  # (2,): steps taken and refused so far
    body: Array  # (25,): outputs, as `show` fills them
    energy: Array  # (4,)
    legs: Array  # (n, LEG_REPORT)


@jit
def kept(run: Run) -> Any:
    """A run in a list of one, in the compiled code's own memory: handed over as a tuple it takes 0.1 ms a call."""
    box = Kept()
    box.append(run)
    return box


@jit
def engine_at(port: Array) -> Engine:
    """Wrench of the engine's port, its socket included."""
    force, torque = add(vector(port[0], 0), vector(port[2], 0)), add(vector(port[3], 0), vector(port[5], 0))
    return Engine(force, torque, vector(port[1], 0), vector(port[4], 0))


@jit
def fly_and_show(box: Any, time: float, interval: float) -> float:
    """An interval of a kept run and what the twin shows after it, in one call; gives the step (s) that could not be done, or zero."""
    run = box[0]
    settings = Settings(run.settings.tolerance, run.settings.longest, run.first[0])
    done = fly(run.vehicle, run.effects, engine_at(run.port), settings, run.ride, run.nominal, time, interval)
    if not done.ok:
        return done.next_step if done.next_step > 0.0 else SMALLEST  # NaN, too, is a step that could not be done
    run.first[0] = done.next_step
    run.taken[0] += done.steps
    run.taken[1] += done.rejected
    show(run.vehicle, run.ride.flight, run.ride.a, run.ride.ledger, run.ride.touch, run.body, run.energy, run.legs)
    return 0.0
