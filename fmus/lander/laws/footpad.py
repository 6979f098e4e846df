"""Wrench of the regolith on one rigid footpad through its five contact points, with tangents; memory per point.

The points lie in the pad's base plane, `height` below the ball joint: the centre and four on the rim (paper, Fig. 9). L throughout.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compiled import jit
from .soil import UNLATCHED, Soil, friction_bend, friction_scale, latched, normal_force, tangential_force
from .surface import Surface, depth_at, laid_down, normal_at
from .tangent_term import tangent_term
from .turning import with_turning
from .vectors import (
    ZERO,
    Matrix,
    Vector,
    add,
    apply,
    axpy,
    cross,
    dot,
    identity,
    outer,
    plus,
    skew_times,
    sub,
    times,
    times_skew,
)

Array = NDArray[np.float64]

POINTS = 5
DATUM, SLIDE, PLACE, DEPTH = 0, 1, 4, 7  # columns of a point's memory: δ_MAX, slide (3), last place (3), last depth
COLUMNS = 8


class Footpad(NamedTuple):
    """Shape of the pad."""

    radius: float  # m
    height: float  # base to ball joint, m


class PadMotion(NamedTuple):
    """Pose and twist of the pad at its ball joint, L."""

    position: Vector  # m
    attitude: Matrix  # pad axes to L
    velocity: Vector  # m/s
    rate: Vector  # rad/s


class Wrench(NamedTuple):
    """On the pad about the ball joint, L."""

    force: Vector  # N
    torque: Vector  # N m


class PadTangents(NamedTuple):
    """Minus the derivatives of force (x) and torque (r) by position (x) and rotation (r), and by velocity and rate."""

    k_xx: Matrix
    k_xr: Matrix
    k_rx: Matrix
    k_rr: Matrix
    c_xx: Matrix
    c_xr: Matrix
    c_rx: Matrix
    c_rr: Matrix


NOTHING = identity(0.0)
NO_TANGENTS = PadTangents(NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING)


@jit
def lever(pad: Footpad, attitude: Matrix, i: int) -> Vector:
    """From the ball joint to point i (0 is the centre), m, L. The pad's own x axis points up."""
    down = -pad.height
    if i == 0:
        own = (down, 0.0, 0.0)
    elif i == 1:
        own = (down, pad.radius, 0.0)
    elif i == 2:
        own = (down, 0.0, pad.radius)
    elif i == 3:
        own = (down, -pad.radius, 0.0)
    else:
        own = (down, 0.0, -pad.radius)
    return apply(attitude, own)


@jit
def tangential(normal: Vector, a: Vector) -> Vector:
    """a without its part along the normal."""
    return axpy(-dot(normal, a), normal, a)


@jit
def slide_at(surface: Surface, memory: Array, i: int, place: Vector, depth: float, normal: Vector) -> Vector:
    """Slide of point i (m) once it has moved to `place`: only the part of the way made in the soil counts.

    Over a relief the slide made so far is laid into the tangent plane of the new place.
    """
    so_far = laid_down(surface.relief, normal, (memory[i, SLIDE], memory[i, SLIDE + 1], memory[i, SLIDE + 2]))
    if depth <= 0.0:
        return so_far
    before = memory[i, DEPTH]
    share = 1.0 if before > 0.0 else depth / (depth - before)
    moved = sub(place, (memory[i, PLACE], memory[i, PLACE + 1], memory[i, PLACE + 2]))
    return axpy(share, tangential(normal, moved), so_far)


@jit(inline=True)
def wrench_and_tangents(soil: Soil, surface: Surface, pad: Footpad, motion: PadMotion, memory: Array) -> tuple[Wrench, PadTangents]:
    """What `pad_wrench` gives."""
    force, torque = ZERO, ZERO
    t = NO_TANGENTS
    for i in range(POINTS):
        arm = lever(pad, motion.attitude, i)
        place = add(motion.position, arm)
        depth = depth_at(surface, place)
        if depth <= 0.0:
            continue
        normal = normal_at(surface, place)
        velocity = add(motion.velocity, cross(motion.rate, arm))
        push = normal_force(soil, depth, -dot(normal, velocity), memory[i, DATUM])
        slip = tangential(normal, velocity)
        slide = slide_at(surface, memory, i, place, depth, normal)
        grip = max(push.force, 0.0)  # soil that pulls gives no friction
        f = axpy(push.force, normal, tangential_force(soil, grip, slip, slide))

        speed = sqrt(dot(slip, slip))
        k = friction_scale(soil, speed)
        along = axpy(-k, slip, normal) if push.force >= 0.0 else normal  # how F follows F_n
        plane = plus(identity(1.0), times(-1.0, outer(normal, normal)))
        k_i = plus(times(push.stiffness, outer(along, normal)), times(soil.plowing, plane))
        turn = times(friction_bend(soil, speed, k), outer(slip, slip))
        c_i = plus(times(push.damping, outer(along, normal)), times(grip * k, plus(plane, turn)))
        k_i = with_turning(k_i, surface, surface.relief, place, velocity, push, along, grip * k, turn)
        if soil.effects.tangent_term.coefficient != 0.0:
            term = tangent_term(soil.effects.tangent_term, depth, slip, slide, normal, plane)
            f, k_i, c_i = add(f, term.force), plus(k_i, term.stiffness), plus(c_i, term.damping)
        force, torque = add(force, f), add(torque, cross(arm, f))
        t = with_point(t, k_i, c_i, arm)
    return Wrench(force, torque), t


