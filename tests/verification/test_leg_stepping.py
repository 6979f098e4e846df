"""The leg's integrator: order and energy against DOP853 on the leg's own equations, base moving as `base_at` says."""

from itertools import pairwise

import leg_points as heap
import numpy as np
import pytest
from apollo_samples import GRAVITY, leg_at, pad_load
from lander.laws.base_motion import BaseMotion, as_base, base_at
from lander.laws.honeycomb import Stop
from lander.laws.interface import leg_energy
from lander.laws.leg import Crush, Leg, shape
from lander.laws.leg_dynamics import leg_motion
from lander.laws.leg_joints import ball_torque
from lander.laws.leg_stepping import Course, LegState, start_state, step_leg
from lander.laws.vectors import ZERO, Vector, apply, cross, from_rotation_vector, rotation
from scipy.integrate import solve_ivp

INTERVAL = 0.04  # s
FINER = (4e-4, 2e-4, 1e-4)  # s
BASE = BaseMotion(
    (4.0, 0.0, 0.0), from_rotation_vector((0.2, 0.1, -0.3)), (-0.6, -0.5, -0.2), (0.1, 0.2, -0.15),
    (1.0, -2.0, 1.5), (3.0, 2.0, -4.0), (0.5, -0.8, 1.0), (2.0, 3.0, -1.0),
)  # fmt: skip
LOAD = pad_load((4000.0, 900.0, -700.0), (40.0, -30.0, 20.0), (9000.0, -5000.0, 3000.0), (100.0, 50.0, -80.0))


def soft_leg() -> Leg:
    """A leg whose law is smooth and mild: bands of 5 cm, little damping, dry bearings, no end stops."""
    return leg_at(0.6, width=0.05, zeta=0.002, bearing=0.0, stop=Stop(0.0, 0.0, 1.0))


def start(leg: Leg) -> LegState:
    """Undeformed and virgin, but swinging; the pad turning on its own."""
    return start_state(leg, BASE.attitude, BASE.rate)._replace(velocity=(0.2, -0.3, 0.1), rate=(0.5, -1.0, 0.8))


def flat(p: Vector, v: Vector, attitude: object, rate: Vector) -> np.ndarray:
    """A state as one array; the attitude as its matrix."""
    return np.concatenate([p, v, rate, np.array(rotation(attitude)).ravel()])


def reference(leg: Leg, state: LegState) -> np.ndarray:
    """DOP853; the pad's attitude by R' = R [ω x]. The memory is constant: strokes stay below the band's 5 cm."""
    crush: Crush = state.crush
    inertia = np.array(leg.pad_inertia)

    def motion(t: float, y: np.ndarray) -> np.ndarray:
        p, v, w = (tuple(map(float, y[i : i + 3])) for i in (0, 3, 6))
        pad = y[9:].reshape(3, 3)
        at = base_at(BASE, t)
        base, turned = as_base(at, GRAVITY), np.array(rotation(at.attitude))
        force = turned.T @ (np.array(LOAD.force) + t * np.array(LOAD.force_slope))
        pad_rate = turned.T @ pad @ w
        ball = ball_torque(leg, base, shape(leg, p, v), tuple(map(float, pad_rate)))
        a = leg_motion(leg, base, p, v, tuple(map(float, force)), ball, crush).acceleration
        torque = np.array(LOAD.torque) + t * np.array(LOAD.torque_slope) + turned @ ball
        spin = (pad.T @ torque - np.cross(w, inertia * w)) / inertia
        turn = pad @ np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        return np.concatenate([v, a, spin, turn.ravel()])

    begin = flat(state.position, state.velocity, state.attitude, state.rate)
    return solve_ivp(motion, (0.0, INTERVAL), begin, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]


def stepped(leg: Leg, longest: float) -> tuple[LegState, Course]:
    """The unit's own integration."""
    end, course, last = step_leg(leg, GRAVITY, BASE, LOAD, start(leg), INTERVAL, longest, ZERO)
    assert last.ok
    return end, course


def test_the_leg_and_its_pad_are_integrated_to_order_two() -> None:
    """Verifies: SDIRK2 on the leg and on the pad's rotation, load slopes and base motion at the stages' instants.
    Setup: smooth leg for 40 ms with substeps of 0.4 and 0.025 ms against DOP853 on quaternion-free kinematics.
    Tolerance: mean order over a factor 16: 2 within 0.1 for the leg; within 0.3 for the pad, whose equation gets the sweeps that the leg's
    Newton takes, so that its error falls unevenly. At the finest 1e-5 (m, m/s, rad/s).
    """
    leg = soft_leg()
    exact = reference(leg, start(leg))
    ends = [stepped(leg, h)[0] for h in (4e-4, 2.5e-5)]
    misses = np.array([flat(e.position, e.velocity, e.attitude, e.rate) - exact for e in ends])
    for part, within in ((slice(0, 3), 0.1), (slice(3, 6), 0.1), (slice(6, 9), 0.3), (slice(9, 18), 0.3)):
        coarse, fine = np.linalg.norm(misses[:, part], axis=1)
        assert np.log2(coarse / fine) / 4.0 == pytest.approx(2.0, abs=within)
    assert np.abs(misses[-1]).max() < 1e-5


