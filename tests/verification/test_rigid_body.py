"""The rigid body against an integrator of order 8, conservation laws and closed forms."""

from itertools import pairwise
from math import radians

import numpy as np
import pytest
from apollo_samples import INERTIA, MASS
from lander.laws.base_motion import BaseMotion, base_at
from lander.laws.rigid_body import Body, BodyLoad, BodyState, body_energy, body_rate, inertia_matrix, step_body, wrench_work
from lander.laws.vectors import ZERO, apply, from_rotation_vector, rotation
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

PRODUCTS = (120.0, -340.0, 560.0)
FREE = Body(MASS, inertia_matrix(INERTIA, PRODUCTS), 0.0)
NO_LOAD = BodyLoad(ZERO, ZERO, ZERO, ZERO)
TUMBLING = BodyState((1.0, 2.0, 3.0), from_rotation_vector((0.3, -0.2, 0.9)), (0.1, -0.5, 0.2), (0.4, 0.9, -0.3))


def reference(body: Body, state: BodyState, load: BodyLoad, t: float) -> np.ndarray:
    """DOP853 on rotation-matrix kinematics R' = R [ω x] in numpy: x, v, ω, R by rows."""
    inertia = np.array(body.inertia)

    def motion(s: float, y: np.ndarray) -> np.ndarray:
        v, w, r = y[3:6], y[6:9], y[9:].reshape(3, 3)
        force = np.array(load.force) + s * np.array(load.force_slope)
        torque = np.array(load.torque) + s * np.array(load.torque_slope)
        spin = np.linalg.solve(inertia, torque - np.cross(w, inertia @ w))
        turn = r @ np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        return np.concatenate([v, r @ force / body.mass - [body.gravity, 0, 0], spin, turn.ravel()])

    w, x, y, z = state.attitude
    matrix = Rotation.from_quat([x, y, z, w]).as_matrix()
    start = np.concatenate([state.position, state.velocity, state.rate, matrix.ravel()])
    return solve_ivp(motion, (0.0, t), start, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]


def flat(state: BodyState) -> np.ndarray:
    """A state in the reference's layout."""
    return np.concatenate([state.position, state.velocity, state.rate, np.array(rotation(state.attitude)).ravel()])


def test_inertia_takes_products_with_a_minus() -> None:
    """Verifies: the tensor of mass points is built from its moments and products ∫xy dm.
    Setup: four mass points.
    Tolerance: 1e-12.
    """
    r = np.array([[1.0, 2.0, 0.5], [-0.3, 0.7, 1.1], [0.2, -0.9, 0.4], [1.5, 0.1, -0.6]])
    m = np.array([2.0, 3.0, 1.0, 0.5])
    tensor = sum(k * (x @ x * np.eye(3) - np.outer(x, x)) for k, x in zip(m, r, strict=True))
    products = tuple(float(np.sum(m * r[:, i] * r[:, j])) for i, j in ((0, 1), (0, 2), (1, 2)))
    np.testing.assert_allclose(np.array(inertia_matrix(tuple(np.diag(tensor)), products)), tensor, rtol=1e-12)


def test_a_torque_free_asymmetric_top() -> None:
    """Verifies: Euler's equations with products of inertia, attitude, conservation of momentum and energy without a load.
    Setup: 5 s of tumbling at 1 rad/s, steps of 1 ms, against DOP853 on other kinematics (rotation matrix).
    Tolerance: 1e-10: order 4 with h = 1 ms leaves 1e-12 a second; conservation 1e-11.
    """
    end = step_body(FREE, TUMBLING, NO_LOAD, 5.0, 1e-3)
    np.testing.assert_allclose(flat(end), reference(FREE, TUMBLING, NO_LOAD, 5.0), atol=1e-10)
    momenta = [np.array(apply(rotation(s.attitude), apply(FREE.inertia, s.rate))) for s in (TUMBLING, end)]
    np.testing.assert_allclose(momenta[1], momenta[0], rtol=1e-10)
    assert body_energy(FREE, end)[0] == pytest.approx(body_energy(FREE, TUMBLING)[0], rel=1e-11)