@jit(inline=True)
def with_point(t: PadTangents, k: Matrix, c: Matrix, arm: Vector) -> PadTangents:
    """Tangents with one point's stiffness and damping at its lever added."""
    k_arm, c_arm = times(-1.0, times_skew(k, arm)), times(-1.0, times_skew(c, arm))
    return PadTangents(
        plus(t.k_xx, k),
        plus(t.k_xr, k_arm),
        plus(t.k_rx, skew_times(arm, k)),
        plus(t.k_rr, skew_times(arm, k_arm)),
        plus(t.c_xx, c),
        plus(t.c_xr, c_arm),
        plus(t.c_rx, skew_times(arm, c)),
        plus(t.c_rr, skew_times(arm, c_arm)),
    )


@jit
def pad_wrench(soil: Soil, surface: Surface, pad: Footpad, motion: PadMotion, memory: Array) -> tuple[Wrench, PadTangents]:
    """Force and torque of the soil on the pad, and their tangents. memory: (5, COLUMNS)."""
    return wrench_and_tangents(soil, surface, pad, motion, memory)


@jit
def pad_wrench_alone(soil: Soil, surface: Surface, pad: Footpad, motion: PadMotion, memory: Array) -> Wrench:
    """The wrench of `pad_wrench`: the compiler leaves out what only the tangents need."""
    wrench, _ = wrench_and_tangents(soil, surface, pad, motion, memory)
    return wrench


@jit
def remember(soil: Soil, surface: Surface, pad: Footpad, motion: PadMotion, memory: Array) -> None:
    """Bring every point's memory up to the pad's new motion: slide first (it needs the old place), then datum, place and depth."""
    for i in range(POINTS):
        arm = lever(pad, motion.attitude, i)
        place = add(motion.position, arm)
        depth = depth_at(surface, place)
        normal = normal_at(surface, place)
        slide = slide_at(surface, memory, i, place, depth, normal)
        rate = -dot(normal, add(motion.velocity, cross(motion.rate, arm)))
        memory[i, DATUM] = latched(soil, depth, rate, memory[i, DATUM])
        for j in range(3):
            memory[i, SLIDE + j] = slide[j]
            memory[i, PLACE + j] = place[j]
        memory[i, DEPTH] = depth


@jit
def start_memory(surface: Surface, pad: Footpad, motion: PadMotion, memory: Array) -> None:
    """Virgin soil: nothing latched, no slide."""
    for i in range(POINTS):
        place = add(motion.position, lever(pad, motion.attitude, i))
        memory[i, DATUM] = UNLATCHED
        for j in range(3):
            memory[i, SLIDE + j] = 0.0
            memory[i, PLACE + j] = place[j]
        memory[i, DEPTH] = depth_at(surface, place)


@jit
def deepest(memory: Array) -> float:
    """Greatest depth of any point, m; negative while all are above the surface."""
    depth = float(memory[0, DEPTH])
    for i in range(1, POINTS):
        depth = max(depth, float(memory[i, DEPTH]))
    return depth


@jit
def slid(memory: Array) -> float:
    """Slide of the pad's centre since its first contact, m."""
    s = (memory[0, SLIDE], memory[0, SLIDE + 1], memory[0, SLIDE + 2])
    return sqrt(dot(s, s))


@jit
def pad_power(wrench: Wrench, motion: PadMotion) -> float:
    """Power of the soil's wrench on the pad, W."""
    return dot(wrench.force, motion.velocity) + dot(wrench.torque, motion.rate)