def test_energy_balances_over_an_interval() -> None:
    """Verifies: mount work, pad work, dissipation and the leg's energies close: ΔE = pad work - mount work - dissipated.
    Setup: energies and mount are those above the rigid leg's, whose own balance closes, so that the difference closes too. Powers of forces
    against energies of points: they share no formula.
    Tolerance: falls with the square of the substep; at 0.1 ms 1e-4 of the pad's work.
    """
    leg = soft_leg()
    state = start(leg)
    before = sum(leg_energy(leg, GRAVITY, base_at(BASE, 0.0), state))
    gaps = []
    for longest in FINER:
        end, course = stepped(leg, longest)
        after = sum(leg_energy(leg, GRAVITY, base_at(BASE, INTERVAL), end))
        gaps.append(after - before - course.pad_work + course.mount_work + course.dissipated)
        assert course.dissipated > 0.0
    assert abs(gaps[-1]) < 1e-4 * abs(course.pad_work)
    assert [np.log2(abs(a / b)) for a, b in pairwise(gaps)] == pytest.approx([2.0, 2.0], abs=0.3)


def test_the_impulse_on_the_body_is_the_change_of_the_legs_momentum() -> None:
    """Verifies: `Course.impulse` against momenta: the leg's momentum above the rigid leg's, taken at both ends.
    Setup: base not turning (B's axes are inertial): the mount gives ∫ pad force - Δ(Σ m u), u relative to the base, since weight and the
    base's acceleration act on the rigid leg's mass alike.
    Tolerance: 1e-4 of the pad's impulse, that of the integrator at 0.25 ms.
    """
    leg = soft_leg()
    base = BASE._replace(attitude=(1.0, 0.0, 0.0, 0.0), rate=ZERO, spin_up=ZERO, spin_up_slope=ZERO)
    state = start(leg)._replace(attitude=(1.0, 0.0, 0.0, 0.0))
    end, course, last = step_leg(leg, GRAVITY, base, LOAD, state, INTERVAL, 2.5e-4, ZERO)
    assert last.ok
    still = heap.vec(ZERO)
    relative = [heap.momenta(leg, heap.vec(s.position), heap.vec(s.velocity), still, still)[:3].astype(float) for s in (state, end)]
    pad = INTERVAL * np.array(LOAD.force) + 0.5 * INTERVAL**2 * np.array(LOAD.force_slope)
    np.testing.assert_allclose(course.impulse, pad - (relative[1] - relative[0]), atol=1e-4 * np.linalg.norm(pad))


def test_a_stiff_virgin_leg_converges_to_the_same_end() -> None:
    """Verifies: the paper's stiff struts (rate 4e4 1/s, saturation, bearing friction, latching) under a landing's load.
    Setup: 20 kN on the pad for 40 ms; substeps of 0.25 ms, the unit's default, against 1/64 of it.
    Tolerance: 0.3 mm and 25 mm/s of 0.2 m and 11 m/s: found 0.22 mm and 19 mm/s, falling unevenly to 0.5 micrometres at 0.03 ms: the
    kinks of saturation, not the order, set the error.
    """
    leg = leg_at(0.6)
    load = pad_load((20000.0, 3000.0, -5000.0), ZERO, ZERO, ZERO)
    ends = [step_leg(leg, GRAVITY, BASE, load, start_state(leg, BASE.attitude, BASE.rate), INTERVAL, h, ZERO) for h in (2.5e-4, 4e-6)]
    assert all(last.ok for _, _, last in ends)
    coarse, fine = ends[0][0], ends[1][0]
    assert np.linalg.norm(np.subtract(fine.position, leg.geometry.pad)) > 5e-3
    np.testing.assert_allclose(coarse.position, fine.position, atol=3e-4)
    np.testing.assert_allclose(coarse.velocity, fine.velocity, atol=2.5e-2)


def test_an_undeformed_leg_moves_with_the_body() -> None:
    """Verifies: `start_state`: the ball joint at its place, the pad's axes and rate those of the body, virgin memories.
    Setup: by hand.
    Tolerance: exact.
    """
    leg = leg_at(0.6)
    state = start_state(leg, BASE.attitude, BASE.rate)
    assert state.position == leg.geometry.pad
    assert state.velocity == ZERO
    assert state.crush == Crush(1e-3, 1e-3, 1e-3, 1e-3, 1e-3)
    turned = rotation(state.attitude)
    np.testing.assert_allclose(apply(turned, state.rate), apply(rotation(BASE.attitude), BASE.rate), rtol=1e-14)
    assert cross(state.rate, BASE.rate) == ZERO
