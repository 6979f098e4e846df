"""The leg's equations against Lagrange's and Newton's for a heap of mass points (`leg_points`), its tangents against differences.

The leg's own law knows consistent mass matrices and minimal coordinates; the reference knows where mass points are and differentiates.
"""

from typing import NamedTuple

import leg_points as heap
import numpy as np
import pytest
from apollo_samples import AZIMUTHS, leg_at
from lander.laws.base_motion import BaseState
from lander.laws.interface import leg_energy
from lander.laws.leg import Crush, Leg, Shape, bottomed, crushed, leg_mass, rigid_inertia, shape, strokes, strut_loads
from lander.laws.leg_dynamics import Motion, leg_motion, mobility, tangents
from lander.laws.leg_inertia import Base, Nodes, accelerated, axial_mass, bias, first_moment, lateral_mass, nodal_inertia
from lander.laws.leg_joints import ball_torque, joint_damping
from lander.laws.leg_reaction import mount_wrench, rigid_wrench
from lander.laws.leg_stepping import LegState
from lander.laws.vectors import ZERO, Vector, from_rotation_vector, rotation

DRY = {"bearing": 0.0}
INSTANT = np.longdouble(2e-5)  # s, for differences along the path: accelerations reach 1e4 m/s2
VIRGIN = Crush(1e-3, 1e-3, 1e-3, 1e-3, 1e-3)


class Case(NamedTuple):
    """A leg somewhere in its working range on an arbitrarily moving base, pushed at the pad."""

    leg: Leg
    p: np.ndarray
    v: np.ndarray
    base: Base
    origin: np.ndarray  # velocity of B's origin, B
    force: np.ndarray
    ball: np.ndarray
    crush: Crush

    def motion(self) -> Motion:
        """What the law says."""
        return leg_motion(self.leg, self.base, triple(self.p), triple(self.v), triple(self.force), triple(self.ball), self.crush)


def triple(x: object) -> Vector:
    """Plain floats for the law."""
    a, b, c = x
    return (float(a), float(b), float(c))


def case(random: np.random.Generator, **changes: object) -> Case:
    """Random azimuth, strokes inside the stops, rates of 1 m/s and 1 rad/s; cores in their elastic bands."""
    leg = leg_at(random.uniform(-3.0, 3.0), **changes)
    up = (np.array(leg.geometry.upper) - leg.geometry.pad) / leg.geometry.length
    p = np.array(leg.geometry.pad) + random.uniform(0.01, 0.2) * up + 0.12 * np.cross(up, random.uniform(-1.0, 1.0, 3))
    reached = crushed(leg, triple(p), VIRGIN)
    crush = Crush(*(d + random.uniform(0.0, 8e-4) for d in reached))
    base = Base(*(triple(scale * random.normal(size=3)) for scale in (3.0, 1.0, 5.0)))
    v, origin, force, ball = (scale * random.normal(size=3) for scale in (1.0, 1.0, 5e3, 50.0))
    return Case(leg, p, v, base, origin, force, ball, crush)


def lengths(leg: Leg, p: heap.Array) -> heap.Array:
    """Lengths of primary, right and left from the joints."""
    _, joint, _ = heap.joints(leg, p)
    g = leg.geometry
    return np.array([np.sqrt(np.sum(d * d)) for d in (p - heap.vec(g.upper), joint - heap.vec(g.right), joint - heap.vec(g.left))])


def joint_rates(leg: Leg, p: heap.Array, v: heap.Array) -> heap.Array:
    """Rates of all damped joints but the ball joint: three sliding; turning of the primary at U, of each secondary at both ends."""
    axis = heap.joints(leg, p)[0]
    spin = np.cross(axis, heap.slope(lambda k: heap.joints(leg, p + k * v)[0]))
    rates = [*heap.slope(lambda k: lengths(leg, p + k * v)), *spin]
    for truss in (leg.geometry.right, leg.geometry.left):

        def rod(q: heap.Array, truss: Vector = truss) -> heap.Array:
            d = heap.joints(leg, q)[1] - heap.vec(truss)
            return d / np.sqrt(np.sum(d * d))

        u = rod(p)
        turn = np.cross(u, heap.slope(lambda k, rod=rod: rod(p + k * v)))
        bend = turn - (spin - u * (u @ spin))  # the cylinder's turn about the rod is not felt
        rates += [*turn, *bend]
    return np.array(rates)