def test_a_turning_load_with_slopes() -> None:
    """Verifies: wrench in body axes going on linearly, gravity along -x of L.
    Setup: 2 s under force and torque with slopes, against DOP853.
    Tolerance: 1e-9 m after 2 m of travel.
    """
    body = FREE._replace(gravity=1.63)
    load = BodyLoad((11000.0, 300.0, -200.0), (900.0, -700.0, 500.0), (-2000.0, 100.0, 50.0), (100.0, 300.0, -200.0))
    end = step_body(body, TUMBLING, load, 2.0, 1e-3)
    np.testing.assert_allclose(flat(end), reference(body, TUMBLING, load, 2.0), atol=1e-9)


def test_constant_thrust_along_up_is_a_parabola() -> None:
    """Verifies: closed form x = v t + ½ (F/m - g) t².
    Setup: upright, not turning, 3 s in steps of 0.5 s: Runge-Kutta is exact for a parabola.
    Tolerance: 1e-13 relative.
    """
    body = Body(MASS, FREE.inertia, 1.63)
    still = BodyState(ZERO, (1.0, 0.0, 0.0, 0.0), (-0.5, 0.2, 0.0), ZERO)
    end = step_body(body, still, BodyLoad((5000.0, 0.0, 0.0), ZERO, ZERO, ZERO), 3.0, 0.5)
    assert end.position[0] == pytest.approx(-1.5 + 4.5 * (5000.0 / MASS - 1.63), rel=1e-13)
    assert end.velocity[0] == pytest.approx(-0.5 + 3.0 * (5000.0 / MASS - 1.63), rel=1e-13)
    assert end.position[1] == pytest.approx(0.6, rel=1e-13)


def test_the_order_is_four() -> None:
    """Verifies: Runge-Kutta's order.
    Setup: 2 s of the loaded tumble with steps of 0.2, 0.1, 0.05 s against DOP853.
    Tolerance: observed order within 0.2 of 4 at the finer pair.
    """
    load = BodyLoad((9000.0, 300.0, -200.0), (900.0, -700.0, 500.0), ZERO, ZERO)
    exact = reference(FREE, TUMBLING, load, 2.0)
    errors = [np.linalg.norm(flat(step_body(FREE, TUMBLING, load, 2.0, h)) - exact) for h in (0.2, 0.1, 0.05)]
    orders = [np.log2(a / b) for a, b in pairwise(errors)]
    assert orders[-1] == pytest.approx(4.0, abs=0.2)


def test_the_wrenchs_work_is_the_change_of_energy() -> None:
    """Verifies: `wrench_work` (Simpson) against the energies of the body, gravity included.
    Setup: one interval of 5 ms under load; 50 intervals add up.
    Tolerance: 2e-5: the middle's velocity from the ends' is off by h² v''/8, which costs h²/12 F v'' t = 9 mJ of 706 J.
    """
    body = Body(MASS, FREE.inertia, 1.63)
    load = BodyLoad((11000.0, 300.0, -200.0), (900.0, -700.0, 500.0), (-2000.0, 0.0, 0.0), ZERO)
    state, work = TUMBLING, 0.0
    before = sum(body_energy(body, state))
    for i in range(50):
        t = 5e-3 * i
        now = load._replace(force=(11000.0 - 2000.0 * t, 300.0, -200.0))
        end = step_body(body, state, now, 5e-3, 1e-3)
        work += wrench_work(state, end, now, 5e-3)
        state = end
    assert work == pytest.approx(sum(body_energy(body, state)) - before, rel=2e-5)


