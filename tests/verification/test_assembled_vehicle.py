"""Body and legs together, in the twin: conserved momenta in free flight, and the mass properties of Table 1 when the gear is undeformed."""

import leg_points as heap
import numpy as np
import pytest
from apollo_samples import ENGINE_OFF, GRAVITY, INERTIA, MASS, ZUPP, started, vehicle
from lander.laws.blocks import quaternion, vector
from lander.laws.leg import shape
from lander.laws.leg_inertia import Base, accelerated, bias
from lander.laws.leg_reaction import mount_wrench, rigid_wrench
from lander.laws.twin import QX, VX, WX, Engine, Flight, P, Q, V, Vehicle, W, X
from lander.laws.twin_stepping import Settings, integrate, start_accelerations
from lander.laws.vectors import ZERO, rotation

ZUPP_UP = ZUPP._replace(rates=(0.2, -0.3, 0.25))


def totals(craft: Vehicle, flight: Flight) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """First moment, momentum and angular momentum about L's origin (all L), and kinetic energy of the whole vehicle.

    Body: Table 1 as a rigid body with the undeformed gear; legs: mass points where they are less where they would be undeformed.
    """
    x, v, w = (np.array(vector(flight.body, i)) for i in (X, VX, WX))
    turned = np.array(rotation(quaternion(flight.body, QX)))
    own = np.array(craft.body.inertia) @ w
    moment, momentum = MASS * x, MASS * v
    spin = np.cross(x, MASS * v) + turned @ own
    kinetic = 0.5 * MASS * v @ v + 0.5 * w @ own
    origin, rate, still = heap.vec(turned.T @ v), heap.vec(w), heap.vec(ZERO)
    for leg, row in zip(craft.legs, flight.legs, strict=True):
        i = np.array(leg.pad_inertia)
        pad = np.array(rotation(quaternion(row, Q)))
        pad_rate = pad.T @ row[W : W + 3]
        spin += pad @ (i * pad_rate) - turned @ (i * w)
        kinetic += 0.5 * i @ pad_rate**2 - 0.5 * i @ w**2
        for sign, p, dp in ((1.0, heap.vec(row[P : P + 3]), heap.vec(row[V : V + 3])), (-1.0, heap.vec(leg.geometry.pad), still)):
            both = heap.momenta(leg, p, dp, origin, rate).astype(float)
            first = (heap.masses(leg) @ heap.places(leg, p)).astype(float)
            moment = moment + sign * turned @ first
            momentum = momentum + sign * turned @ both[:3]
            spin = spin + sign * (turned @ both[3:] + np.cross(x, turned @ both[:3]))
            kinetic += sign * float(heap.energy(leg, p, dp, origin, rate))
    return moment, momentum, spin, kinetic


def swinging(craft: Vehicle, random: np.random.Generator, rate: float) -> Flight:
    """High above the ground, tumbling, every pad moving and turning at random."""
    flight = started(craft, ZUPP_UP, above=50.0)
    flight.legs[:, V : V + 3] += rate * random.normal(size=(4, 3))
    flight.legs[:, W : W + 3] += random.normal(size=(4, 3))
    return flight


@pytest.mark.parametrize("gravity", [0.0, GRAVITY])
def test_free_flight_keeps_both_momenta(gravity: float, random: np.random.Generator) -> None:
    """Verifies: every force between body, struts, pads has its reaction, moments included; mass moves consistently with momentum.
    Setup: 0.2 s without engine and soil, legs started at 0.5 m/s against the struts, friction and joint damping working; momenta
    from mass points; with gravity the laws P(t) = P - M g t x̂, S(t) = S + P t - ½ M g t² x̂, H(t) = H - g ∫ S dt x x̂ in closed form.
    Tolerance: 1e-9 of M 1 m/s and 1e-8 of M 1 m2/s; found 1e-11 and 5e-10 at the twin's tolerance 1e-8, 7e-10 and 4e-8 at 1e-5.
    """
    craft = vehicle(gravity=gravity)
    flight = swinging(craft, random, 0.5)
    first, momentum, spin, energy = totals(craft, flight)
    a, ledger, touch = np.zeros((5, 6)), np.zeros((5, 4)), -np.ones(4)
    assert start_accelerations(craft, ENGINE_OFF, flight, a)
    t = 0.2
    assert integrate(craft, ENGINE_OFF, Settings(1e-8, 5e-4, 1e-6), flight, a, ledger, touch, 0.0, t).ok
    now = totals(craft, flight)
    up = np.array([1.0, 0.0, 0.0])
    pull = -MASS * gravity * up
    np.testing.assert_allclose(now[1], momentum + t * pull, rtol=0.0, atol=1e-9 * MASS)
    np.testing.assert_allclose(now[0], first + t * momentum + 0.5 * t * t * pull, rtol=0.0, atol=1e-9 * MASS)
    path = first * t + momentum * t * t / 2 + pull * t**3 / 6
    np.testing.assert_allclose(now[2], spin + np.cross(path, -gravity * up), rtol=0.0, atol=1e-8 * MASS)
    assert touch.max() < 0.0
    if gravity == 0.0:
        assert now[3] - energy == pytest.approx(ledger[1:, 1:3].sum(), rel=1e-4)
        assert now[3] < energy - 1.0