def generalised(c: Case, loads: tuple[float, float, float], p: heap.Array, v: heap.Array) -> heap.Array:
    """Force on p by virtual work of axial loads (primary pushes, secondaries pull) and of the joints' Rayleigh function ½ c Σ rate²."""
    stretch = heap.gradient(lambda q: lengths(c.leg, q), p)
    struts = stretch.T @ heap.vec((loads[0], -loads[1], -loads[2]))
    rates = heap.gradient(lambda u: joint_rates(c.leg, p, u), v)
    return struts - c.leg.joint_damping * rates.T @ (rates @ v)


def path(c: Case, a: heap.Array, t: heap.Array) -> tuple[heap.Array, heap.Array, heap.Array, heap.Array]:
    """p, p', velocity of the origin and rate at t; gravity is in `pull`: the base falls up in a frame without it."""
    p, v, rate, spin = heap.vec(c.p), heap.vec(c.v), heap.vec(c.base.rate), heap.vec(c.base.spin_up)
    drift = heap.vec(c.base.pull) - np.cross(rate, heap.vec(c.origin))  # of the origin's velocity in B's axes
    return p + t * v + t * t * a / 2, v + t * a, heap.vec(c.origin) + t * drift, rate + t * spin


def impulse(leg: Leg, p: heap.Array, v: heap.Array, origin: heap.Array, rate: heap.Array) -> heap.Array:
    """∂T/∂p'; T is quadratic in p', so that the difference is exact."""
    return heap.gradient(lambda u: heap.energy(leg, p, u, origin, rate), v)


@pytest.mark.parametrize("trial", range(6))
def test_lagranges_equations_hold(trial: int) -> None:
    """Verifies: p'' of `leg_motion`: inertia of all rods, Coriolis and centrifugal terms, struts, joints, ball joint, bearing friction.
    Setup: d/dt ∂T/∂p' - ∂T/∂p = Q with T of 13 Gauss points, velocities by differences, all along the path that the law's p'' starts;
    random leg, base motion, loads. Q: virtual work of the axial loads the law reports, Rayleigh's function, pad force, ball torque.
    Tolerance: 1e-6 N of forces of 1e4 N: three nested five-point differences in extended precision.
    """
    c = case(np.random.default_rng(trial))
    law = c.motion()
    a = heap.vec(law.acceleration)
    momentum_rate = heap.slope(lambda t: impulse(c.leg, *path(c, a, t)), INSTANT)
    p, v, origin, rate = path(c, a, np.longdouble(0))
    pull = heap.gradient(lambda q: heap.energy(c.leg, q, v, origin, rate), p)
    loads = (law.primary, law.right, law.left)
    swing = heap.gradient(lambda u: np.cross(heap.joints(c.leg, p)[0], heap.slope(lambda k: heap.joints(c.leg, p + k * u)[0])), v)
    q = generalised(c, loads, p, v) + heap.vec(c.force) - swing.T @ heap.vec(c.ball)
    np.testing.assert_allclose((momentum_rate - pull).astype(float), q.astype(float), atol=1e-6)
    internal = generalised(c, loads, p, v) @ v
    assert law.power == pytest.approx(float(internal), rel=1e-8)


def wall_force(c: Case, a: heap.Array) -> float:
    """What the cylinder must put across the piston: inertia of piston and pad less the pad's force, across the primary, N."""
    weights = heap.masses(c.leg)[3:].copy()
    weights[3:9] = 0.0  # the secondaries' points: piston and pad remain

    def momentum(t: np.longdouble) -> heap.Array:
        u = heap.absolute_speeds(c.leg, *path(c, a, t))[3:]
        return (weights[:, None] * u).sum(axis=0)

    rate = heap.vec(c.base.rate)
    inertia = heap.slope(momentum, INSTANT) + np.cross(rate, momentum(np.longdouble(0)))
    axis = heap.joints(c.leg, heap.vec(c.p))[0]
    push = inertia - heap.vec(c.force)
    return float(np.linalg.norm((push - axis * (axis @ push)).astype(float)))