def test_body_rate_is_the_derivative_of_the_motion() -> None:
    """Verifies: the accelerations shown to the legs.
    Setup: central difference over 0.1 ms of stepped states.
    Tolerance: 1e-7: h² times third derivatives of order one.
    """
    load = BodyLoad((9000.0, 300.0, -200.0), (900.0, -700.0, 500.0), ZERO, ZERO)
    rate = body_rate(FREE, TUMBLING, load, 0.0)
    ahead = step_body(FREE, TUMBLING, load, 1e-4, 1e-4)
    behind = step_body(FREE, TUMBLING, load, -1e-4, -1e-4)
    np.testing.assert_allclose(rate.acceleration, (np.array(ahead.velocity) - behind.velocity) / 2e-4, atol=1e-7)
    np.testing.assert_allclose(rate.spin_up, (np.array(ahead.rate) - behind.rate) / 2e-4, atol=1e-7)
    np.testing.assert_allclose(rate.attitude, (np.array(ahead.attitude) - behind.attitude) / 2e-4, atol=1e-7)


def test_the_base_within_an_interval_follows_its_accelerations() -> None:
    """Verifies: `base_at`: cubic translation exactly, Magnus attitude to third order in t.
    Setup: rate, angular acceleration and slope of some rad/s each; DOP853 on R' = R [ω x]; error at 40, 20 and 10 ms.
    Tolerance: the attitude's order at least 3.9 in t; at 5 ms below 1e-8 rad for 6 deg/s and 60 deg/s2, a landing's.
    """
    motion = BaseMotion(
        (0.0, 0.0, 0.0),
        (1.0, 0.0, 0.0, 0.0),
        (1.0, 2.0, 3.0),
        (0.9, -1.2, 2.0),
        (0.3, 0.2, 0.1),
        (4.0, 5.0, 6.0),
        (7.0, 5.0, -8.0),
        (20.0, -30.0, 10.0),
    )

    def miss(m: BaseMotion, t: float) -> float:
        def turn(s: float, y: np.ndarray) -> np.ndarray:
            w = np.array(m.rate) + s * np.array(m.spin_up) + 0.5 * s * s * np.array(m.spin_up_slope)
            return (y.reshape(3, 3) @ np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])).ravel()

        exact = solve_ivp(turn, (0.0, t), np.eye(3).ravel(), method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
        return float(np.abs(np.array(rotation(base_at(m, t).attitude)).ravel() - exact).max())

    errors = [miss(motion, t) for t in (0.04, 0.02, 0.01)]
    assert min(np.log2(a / b) for a, b in pairwise(errors)) > 3.9
    landing = motion._replace(rate=(0.0, radians(6.0), radians(-3.0)), spin_up=(radians(20.0), 0.0, radians(60.0)), spin_up_slope=ZERO)
    assert miss(landing, 5e-3) < 1e-8
    at = base_at(motion, 0.03)
    np.testing.assert_allclose(
        at.position,
        np.array((1.0, 2.0, 3.0)) * 0.03 + np.array((0.3, 0.2, 0.1)) * 0.03**2 / 2 + np.array((4.0, 5.0, 6.0)) * 0.03**3 / 6,
        rtol=1e-13,
    )
    np.testing.assert_allclose(
        at.velocity, np.array((1.0, 2.0, 3.0)) + np.array((0.3, 0.2, 0.1)) * 0.03 + np.array((4.0, 5.0, 6.0)) * 0.03**2 / 2, rtol=1e-13
    )
    np.testing.assert_allclose(
        at.rate, np.array((0.9, -1.2, 2.0)) + np.array((7.0, 5.0, -8.0)) * 0.03 + np.array((20.0, -30.0, 10.0)) * 0.03**2 / 2, rtol=1e-13
    )
    np.testing.assert_allclose(at.acceleration, (0.3 + 4.0 * 0.03, 0.2 + 5.0 * 0.03, 0.1 + 6.0 * 0.03), rtol=1e-13)
    np.testing.assert_allclose(at.spin_up, (7.0 + 20.0 * 0.03, 5.0 - 30.0 * 0.03, -8.0 + 10.0 * 0.03), rtol=1e-13)
