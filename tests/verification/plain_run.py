"""A short run of leg, soil and twin, printed as hexadecimal floats; run by itself it is the plain Python half of a comparison.

    LANDER_PLAIN_PYTHON=1 python plain_run.py
"""

import json

import numpy as np
from apollo_samples import ENGINE_OFF, GRAVITY, ZUPP_SOIL, leg_at, pad_load, started, vehicle
from lander.laws.base_motion import BaseMotion
from lander.laws.compiled import COMPILED
from lander.laws.footpad import Footpad, PadMotion, start_memory
from lander.laws.leg_stepping import start_state, step_leg
from lander.laws.soil_stepping import InterfaceModel, PadStart, Shift, step_soil
from lander.laws.surface import inclined_plane
from lander.laws.twin_stepping import Settings, integrate, start_accelerations
from lander.laws.vectors import ZERO, from_rotation_vector, identity, rotation


def leg() -> list[float]:
    """Ten milliseconds of a leg under load on a moving base."""
    attitude = from_rotation_vector((0.1, -0.2, 0.05))
    base = BaseMotion((4.0, 0.0, 0.0), attitude, (-0.6, -0.5, 0.2), (0.1, 0.2, -0.1), (1.0, -2.0, 1.5), ZERO, (0.5, -0.8, 1.0), ZERO)
    load = pad_load((20000.0, 3000.0, -5000.0), (40.0, 10.0, 5.0), ZERO, ZERO)
    piece = leg_at(0.6)
    end, course, _ = step_leg(piece, GRAVITY, base, load, start_state(piece, attitude, base.rate), 0.01, 2.5e-4, ZERO)
    return [*end.position, *end.velocity, *end.attitude, *end.rate, *course.impulse, course.pad_work, course.dissipated]


def soil() -> list[float]:
    """Twenty milliseconds of a tilted pad meeting the ground."""
    pad, surface = Footpad(0.47, 0.10), inclined_plane(0.08, -0.2)
    attitude = from_rotation_vector((0.0, 0.05, 0.1))
    model = InterfaceModel(
        (-GRAVITY, 0.0, 0.0), identity(0.01), identity(0.0), identity(0.0), ZERO, ZERO, (1.2, 0.6, 0.6), 100.0, ZERO
    )
    start = PadStart((0.12, 0.0, 0.0), attitude, (-0.6, 0.4, -0.2), ZERO)
    memory = np.zeros((5, 8))
    start_memory(surface, pad, PadMotion(start.position, rotation(attitude), start.velocity, ZERO), memory)
    at, end, wrench, course, _ = step_soil(ZUPP_SOIL, surface, pad, model, start, Shift(ZERO, ZERO), memory, 0.02, 1e-3)
    return [*at.position, *at.velocity, *at.rate, *end, *wrench.force, *wrench.torque, course.work, course.touch, *memory.ravel()]


def twin() -> list[float]:
    """Thirty milliseconds of the Zupp-like landing."""
    craft = vehicle()
    flight = started(craft)
    a, ledger, touch = np.zeros((5, 6)), np.zeros((5, 4)), -np.ones(4)
    start_accelerations(craft, ENGINE_OFF, flight, a)
    progress = integrate(craft, ENGINE_OFF, Settings(1e-4, 5e-3, 1e-4), flight, a, ledger, touch, 0.0, 0.03)
    numbers = np.concatenate([flight.body, flight.legs.ravel(), flight.memory.ravel(), ledger.ravel(), touch])
    return [*numbers.tolist(), float(progress.steps), float(progress.rejected)]


def results() -> dict[str, list[str]]:
    """All three, to the last bit."""
    return {name: [float(x).hex() for x in run()] for name, run in (("leg", leg), ("soil", soil), ("twin", twin))}


if __name__ == "__main__":
    assert not COMPILED
    print(json.dumps(results()))