@pytest.mark.parametrize("trial", range(6))
def test_bearing_friction_of_the_primary_follows_its_wall_force(trial: int) -> None:
    """Verifies: F = μ_B |wall| tanh(v/v_b) with the wall force of the true motion; it opposes the stroke.
    Setup: rate of change of the momentum of piston and pad along the law's own path, pad force taken off.
    Tolerance: 1e-8 relative.
    """
    c = case(np.random.default_rng(100 + trial))
    law = c.motion()
    closing = -float(shape(c.leg, triple(c.p), triple(c.v)).stretch)
    friction = law.primary - law.loads.primary.force
    assert friction == pytest.approx(0.23 * wall_force(c, heap.vec(law.acceleration)) * np.tanh(closing / 1e-2), rel=1e-8)
    assert friction * closing > 0.0


@pytest.mark.parametrize("trial", range(6))
def test_bearing_friction_of_the_secondaries_is_that_of_their_swinging_ends(trial: int) -> None:
    """Verifies: wall force of a secondary: what its inertia puts across its end at the connection, m/6 (2 a_C + a_T); it opposes the rate.
    Setup: nodes' accelerations by the law (checked by Lagrange and d'Alembert here), moment about the truss by Gauss points.
    Tolerance: 5 % of the friction: the law takes the wall force before friction changes p'' (5 kg beside 30 kg); and 2 N of small ones.
    """
    c = case(np.random.default_rng(200 + trial))
    law, at = c.motion(), shape(c.leg, triple(c.p), triple(c.v))
    for u, truss, load, before in (
        (at.right, law.nodes.right, law.right, law.loads.right.force),
        (at.left, law.nodes.left, law.left, law.loads.left.force),
    ):
        ends = np.array(truss), np.array(law.nodes.joint)
        moment = sum(5.12 * w * k * (ends[0] + k * (ends[1] - ends[0])) for k, w in zip(heap.KNOTS, heap.WEIGHTS, strict=True))
        across = np.asarray(moment - np.array(u) * (np.array(u) @ moment), float)
        rate = np.dot(u, at.joint_velocity)
        assert load - before == pytest.approx(0.23 * np.linalg.norm(across) * np.tanh(rate / 1e-2), rel=0.05, abs=2.0)
        assert (load - before) * rate > 0.0


def momenta_rate(c: Case, a: heap.Array) -> np.ndarray:
    """Force and moment about B's origin that the leg's mass points need along the path, gravity taken off, B."""
    still = np.longdouble(0)
    rate, origin = heap.vec(c.base.rate), heap.vec(c.origin)
    now = heap.momenta(c.leg, *path(c, a, still))
    change = heap.slope(lambda t: heap.momenta(c.leg, *path(c, a, t)), INSTANT)
    force = change[:3] + np.cross(rate, now[:3])
    moment = change[3:] + np.cross(rate, now[3:]) + np.cross(origin, now[:3])
    return np.concatenate([force, moment]).astype(float)


@pytest.mark.parametrize("trial", range(6))
def test_the_mounts_wrench_is_the_rate_of_change_of_momentum(trial: int) -> None:
    """Verifies: `mount_wrench` (less the rigid leg's share) = what acts on the pad less the leg's rate of momentum and of angular momentum.
    Setup: differences of the mass points' momenta along the law's path on the moving base; the pad's spin acts through `ball` alone.
    Tolerance: 1e-6 N and N m of 1e4.
    """
    c = case(np.random.default_rng(300 + trial))
    law, p = c.motion(), triple(c.p)
    at = shape(c.leg, p, triple(c.v))
    on_body = np.concatenate(mount_wrench(c.leg, c.base, p, at, law.nodes, triple(c.force), triple(c.ball)))
    on_body -= np.concatenate(rigid_wrench(c.leg, c.base))
    applied = np.concatenate([c.force, np.cross(c.p, c.force) - c.ball])
    np.testing.assert_allclose(on_body, applied - momenta_rate(c, heap.vec(law.acceleration)), atol=1e-6)


