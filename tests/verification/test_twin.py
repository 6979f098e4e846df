"""The monolithic twin's integrator against scipy's Radau on the same equations, its convergence, and the energy of a whole landing."""

import numpy as np
import pytest
from apollo_samples import ADAMS_SOIL, ENGINE_OFF, GRAVITY, started, vehicle
from lander.laws.blocks import quaternion
from lander.laws.soil import RATE_INDEPENDENT
from lander.laws.twin import BODY_COLUMNS, CRUSH, QX, VX, WX, Engine, Flight, P, Q, V, Vehicle, W, X
from lander.laws.twin_stepping import Settings, copied, integrate, start_accelerations
from lander.laws.vectors import ZERO, rotation
from scipy.integrate import solve_ivp
from test_assembled_vehicle import swinging, totals

THRUST = Engine((5000.0, 0.0, 0.0), (100.0, -50.0, 30.0), (-5000.0, 0.0, 0.0), ZERO)
LANDING_ENGINE = Engine((5000.0, 0.0, 0.0), ZERO, (-5000.0, 0.0, 0.0), ZERO)


def flown(craft: Vehicle, engine: Engine, flight: Flight, t: float, interval: float, tolerance: float, longest: float = 1e-3) -> Flight:
    """A copy of the flight, integrated."""
    end = copied(flight)
    a = np.zeros((5, 6))
    assert start_accelerations(craft, engine, end, a)
    assert integrate(craft, engine, Settings(tolerance, longest, 1e-6), end, a, np.zeros((5, 4)), -np.ones(4), t, interval).ok
    return end


def turned(q: np.ndarray, rate: np.ndarray, local: bool) -> np.ndarray:
    """q' = ½ q ω (ω in the turning axes) or ½ ω q (in L)."""
    w, v = q[0], q[1:]
    sign = -1.0 if local else 1.0
    return 0.5 * np.concatenate([[-v @ rate], w * rate + sign * np.cross(v, rate)])


def radau(craft: Vehicle, engine: Engine, flight: Flight, interval: float) -> Flight:
    """The same by scipy with all memories as they are at the start; accelerations from the twin's law at each instant."""
    trial, a = copied(flight), np.zeros((5, 6))

    def motion(t: float, y: np.ndarray) -> np.ndarray:
        trial.body[:], trial.legs[:, :CRUSH] = y[:BODY_COLUMNS], y[BODY_COLUMNS:].reshape(4, CRUSH)
        for row, i in [(trial.body, QX), *((leg, Q) for leg in trial.legs)]:
            row[i : i + 4] /= np.linalg.norm(row[i : i + 4])
        force = tuple((np.array(engine.force) + t * np.array(engine.force_slope)).tolist())
        assert start_accelerations(craft, engine._replace(force=force), trial, a)
        r = np.array(rotation(quaternion(trial.body, QX)))
        body, legs = np.zeros(BODY_COLUMNS), np.zeros((4, CRUSH))
        body[X : X + 3], body[VX : VX + 3] = trial.body[VX : VX + 3], a[0, :3] - [GRAVITY, 0.0, 0.0]
        body[QX : QX + 4] = turned(trial.body[QX : QX + 4], trial.body[WX : WX + 3], local=False)
        body[WX : WX + 3] = r.T @ a[0, 3:]
        for i, leg in enumerate(trial.legs):
            legs[i, P : P + 3], legs[i, V : V + 3] = leg[V : V + 3], r.T @ a[1 + i, :3]
            legs[i, Q : Q + 4] = turned(leg[Q : Q + 4], leg[W : W + 3], local=True)
            legs[i, W : W + 3] = a[1 + i, 3:]
        return np.concatenate([body, legs.ravel()])

    start = np.concatenate([flight.body, flight.legs[:, :CRUSH].ravel()])
    run = solve_ivp(motion, (0.0, interval), start, method="Radau", rtol=1e-8, atol=1e-10)
    end = copied(flight)
    end.body[:], end.legs[:, :CRUSH] = run.y[:BODY_COLUMNS, -1], run.y[BODY_COLUMNS:, -1].reshape(4, CRUSH)
    return end


