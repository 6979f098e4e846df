"""Struts and soil, from docs/physics.md: eqs. 1 to 4, law 2 of the soil."""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from numba import njit

from .landing import Array

STOP, STOP_DAMPING = 4e7, 2e4  # N/m, N s/m: retaining ring of a primary
BEARING_SLIP, SOIL_SLIP = 1e-2, 1e-3  # m/s over which friction comes in
VIRGIN = 5  # cores a leg: primary; right, left, each tension and compression


class Constants(NamedTuple):
    """Of struts and soil, SI."""

    primary_1: float
    primary_2: float
    compression: float
    tension_1: float
    tension_2: float
    width: float
    primary_brake: float
    compression_brake: float
    tension_brake: float
    bearing: float
    joints: float
    exponent: float
    damping: float
    damping_depth: float
    friction: float
    plowing: float
    band: float
    drag: float


@njit(cache=True)
def core(d, v, crushed, load_1, load_2, boundary, width, brake):  # type: ignore[no-untyped-def]
    """Crush load, N, of one cartridge at stroke d and rate v; crushed is d_MAX so far."""
    d_max = max(crushed, d)
    stage = 0.5 * (1.0 - np.tanh(6.0 / width * (boundary - d - 0.5 * width)))
    load = load_2 if d_max >= boundary else load_1 + stage * (load_2 - load_1)
    weight = (1.0 - np.tanh(6.0 / width * (d_max - d - 0.5 * width))) / (1.0 + np.tanh(3.0))
    return max(0.0, min(load, weight * (load + brake * v)))


@njit(cache=True)
def primary(d, v, wall, crushed, it):  # type: ignore[no-untyped-def]
    """Push on the piston, N, at compression d; wall is the lateral force between piston and cylinder."""
    push = core(d, v, crushed[0], it.primary_1, it.primary_2, 0.254, it.width, it.primary_brake)
    if d < 0.0:
        push -= max(0.0, -STOP * d - STOP_DAMPING * v)
    crushed[0] = max(crushed[0], d)
    return push + it.bearing * wall * np.tanh(v / BEARING_SLIP)


@njit(cache=True)
def secondary(d, v, crushed, it):  # type: ignore[no-untyped-def]
    """Tension, N, at elongation d."""
    pull = core(d, v, crushed[0], it.tension_1, it.tension_2, 0.102, it.width, it.tension_brake)
    push = core(-d, -v, crushed[1], it.compression, it.compression, 1e9, it.width, it.compression_brake)
    crushed[0], crushed[1] = max(crushed[0], d), max(crushed[1], -d)
    return pull - push + it.joints * v


@njit(cache=True)
def point(depth, velocity, normal, strength, step, memory, it):  # type: ignore[no-untyped-def]
    """Force of the soil, N, on one of a pad's five points; memory: deepest, slide (3)."""
    sink = -np.sum(normal * velocity)
    slip = velocity + sink * normal
    memory[0] = max(memory[0], depth)
    memory[1:4] += slip * step
    elastic = max(0.0, 1.0 - (memory[0] - depth) / it.band)
    weight = 1.0 if depth >= it.damping_depth else 0.5 * (1.0 - np.cos(pi * depth / it.damping_depth))
    sinking = max(sink, 0.0)
    force = 0.2 * elastic * (strength * memory[0] ** it.exponent + weight * it.damping * sinking + it.drag * sinking**2)
    return force * normal - it.friction * force / np.sqrt(np.sum(slip**2) + SOIL_SLIP**2) * slip - 0.2 * it.plowing * memory[1:4]


@njit(cache=True)
def joints_of(u, length, across, base, cylinder, damping):  # type: ignore[no-untyped-def]
    """Damping torques, N m, of a secondary's joints on it, at the truss and at the connection; it turns as its ends move."""
    turn = np.cross(u, across) / length
    top, end = turn - base + np.sum(base * u) * u, turn - cylinder + np.sum(cylinder * u) * u
    return -damping * top, -damping * end


class Memory(NamedTuple):
    """Of what has been crushed and slid, changed in place."""

    crushed: Array  # legs x 5: d_MAX of each core, m
    soil: Array  # legs x 5 points x 4: deepest, slide (3), m
    touched: Array  # legs: time of first contact, s, or -1
    touched_at: Array  # legs x 3: where, m


@njit(cache=True)
def add(applied, k, centre, at, force):  # type: ignore[no-untyped-def]
    """A force at a point of body k, reduced to its centre of mass."""
    applied[k, :3] += force
    applied[k, 3:] += np.cross(at - centre[k], force)


@njit(cache=True)
def legs(t, step, p, v, spins, slides, walls, lengths, strengths, normal, centre, memory, it, applied, pushes):  # type: ignore[no-untyped-def]
    """All forces of struts and soil at one instant.

    p, v      33 x 3: origin, right and left truss point of each leg, connections, five points of each pad
    spins     5 x 3: angular velocities of vehicle and cylinders;  slides  legs x 2: extension of each primary and its rate
    applied   bodies x 6, world 0, vehicle 1, then cylinder, piston, pad of each leg;  pushes  force along each slide
    """
    for i in range(4):
        pushes[i] = primary(-slides[i, 0], -slides[i, 1], walls[i], memory.crushed[i, :1], it)
        cylinder, pad, c = 2 + 3 * i, 4 + 3 * i, 9 + i
        for side in range(2):
            a = 1 + 2 * i + side
            way = p[c] - p[a]
            length = np.sqrt(np.sum(way**2))
            u = way / length
            tension = secondary(length - lengths[i, side], np.sum((v[c] - v[a]) * u), memory.crushed[i, 1 + 2 * side : 3 + 2 * side], it)
            top, end = joints_of(u, length, v[c] - v[a], spins[0], spins[1 + i], it.joints)
            force = tension * u - np.cross(top + end, u) / length
            add(applied, 1, centre, p[a], force)
            add(applied, cylinder, centre, p[c], -force)
            applied[1, 3:] -= top
            applied[cylinder, 3:] -= end
        for j in range(5):
            m = 13 + 5 * i + j
            depth = -np.sum(normal * p[m])
            if depth > 0.0:
                if memory.touched[i] < 0.0:
                    memory.touched[i] = t
                    memory.touched_at[i] = p[13 + 5 * i]
                add(applied, pad, centre, p[m], point(depth, v[m], normal, strengths[i], step, memory.soil[i, j], it))
