"""A footpad's soil between its arrays: the blocks of a unit's memory in, one interval, the blocks out."""

import numpy as np
from numpy.typing import NDArray

from .blocks import matrix, put_matrix, put_vector, quaternion, vector
from .compiled import jit
from .footpad import DEPTH, Footpad, PadMotion, Wrench, deepest, lever, pad_wrench, slid, start_memory
from .soil import Soil
from .soil_stepping import InterfaceModel, PadStart, Shift, SoilCourse, step_soil
from .surface import Surface, gap_at, normal_at
from .vectors import Matrix, Vector, add, axpy, dot, normalise, rotation, scale, sub, times

Array = NDArray[np.float64]
PENETRATION, GAP, SKID, NORMAL, WORK = range(5)  # places in the report


@jit(inner=True)
def read_start(pad: Array) -> PadStart:
    """Port `pad`: position, quaternion, velocity, angular velocity (13 numbers)."""
    return PadStart(vector(pad, 0), normalise(quaternion(pad, 3)), vector(pad, 7), vector(pad, 10))


@jit(inner=True)
def read_model(m: Array) -> InterfaceModel:
    """Port members `model_*` (43 numbers)."""
    return InterfaceModel(
        vector(m, 0),
        matrix(m, 3),
        matrix(m, 12),
        matrix(m, 21),
        vector(m, 30),
        vector(m, 33),
        vector(m, 36),
        m[39],
        vector(m, 40),
    )


@jit(inner=True)
def motion_of(start: PadStart) -> PadMotion:
    """The pad as its points move."""
    return PadMotion(start.position, rotation(start.attitude), start.velocity, start.rate)


@jit(inner=True)
def write_report(surface: Surface, pad: Footpad, at: PadMotion, wrench: Wrench, memory: Array, report: Array) -> None:
    """Penetration of the centre, gap, skid, normal force (5 numbers, the work is kept)."""
    gap = 1e300
    for i in range(5):
        gap = min(gap, gap_at(surface, add(at.position, lever(pad, at.attitude, i))))
    report[PENETRATION] = max(memory[0, DEPTH], 0.0)
    report[GAP] = gap
    report[SKID] = slid(memory)
    report[NORMAL] = dot(wrench.force, normal_at(surface, at.position))


@jit(inner=True)
def write_wrench(course: SoilCourse, end: Wrench, step: float, out: Array) -> None:
    """End value, mean and least-squares slope of force and torque over the interval (18 numbers)."""
    put_vector(out, 0, end.force)
    put_vector(out, 9, end.torque)
    fit(course.impulse, course.moment_impulse, step, out, 3)
    fit(course.angular_impulse, course.moment_angular_impulse, step, out, 12)


@jit(inner=True)
def fit(impulse: Vector, moment: Vector, step: float, out: Array, place: int) -> None:
    """Mean and slope of the straight line with the same impulse and the same first moment in time."""
    put_vector(out, place, scale(1.0 / step, impulse))
    about_middle = axpy(-0.5 * step, impulse, moment)
    put_vector(out, place + 3, scale(12.0 / (step * step * step), about_middle))


@jit
def start_soil(
    soil: Soil, surface: Surface, pad: Footpad, port: Array, wrench: Array, predicted: Array, report: Array, contact: Array, memory: Array
) -> float:
    """Virgin soil under the pad where it is; returns the greatest depth of any point, m."""
    start = read_start(port)
    at = motion_of(start)
    start_memory(surface, pad, at, memory)
    now, ground = pad_wrench(soil, surface, pad, at, memory)
    for i in range(2):
        put_vector(wrench, 9 * i, now[i])
        put_vector(wrench, 9 * i + 3, now[i])
    write_predicted(at, start.rate, predicted)
    write_report(surface, pad, at, now, memory, report)
    write_contact(ground.k_xx, ground.c_xx, contact)
    return deepest(memory)


@jit(inner=True)
def write_predicted(at: PadMotion, rate: Vector, predicted: Array) -> None:
    """Position, velocity (value and mean) and angular velocity the soil expects the pad to have (15 numbers, the velocity's slope kept)."""
    put_vector(predicted, 0, at.position)
    put_vector(predicted, 3, at.velocity)
    put_vector(predicted, 6, at.velocity)
    put_vector(predicted, 12, rate)


@jit(inner=True)
def write_contact(stiffness: Matrix, damping: Matrix, contact: Array) -> None:
    """How the ground answers the pad's motion: -dF/dx and -dF/dv as value and mean, by rows (36 numbers)."""
    for i in (0, 9):
        put_matrix(contact, i, stiffness)
        put_matrix(contact, 18 + i, damping)


@jit
def advance_soil(
    soil: Soil,
    surface: Surface,
    pad: Footpad,
    longest: float,
    step: float,
    port: Array,
    model: Array,
    shift: Array,
    wrench: Array,
    predicted: Array,
    report: Array,
    contact: Array,
    memory: Array,
) -> tuple[bool, float]:
    """Take pad and soil over `step` seconds and fill the outputs; False where Newton gave up. Also the instant of contact, s (-1: none)."""
    start = read_start(port)
    mismatch = Shift(vector(shift, 0), vector(shift, 3))
    at, _, end, course, ok = step_soil(soil, surface, pad, read_model(model), start, mismatch, memory, step, longest)
    if not ok:
        return False, -1.0
    write_wrench(course, end, step, wrench)
    write_predicted(at, at.rate, predicted)
    fit(sub(at.position, start.position), course.displacement_moment, step, predicted, 6)
    report[WORK] -= course.work
    write_report(surface, pad, at, end, memory, report)
    write_contact(times(1.0 / step, course.stiffness), times(1.0 / step, course.damping), contact)
    return True, course.touch