def misses(a: Flight, b: Flight) -> tuple[float, float]:
    """Largest difference in body and in legs; quaternions up to sign."""
    for row, other, i in [(a.body, b.body, QX), *((x, y, Q) for x, y in zip(a.legs, b.legs, strict=True))]:
        row[i : i + 4] *= np.sign(row[i : i + 4] @ other[i : i + 4])
    return float(np.abs(a.body - b.body).max()), float(np.abs(a.legs[:, :CRUSH] - b.legs[:, :CRUSH]).max())


def test_free_flight_within_the_elastic_bands_against_radau(random: np.random.Generator) -> None:
    """Verifies: `integrate`: translation, rotation, legs and pads, thrust with slope.
    Setup: 50 ms, tumbling at 0.3 rad/s with thrust and torque, pads moving at 0.02 m/s: strokes stay within the virgin band (asserted), so
    that nothing latches and the equations are smooth, though stiff (4e4 1/s).
    Tolerance: 1e-6 on m, m/s, rad/s of both; twin at tolerance 1e-8.
    """
    craft = vehicle()
    flight = swinging(craft, random, 0.02)
    exact = radau(craft, THRUST, flight, 0.05)
    ours = flown(craft, THRUST, flight, 0.0, 0.05, 1e-8)
    assert np.array_equal(ours.legs[:, CRUSH:], flight.legs[:, CRUSH:])
    body, legs = misses(ours, exact)
    assert body < 1e-6
    assert legs < 1e-5


def test_a_stretch_on_the_ground_against_radau() -> None:
    """Verifies: the same with soil, friction and plowing in the balance.
    Setup: Zupp-like start, rate-independent soil with Adams-like damping; 30 ms of it from 20 ms after first contact: two points of one
    pad keep sinking (asserted) and no strut crushes (asserted), so that Radau needs no memory of its own.
    Tolerance: 1e-6 on the body, 1e-5 on the legs (m, m/s, rad/s); twin at tolerance 1e-8.
    """
    craft = vehicle(soil=ADAMS_SOIL._replace(law=RATE_INDEPENDENT))
    flight = flown(craft, LANDING_ENGINE, started(craft), 0.0, 0.02, 1e-7)
    exact = radau(craft, LANDING_ENGINE, flight, 0.03)
    ours = flown(craft, LANDING_ENGINE, flight, 0.0, 0.03, 1e-8, 1e-4)
    wet = flight.memory[:, :, 7] > 0.0
    assert wet.sum() == 2
    assert np.array_equal(wet, ours.memory[:, :, 7] > 0.0)
    np.testing.assert_array_equal(ours.memory[wet][:, 0], ours.memory[wet][:, 7])
    np.testing.assert_array_equal(ours.legs[:, CRUSH:], flight.legs[:, CRUSH:])
    body, legs = misses(ours, exact)
    assert body < 1e-6
    assert legs < 1e-5


def test_an_interval_that_needs_too_many_steps_is_given_up() -> None:
    """Verifies: a stretch at a tolerance that no step keeps ends, and says that it failed.
    Setup: 1 ms on the ground at 1e-30 m/s: every step would be 1 ns long, and the interval a million of them.
    Tolerance: the steps allowed, 2000 and half a million a second, and the one that was too many.
    """
    craft = vehicle()
    flight = started(craft)
    a = np.zeros((5, 6))
    start_accelerations(craft, ENGINE_OFF, flight, a)
    progress = integrate(craft, ENGINE_OFF, Settings(1e-30, 1e-3, 1e-6), flight, a, np.zeros((5, 4)), -np.ones(4), 0.0, 1e-3)
    assert not progress.ok
    assert progress.steps + progress.rejected == 2501