@pytest.mark.parametrize("azimuth", AZIMUTHS.values())
def test_the_rigid_legs_wrench_is_its_mass_properties(azimuth: float, random: np.random.Generator) -> None:
    """Verifies: `rigid_wrench`, `leg_mass`, `first_moment` from the undeformed leg's mass properties, the pad's spin included.
    Setup: 6x6 mass matrix M of 13 Gauss points plus the pad's disc; wrench M a + bias of a rigid body.
    Tolerance: 1e-9 relative.
    """
    leg = leg_at(azimuth)
    base = Base(*(triple(random.normal(size=3)) for _ in range(3)))
    matrix = heap.mass_matrix(leg, heap.vec(leg.geometry.pad)).astype(float)
    matrix[3:, 3:] += np.diag(leg.pad_inertia)
    mass, moment, inertia = matrix[0, 0], np.array([matrix[5, 1], matrix[3, 2], matrix[4, 0]]), matrix[3:, 3:]
    w, spin, pull = (np.array(x) for x in (base.rate, base.spin_up, base.pull))
    force = mass * pull + np.cross(spin, moment) + np.cross(w, np.cross(w, moment))
    torque = np.cross(moment, pull) + inertia @ spin + np.cross(w, inertia @ w)
    np.testing.assert_allclose(np.concatenate(rigid_wrench(leg, base)), np.concatenate([force, torque]), rtol=1e-9, atol=1e-9)
    assert leg_mass(leg) == pytest.approx(mass, rel=1e-12)
    at = shape(leg, leg.geometry.pad, ZERO)
    np.testing.assert_allclose(first_moment(leg, undeformed(leg, at)), moment, rtol=1e-9, atol=1e-9)


def undeformed(leg: Leg, at: Shape) -> Nodes:
    """The leg's points as the law's record."""
    g = leg.geometry
    return Nodes(g.upper, at.joint, g.pad, at.head, g.right, g.left)


@pytest.mark.parametrize("azimuth", AZIMUTHS.values())
def test_the_rigid_legs_inertia_is_what_its_nodes_feel(azimuth: float) -> None:
    """Verifies: rigid_inertia, by which a vehicle lighter than its legs is refused, against the law's own nodal inertia.
    Setup: the undeformed leg turned about B's origin at 1 rad/s2 about each axis; moments of the nodes' forces, and the disc.
    Tolerance: rounding, 1e-9 of kg m2.
    """
    leg = leg_at(azimuth)
    g = leg.geometry
    upper, pad = np.array(g.upper), np.array(g.pad)
    axis = (pad - upper) / np.linalg.norm(pad - upper)
    nodes = [upper, upper + g.cylinder * axis, pad, pad - g.piston * axis, np.array(g.right), np.array(g.left)]
    for k, turn in enumerate(np.eye(3)):
        forces = nodal_inertia(leg, Nodes(*(tuple(np.cross(turn, r).tolist()) for r in nodes)))
        moment = sum(np.cross(r, force) for r, force in zip(nodes, forces, strict=True)) + np.array(leg.pad_inertia) * turn
        assert rigid_inertia(leg)[:, k] == pytest.approx(moment, abs=1e-9)


def test_the_leg_at_rest_on_the_body_returns_nothing_to_it(random: np.random.Generator) -> None:
    """Verifies: what the mount reports is the difference to the rigid leg: with p'' = p' = 0 and the pad turned along it is zero.
    Setup: nodes accelerated rigidly, ball torque that turns the pad with the body.
    Tolerance: 1e-9 N.
    """
    leg = leg_at(0.7)
    base = Base(*(triple(random.normal(size=3)) for _ in range(3)))
    p = leg.geometry.pad
    at = shape(leg, p, ZERO)
    nodes = accelerated(leg, at, bias(leg, base, at, p, ZERO), ZERO)
    i = np.array(leg.pad_inertia)
    ball = i * base.spin_up + np.cross(base.rate, i * np.array(base.rate))
    wrench = np.concatenate(mount_wrench(leg, base, p, at, nodes, ZERO, triple(ball)))
    np.testing.assert_allclose(wrench, 0.0, atol=1e-9)