def test_the_assembled_vehicle_has_the_mass_properties_of_table_1(random: np.random.Generator) -> None:
    """Verifies: the body's own mass matrix (Table 1 less its legs', by Gauss points) plus what the legs put on it is Table 1's, all 6x6.
    Setup: unit accelerations in turn, gear undeformed and locked (p'' = 0): the force that the leg really puts on the body is the
    mount's less the rigid leg's; the body needs M_own a minus that.
    Tolerance: 1e-9 of the largest element.
    """
    craft = vehicle()
    table = np.zeros((6, 6))
    table[:3, :3], table[3:, 3:] = MASS * np.eye(3), np.diag(INERTIA)
    own = table.copy()
    for leg in craft.legs:
        own -= heap.mass_matrix(leg, heap.vec(leg.geometry.pad)).astype(float)
        own[3:, 3:] -= np.diag(leg.pad_inertia)
    assembled = np.zeros((6, 6))
    for column, unit in enumerate(np.eye(6)):
        base = Base(tuple(unit[:3].tolist()), ZERO, tuple(unit[3:].tolist()))
        assembled[:, column] = own @ unit
        for leg in craft.legs:
            p = leg.geometry.pad
            at = shape(leg, p, ZERO)
            nodes = accelerated(leg, at, bias(leg, base, at, p, ZERO), ZERO)
            ball = tuple((np.array(leg.pad_inertia) * base.spin_up).tolist())
            on_body = np.concatenate(mount_wrench(leg, base, p, at, nodes, ZERO, ball)) - np.concatenate(rigid_wrench(leg, base))
            assembled[:, column] -= on_body
    np.testing.assert_allclose(assembled, table, atol=1e-9 * table.max())
    assert np.linalg.eigvalsh(own).min() > 0.0


def test_a_pushed_vehicle_with_stiff_gear_accelerates_as_table_1() -> None:
    """Verifies: the same through the twin's own equations: F = M a and τ = I ω' once the struts carry the gear along.
    Setup: no gravity; constant thrust and torque for 0.15 s; mean accelerations from the whole vehicle's momenta against the impulse.
    Tolerance: 1e-6 relative, as in free flight; H about L's origin takes the thrust's moment through the path of the body's origin.
    """
    craft = vehicle(gravity=0.0)
    flight = started(craft, ZUPP._replace(velocity=ZERO, rates=ZERO, yaw=0.0, pitch=0.0, roll=0.0), above=50.0)
    flight.body[X : X + 3] = 50.0, 0.0, 0.0
    force, torque = (3000.0, 200.0, -100.0), (800.0, 0.0, 0.0)
    engine = Engine(force, torque, ZERO, ZERO)
    a, ledger, touch = np.zeros((5, 6)), np.zeros((5, 4)), -np.ones(4)
    start_accelerations(craft, engine, flight, a)
    _, momentum, spin, energy = totals(craft, flight)
    applied = np.zeros(6)
    for k in range(30):
        before = np.array(rotation(quaternion(flight.body, QX))), flight.body[X : X + 3].copy()
        assert integrate(craft, engine, Settings(1e-8, 5e-4, 1e-6), flight, a, ledger, touch, 5e-3 * k, 5e-3).ok
        after = np.array(rotation(quaternion(flight.body, QX))), flight.body[X : X + 3].copy()
        for r, x in (before, after):
            applied += 2.5e-3 * np.concatenate([r @ force, np.cross(x, r @ force) + r @ torque])
    now = totals(craft, flight)
    np.testing.assert_allclose(now[1] - momentum, applied[:3], atol=1e-5 * np.linalg.norm(applied[:3]))
    np.testing.assert_allclose(now[2] - spin, applied[3:], atol=1e-5 * np.linalg.norm(applied[3:]))
    assert now[3] - energy == pytest.approx(ledger.sum(), rel=1e-3)
    assert flight.body[VX] == pytest.approx(3000.0 / MASS * 0.15, rel=2e-2)