def test_starting_accelerations_stand_still(random: np.random.Generator) -> None:
    """Verifies: the accelerations at the start solve the equations to the end, with legs in motion.
    Setup: change of the twin's velocities over 0.1 microseconds against them.
    Tolerance: 2 % of the largest: struts of rate 4e4 1/s change their forces by 0.4 % in that time (found 0.8 %).
    """
    craft = vehicle()
    flight = swinging(craft, random, 0.1)
    a = np.zeros((5, 6))
    assert start_accelerations(craft, ENGINE_OFF, flight, a)
    h = 1e-7
    end = flown(craft, ENGINE_OFF, flight, 0.0, h, 1.0, h)
    r = np.array(rotation(quaternion(flight.body, QX)))
    body = np.concatenate([(end.body - flight.body)[VX : VX + 3] / h + [GRAVITY, 0.0, 0.0], r @ (end.body - flight.body)[WX : WX + 3] / h])
    np.testing.assert_allclose(body, a[0], atol=0.02 * np.abs(a[0]).max())
    legs = (end.legs - flight.legs)[:, V : V + 3] @ r.T / h
    np.testing.assert_allclose(legs, a[1:, :3], atol=0.02 * np.abs(a[1:]).max())


def landed(tolerance: float, interval: float) -> tuple[Flight, np.ndarray, float]:
    """A Zupp-like landing: the end, the ledger (5, 4), and the energy gained."""
    craft = vehicle()
    flight = started(craft)
    a, ledger, touch = np.zeros((5, 6)), np.zeros((5, 4)), -np.ones(4)
    energies = [energy(craft, flight)]
    assert start_accelerations(craft, LANDING_ENGINE, flight, a)
    first, count = 1e-5, round(interval / 0.01)
    for k in range(count):
        force, slope = (5000.0 * max(0.0, 1.0 - 0.01 * k), 0.0, 0.0), (-5000.0 if k < 100 else 0.0, 0.0, 0.0)
        settings = Settings(tolerance, 5e-3, first)
        progress = integrate(craft, Engine(force, ZERO, slope, ZERO), settings, flight, a, ledger, touch, 0.01 * k, 0.01)
        assert progress.ok
        first = progress.next_step
    energies.append(energy(craft, flight))
    return flight, ledger, energies[1] - energies[0]


def energy(craft: Vehicle, flight: Flight) -> float:
    """Kinetic and potential energy of the whole vehicle by mass points, J."""
    moment, _, _, kinetic = totals(craft, flight)
    return kinetic + GRAVITY * float(moment[0])


def test_a_landing_closes_its_energy() -> None:
    """Verifies: engine, soil, struts and ball joints account for every joule, contact and crushing included.
    Setup: 1.5 s of the Zupp-like landing at the twin's tolerance 1e-5; energies from mass points, works from the ledger.
    Tolerance: the acceptance is 0.5 % of what soil and struts take up; found 7e-7, 1e-5 is asked.
    """
    _, ledger, gained = landed(1e-5, 1.5)
    taken = -ledger[1:, :3].sum()
    assert taken > 5000.0
    assert -ledger[1:, 0].sum() > 500.0
    assert -ledger[1:, 1].sum() > 500.0
    assert ledger[1:, 2].max() <= 0.0
    assert gained == pytest.approx(ledger[0, 0] - taken, abs=1e-5 * taken)


def test_the_landing_converges_with_the_tolerance() -> None:
    """Verifies: a smaller tolerance gives a nearer end.
    Setup: 0.3 s of the Zupp-like landing (two pads down) at tolerances 1e-3, 1e-4, 1e-5 against 1e-7.
    Tolerance: the body's place falls by a factor 2 at least with every decade (order 2 in h, h as tol^1/3 gives 4.6; contacts cost some);
    found 1.0e-6, 2.6e-7, 8.5e-8 m; 1e-6 m must be reached at 1e-5.
    """
    exact = landed(1e-7, 0.3)[0].body
    errors = [float(np.abs(landed(tolerance, 0.3)[0].body - exact)[:3].max()) for tolerance in (1e-3, 1e-4, 1e-5)]
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2]
    assert errors[2] < 1e-6