@pytest.mark.parametrize("trial", range(4))
def test_mobility_is_the_answer_to_a_force(trial: int) -> None:
    """Verifies: Y: p'' by a force at the ball joint; and its two masses.
    Setup: difference of two solutions, bearing dry: the law is linear in the force then.
    Tolerance: 1e-9 relative.
    """
    c = case(np.random.default_rng(400 + trial), **DRY)
    push = np.array([300.0, -200.0, 500.0])
    at = shape(c.leg, triple(c.p), triple(c.v))
    change = np.array(c._replace(force=c.force + push).motion().acceleration) - c.motion().acceleration
    np.testing.assert_allclose(np.array(mobility(c.leg, at)) @ push, change, rtol=1e-8, atol=1e-9)
    assert axial_mass(c.leg) == pytest.approx(13.6 + 11.0, rel=1e-14)
    matrix = heap.gradient(lambda u: impulse(c.leg, heap.vec(c.p), u, heap.vec(ZERO), heap.vec(ZERO)), heap.vec(c.v)).astype(float)
    expected = sorted([axial_mass(c.leg), lateral_mass(c.leg, at), lateral_mass(c.leg, at)])
    np.testing.assert_allclose(np.linalg.eigvalsh(matrix), expected, rtol=1e-10)


@pytest.mark.parametrize("trial", range(4))
def test_tangents_of_the_struts(trial: int) -> None:
    """Verifies: -dQ/dp and -dQ/dv, material and geometric, all damping, which Newton and the reduced interface model take.
    Setup: Q by virtual work of `strut_loads` and Rayleigh's function, differentiated at p' = 0, where -dQ/dp has no rate terms, with
    cores in their bands, where they are smooth.
    Tolerance: 1e-5 of the largest element.
    """
    c = case(np.random.default_rng(500 + trial), **DRY)

    def q(p: np.ndarray, v: np.ndarray) -> np.ndarray:
        loads = strut_loads(c.leg, shape(c.leg, triple(p), triple(v)), c.crush)
        still = c._replace(p=p, v=v)
        return generalised(still, (loads.primary.force, loads.right.force, loads.left.force), heap.vec(p), heap.vec(v)).astype(float)

    def minus_slope(f: object, step: float) -> np.ndarray:
        columns = [(8 * (f(step * e) - f(-step * e)) - (f(2 * step * e) - f(-2 * step * e))) / (12 * step) for e in np.eye(3)]
        return -np.array(columns).T

    still = np.zeros(3)
    at = shape(c.leg, triple(c.p), ZERO)
    loads = strut_loads(c.leg, at, c.crush)
    stiffness, damping = (np.array(m) for m in tangents(c.leg, at, loads, 0.0, joint_damping(c.leg, at)))
    found = minus_slope(lambda d: q(c.p + d, still), 1e-6)
    np.testing.assert_allclose(stiffness, found, atol=1e-5 * np.abs(found).max())
    found = minus_slope(lambda d: q(c.p, d), 1e-5)
    np.testing.assert_allclose(damping, found, atol=1e-5 * np.abs(found).max())
    own = np.array(joint_damping(c.leg, at))
    rates = heap.gradient(lambda u: joint_rates(c.leg, heap.vec(c.p), u), heap.vec(ZERO)).astype(float)
    np.testing.assert_allclose(own, 100.0 * rates.T @ rates, rtol=1e-7, atol=1e-6)
    assert np.linalg.eigvalsh(own).min() > 0.0


