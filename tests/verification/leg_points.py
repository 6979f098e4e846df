"""A leg as a heap of mass points: rods by Gauss quadrature, velocities by differences. It shares no formula with `lander.laws.leg`.

Extended precision and five-point differences, so that three nested derivatives still leave ten digits.
"""

from collections.abc import Callable

import numpy as np
from lander.laws.leg import Leg
from numpy.typing import NDArray

Array = NDArray[np.longdouble]
STEP = np.longdouble(2e-3)
KNOTS, WEIGHTS = np.polynomial.legendre.leggauss(3)  # exact for the quadratic integrands of momentum, moment and energy
KNOTS, WEIGHTS = np.longdouble(0.5) * (KNOTS + 1), np.longdouble(0.5) * np.asarray(WEIGHTS, np.longdouble)


def vec(x: object) -> Array:
    """Three numbers (or more) in extended precision."""
    return np.asarray(x, np.longdouble)


def slope(f: Callable[[np.longdouble], Array], step: np.longdouble = STEP) -> Array:
    """df/dx at x = 0 by the five-point formula, error f⁗' step⁴/30."""
    return (8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step)


def gradient(f: Callable[[Array], Array], x: Array) -> Array:
    """df/dx_j; the last axis is j."""
    return np.stack([slope(lambda k, e=e: f(x + k * e)) for e in np.eye(len(x), dtype=np.longdouble)], axis=-1)


def joints(leg: Leg, p: Array) -> tuple[Array, Array, Array]:
    """Primary's unit vector, connection and piston's head."""
    g = leg.geometry
    axis = (p - vec(g.upper)) / np.sqrt(np.sum((p - vec(g.upper)) ** 2))
    return axis, vec(g.upper) + g.cylinder * axis, p - g.piston * axis


def places(leg: Leg, p: Array) -> Array:
    """Where the mass points are in B, (13, 3): cylinder, piston, right, left, pad."""
    g = leg.geometry
    _, joint, head = joints(leg, p)
    ends = ((vec(g.upper), joint), (p, head), (vec(g.right), joint), (vec(g.left), joint))
    return np.array([a + k * (b - a) for a, b in ends for k in KNOTS] + [p])


def masses(leg: Leg) -> Array:
    """Their masses, kg."""
    rods = (leg.cylinder_mass, leg.piston_mass, leg.secondary_mass, leg.secondary_mass)
    return np.array([m * w for m in rods for w in WEIGHTS] + [leg.pad_mass], np.longdouble)


def speeds(leg: Leg, p: Array, v: Array) -> Array:
    """Velocities of the mass points relative to B, (13, 3)."""
    return slope(lambda k: places(leg, p + k * v))


def absolute_speeds(leg: Leg, p: Array, v: Array, origin: Array, rate: Array) -> Array:
    """Velocities in B's axes when B's origin moves at `origin` and B turns at `rate`."""
    return origin + np.cross(rate, places(leg, p)) + speeds(leg, p, v)


def energy(leg: Leg, p: Array, v: Array, origin: Array, rate: Array) -> np.longdouble:
    """Kinetic energy without the pad's spin, J."""
    u = absolute_speeds(leg, p, v, origin, rate)
    return np.longdouble(0.5) * np.sum(masses(leg) * np.sum(u * u, axis=1))


def momenta(leg: Leg, p: Array, v: Array, origin: Array, rate: Array) -> Array:
    """Momentum and angular momentum about B's origin, B, (6,), without the pad's spin."""
    mu = masses(leg)[:, None] * absolute_speeds(leg, p, v, origin, rate)
    return np.concatenate([mu.sum(axis=0), np.cross(places(leg, p), mu).sum(axis=0)])


def mass_matrix(leg: Leg, p: Array) -> Array:
    """6x6 matrix of the leg frozen at p about B's origin: twist (velocity of the origin, rate) to momenta, B; without the pad's spin."""
    still = np.zeros(3, np.longdouble)
    columns = [momenta(leg, p, still, e[:3], e[3:]) for e in np.eye(6, dtype=np.longdouble)]
    return np.stack(columns, axis=-1)
