"""How near a vehicle came to going over an edge of the polygon its footpads stand on: an angle and an energy.

Edges join neighbouring footpads; the pads turn on ball joints, so those joints are the axis a vehicle would topple about. For an edge
with unit vector u from pad i to pad j (counter-clockwise seen from above), r from pad i to the centre of mass, x̂ up:

    e_up = x̂ less its part along u, normalised        e_in = e_up × u, level and toward the other pads
    α    = atan2(r·e_in, r·e_up)                      angle between gravity in the plane across u and the line from edge to centre of mass
    B    = m g √(1 − u_x²) ρ (1 − cos α)              rise of potential energy to the top; ρ = |r| across u
    T    = ½ L²/I,  L = u·(R I_B ω + m r × v),  I = u·R I_B Rᵀ u + m ρ²

α > 0: the centre of mass is inside the edge, 0: above it, < 0: beyond it. T is the energy of the rotation about the edge that is left
where its two pads stop dead at this instant: all of the kinetic energy that can go into toppling over it. L > 0 turns outward.

    energy margin = B − T [L > 0]   for α ≥ 0         −B + T [L < 0]   beyond the edge

It is positive exactly where a rigid body on a fixed edge ends up inside it, and changes sign with α in a body at rest. Assumed: the
mass properties are those of the undeformed vehicle, and no thrust acts. Valid while the vehicle is the right way up.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from orchestrator.results.channels import Array

UP = np.array([1.0, 0.0, 0.0])


@dataclass(frozen=True)
class MassProperties:
    """Of the whole vehicle: kg, the tensor (3, 3) in kg m2 about the origin of B, m/s2."""

    mass: float
    inertia: Array
    gravity: float


@dataclass(frozen=True)
class Motion:
    """Of B's origin, the centre of mass, at n instants: m, m/s in L; attitude (w, x, y, z) B to L; rad/s in B."""

    position: Array
    velocity: Array
    quaternion: Array
    rate: Array


@dataclass(frozen=True)
class Edges:
    """Every edge at every instant, arrays of (n, edges)."""

    pads: list[tuple[int, int]]
    angle: Array
    """rad."""
    energy: Array | None
    """J; None without mass properties."""
    secure: Array | None
    """J: B less the whole kinetic energy; where it is positive for every edge nothing but a push from outside can tip the vehicle."""


def around(pads: Array) -> list[int]:
    """Pads (legs, 3) in the order of their azimuth, counter-clockwise seen from above."""
    level = pads - pads.mean(axis=0)
    return [int(k) for k in np.argsort(np.arctan2(level[:, 2], level[:, 1]))]


def edges(pads: Array, motion: Motion, of: MassProperties | None) -> Edges:
    """pads: ball joints, (n, legs, 3) in L; at least three legs."""
    order = around(pads[0])
    pairs = list(zip(order, order[1:] + order[:1], strict=True))
    start = pads[:, [i for i, _ in pairs]]
    along = pads[:, [j for _, j in pairs]] - start
    u = along / np.linalg.norm(along, axis=2, keepdims=True)
    level = np.sqrt(1.0 - u[..., 0] ** 2)
    e_up = (UP - u[..., :1] * u) / level[..., None]
    r = motion.position[:, None, :] - start
    inside, above = np.sum(r * np.cross(e_up, u), axis=2), np.sum(r * e_up, axis=2)
    angle, rho = np.arctan2(inside, above), np.hypot(inside, above)
    if of is None:
        return Edges(pairs, angle, None, None)
    barrier = of.mass * of.gravity * level * rho * (1.0 - np.cos(angle))
    turn = Rotation.from_quat(motion.quaternion, scalar_first=True)
    spin = turn.apply(motion.rate @ of.inertia)
    outward = np.sum(u * (spin[:, None, :] + of.mass * np.cross(r, motion.velocity[:, None, :])), axis=2)
    own = np.stack([turn.apply(u[:, k], inverse=True) for k in range(len(pairs))], axis=1)
    rotation = 0.5 * outward**2 / (np.sum(own @ of.inertia * own, axis=2) + of.mass * rho**2)
    energy = np.where(angle >= 0.0, barrier - rotation * (outward > 0.0), rotation * (outward < 0.0) - barrier)
    kinetic = 0.5 * of.mass * np.sum(motion.velocity**2, axis=1) + 0.5 * np.sum(motion.rate @ of.inertia * motion.rate, axis=1)
    return Edges(pairs, angle, energy, np.where(angle >= 0.0, barrier, -barrier) - kinetic[:, None])