def test_strokes_memories_and_stops(random: np.random.Generator) -> None:
    """Verifies: signs and sizes of the three strokes; memories only grow; `bottomed` at each of the five ends.
    Setup: lengths from the joints; moves along the primary and sideways.
    Tolerance: 1e-12.
    """
    leg = leg_at(0.0)
    g = leg.geometry
    for _ in range(5):
        p = np.array(g.pad) + random.uniform(-0.15, 0.15, 3)
        primary, right, left = strokes(leg, triple(p))
        expected = lengths(leg, heap.vec(p)).astype(float)
        np.testing.assert_allclose((g.length - primary, g.right_length + right, g.left_length + left), expected, rtol=1e-12)
    pushed = np.array(g.pad) + 0.1 * (np.array(g.upper) - g.pad) / g.length
    assert strokes(leg, triple(pushed))[0] == pytest.approx(0.1, rel=1e-12)
    sideways = (g.pad[0], g.pad[1] - 0.1, g.pad[2])  # to the left of the forward leg: the right secondary lengthens
    _, right, left = strokes(leg, sideways)
    assert right > 0.04
    assert left < -0.02
    memory = crushed(leg, sideways, VIRGIN)
    assert memory.right_tension == right
    assert memory.left_compression == -left
    assert memory.left_tension == memory.right_compression == 1e-3
    assert crushed(leg, g.pad, memory) == memory
    ends = [(0.813, 0.0, 0.0), (0.0, 0.408, 0.0), (0.0, -0.306, 0.0), (0.0, 0.0, 0.408), (0.0, 0.0, -0.306)]
    assert all(bottomed(leg, *end) for end in ends)
    assert not bottomed(leg, 0.811, 0.406, -0.304)


def test_the_ball_joint_drags_the_pad_along_with_the_piston(random: np.random.Generator) -> None:
    """Verifies: torque -c (ω_pad - ω_piston); the piston turns with the body and with the primary's swing.
    Setup: the swing from differences of the primary's direction.
    Tolerance: 1e-9.
    """
    c = case(random)
    axis = heap.joints(c.leg, heap.vec(c.p))[0]
    swing = np.cross(axis, heap.slope(lambda k: heap.joints(c.leg, heap.vec(c.p) + k * heap.vec(c.v))[0])).astype(float)
    pad_rate = random.normal(size=3)
    expected = -100.0 * (pad_rate - np.array(c.base.rate) - swing)
    at = shape(c.leg, triple(c.p), triple(c.v))
    np.testing.assert_allclose(ball_torque(c.leg, c.base, at, triple(pad_rate)), expected, rtol=1e-9)


def test_the_legs_energy_is_that_of_its_points_less_the_rigid_legs(random: np.random.Generator) -> None:
    """Verifies: `leg_energy`, kinetic with the pad's spin, and potential m g x.
    Setup: 13 Gauss points, deformed less undeformed.
    Tolerance: 1e-9 relative.
    """
    c = case(random)
    attitude, pad_rate = from_rotation_vector((0.2, 0.4, -0.3)), random.normal(size=3)
    turned = np.array(rotation(attitude))
    base = BaseState((1.0, 2.0, 3.0), attitude, triple(turned @ c.origin), c.base.rate, ZERO, ZERO)
    state = LegState(triple(c.p), triple(c.v), (1.0, 0.0, 0.0, 0.0), triple(pad_rate), VIRGIN)
    kinetic, potential = leg_energy(c.leg, 1.63, base, state)
    i, rate = np.array(c.leg.pad_inertia), np.array(c.base.rate)
    pad, still = heap.vec(c.leg.geometry.pad), heap.vec(ZERO)
    now = heap.energy(c.leg, heap.vec(c.p), heap.vec(c.v), heap.vec(c.origin), heap.vec(rate))
    rigid = heap.energy(c.leg, pad, still, heap.vec(c.origin), heap.vec(rate))
    spin = 0.5 * i @ pad_rate**2 - 0.5 * i @ rate**2
    assert kinetic == pytest.approx(float(now - rigid) + spin, rel=1e-9)
    shift = heap.masses(c.leg) @ (heap.places(c.leg, heap.vec(c.p)) - heap.places(c.leg, pad))
    assert potential == pytest.approx(1.63 * turned[0] @ shift.astype(float), rel=1e-9)
