"""Verifies: angle and energy margin of tip-over against a rigid body over a fixed edge, worked out by hand and integrated by SciPy.

Setup: four pads on a square whose half side is a, the centre of mass h above them (39.6 deg, as the Lunar Module); slopes by turning all.
Tolerance: 1e-9 where the answer is a formula. In the integrated cases the speed differs from the critical one by 1e-4 of it, which moves
the turning point to 0.4 deg from the top at least: far above the integrator's error (rtol 1e-10).
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from orchestrator.results.geometry import mass_properties
from orchestrator.results.tip_over import MassProperties, Motion, edges

A, H = 3.0, 3.62
MOON = MassProperties(7063.5, np.diag([16492.0, 17409.0, 20800.0]), 1.63)
SQUARE = np.array([[0.0, A, A], [0.0, -A, A], [0.0, -A, -A], [0.0, A, -A]])
RHO = math.hypot(A, H)
INERTIA = MOON.inertia[2, 2] + MOON.mass * RHO**2  # about an edge along Z


def over(velocity=(0.0, 0.0, 0.0), rate=(0.0, 0.0, 0.0), turn=None, height=H):
    """Edges of a body at rest over level pads, all of it turned by `turn` (L), then moving."""
    turn = turn or Rotation.identity()
    quaternion = turn.as_quat(scalar_first=True)
    motion = Motion(turn.apply([[height, 0.0, 0.0]]), np.array([velocity]), quaternion[None, :], np.array([rate]))
    return edges(turn.apply(SQUARE)[None, :, :], motion, MOON)


def test_on_level_ground_every_edge_is_as_far_as_half_the_side_over_the_height():
    found = over()
    assert found.angle == pytest.approx(math.atan(A / H), abs=1e-9)
    assert found.energy == pytest.approx(MOON.mass * MOON.gravity * (RHO - H), rel=1e-9)


@pytest.mark.parametrize("slope", [0.1, math.radians(12.0), 0.6])
def test_a_slope_takes_its_angle_from_the_edge_below_and_gives_it_to_the_one_above(slope):
    found = over(turn=Rotation.from_rotvec([0.0, 0.0, slope]))
    assert found.angle.min() == pytest.approx(math.atan(A / H) - slope, abs=1e-9)
    assert found.angle.max() == pytest.approx(math.atan(A / H) + slope, abs=1e-9)


def test_a_slope_across_a_corner_takes_less_than_its_angle_from_both_edges_there():
    """In the plane across an edge that itself inclines, gravity leans by atan(tan(slope) / √2)."""
    turn = Rotation.from_rotvec(math.radians(12.0) * np.array([0.0, 1.0, 1.0]) / math.sqrt(2.0))
    lean = math.atan(math.tan(math.radians(12.0)) / math.sqrt(2.0))
    assert np.sort(over(turn=turn).angle[0])[:2] == pytest.approx(math.atan(A / H) - lean, abs=1e-9)


@pytest.mark.parametrize("beyond", [-1e-6, 1e-6])
def test_angle_and_energy_of_a_body_at_rest_change_sign_exactly_over_the_edge(beyond):
    found = over(turn=Rotation.from_rotvec([0.0, 0.0, math.atan(A / H) + beyond]))
    k = int(np.argmin(found.angle[0]))
    assert found.angle[0, k] == pytest.approx(-beyond, abs=1e-12)
    assert math.copysign(1.0, found.energy[0, k]) == math.copysign(1.0, -beyond)


def critical_speed() -> float:
    """Level speed with which a rigid body that trips over an edge just reaches the top: m v h = I ω, ½ I ω² = m g (ρ − h)."""
    return math.sqrt(2.0 * INERTIA * MOON.gravity * (RHO - H) / MOON.mass) / H


@pytest.mark.parametrize(("share", "falls"), [(1.0 - 1e-6, False), (1.0 + 1e-6, True)])
def test_the_energy_margin_of_a_tripped_body_changes_sign_at_the_speed_worked_out_by_hand(share, falls):
    found = over(velocity=(0.0, share * critical_speed(), 0.0))
    assert bool(found.energy.min() < 0.0) is falls
    assert abs(found.energy.min()) < 1e-5 * MOON.mass * MOON.gravity * (RHO - H)


def test_falling_straight_down_inside_the_pads_tips_over_none():
    assert over(velocity=(-3.0, 0.0, 0.0)).energy == pytest.approx(over().energy, rel=1e-9)


def test_motion_away_from_an_edge_costs_it_nothing():
    found = over(velocity=(0.0, 1.0, 0.0))
    assert found.energy.max() == pytest.approx(over().energy.max(), rel=1e-9)
    assert (found.secure < found.energy + 1e-6).all()


def turned(angle, outward):
    """Pads and motion of the body at `angle` (rad) inside its edge at +Y, turning outward (rad/s) about it."""
    turn = Rotation.from_rotvec([0.0, 0.0, math.atan(A / H) - angle])  # outward over the pads at +Y is +z
    pivot, omega = np.array([0.0, A, 0.0]), np.array([0.0, 0.0, outward])
    arm = turn.apply([H, -A, 0.0])
    quaternion = turn.as_quat(scalar_first=True)
    motion = Motion((pivot + arm)[None], np.cross(omega, arm)[None], quaternion[None], turn.inv().apply(omega)[None])
    return edges((pivot + turn.apply(SQUARE - pivot))[None], motion, MOON)


def swing(speed: float) -> float:
    """Least angle (rad) of the body after it tripped at a level speed, by integrating its rotation about the edge.

    On the way up the energy margin is conserved: 1e-6 of the barrier.
    """
    weight = MOON.mass * MOON.gravity
    first = (math.atan(A / H), MOON.mass * speed * H / INERTIA)
    left = weight * (RHO - H) - 0.5 * INERTIA * first[1] ** 2

    def turning(_, y):
        return [-y[1], -weight * RHO * math.sin(y[0]) / INERTIA]  # y: angle inside the edge, outward rate

    course = solve_ivp(turning, (0.0, 30.0), first, rtol=1e-10, atol=1e-12, max_step=0.05)
    least = math.inf
    for angle, outward in course.y.T:
        found = turned(angle, outward)
        least = min(least, float(found.angle.min()))
        if angle >= 0.0 and outward > 0.0:
            assert found.energy.min() == pytest.approx(left, abs=1e-6 * weight * (RHO - H))
        if least < -0.2 or outward < -0.1:  # over, or on its way back
            break
    return least


def test_an_integrated_swing_below_the_critical_speed_turns_back_and_one_above_goes_over():
    assert swing(critical_speed() * (1.0 - 1e-4)) > 0.0
    assert swing(critical_speed() * (1.0 + 1e-4)) < -0.1


def test_pads_in_any_order_and_number_give_the_same_edges():
    turn = Rotation.from_rotvec([0.1, 0.05, 0.15])
    three = np.array([[0.0, 4.0, 0.0], [0.0, -2.0, 3.46], [0.0, -2.0, -3.46]])
    still = Motion(turn.apply([[H, 0.2, 0.1]]), np.zeros((1, 3)), turn.as_quat(scalar_first=True)[None], np.zeros((1, 3)))
    one, other = (edges(turn.apply(three[list(order)])[None], still, MOON) for order in ((0, 1, 2), (2, 0, 1)))
    assert np.sort(one.angle) == pytest.approx(np.sort(other.angle), abs=1e-12)
    assert one.angle.min() > 0.0


def test_products_of_inertia_are_the_same_body_seen_from_turned_axes():
    """Axes of B turned in the body: tensor, attitude and rates change together, angle and energies must not.

    Tolerance: rounding, 1e-9 of the energies. With the products' sign turned the margin of this body is off by kilojoules.
    """
    turn, rate, axes = Rotation.from_rotvec([0.05, 0.1, -0.2]), np.array([0.3, -0.4, 0.6]), Rotation.from_rotvec([0.5, 0.3, -0.7])
    pads, at, velocity = turn.apply(SQUARE)[None, :, :], turn.apply([[H, 0.0, 0.0]]), np.array([[0.0, 0.8, -0.3]])
    tensor = axes.inv().as_matrix() @ MOON.inertia @ axes.as_matrix()
    parameters = {"body.mass": MOON.mass, "body.gravity": MOON.gravity}
    parameters |= {f"body.inertia[{i + 1}]": tensor[i, i] for i in range(3)}
    parameters |= {f"body.inertia_products[{k}]": -tensor[i, j] for k, (i, j) in enumerate(((0, 1), (0, 2), (1, 2)), 1)}
    turned = mass_properties("body", parameters)
    assert np.abs(turned.inertia - tensor).max() < 1e-9
    plain = edges(pads, Motion(at, velocity, turn.as_quat(scalar_first=True)[None, :], rate[None, :]), MOON)
    quaternion = (turn * axes).as_quat(scalar_first=True)[None, :]
    found = edges(pads, Motion(at, velocity, quaternion, axes.inv().apply(rate)[None, :]), turned)
    wrong = edges(pads, Motion(at, velocity, quaternion, axes.inv().apply(rate)[None, :]),
                  replace(turned, inertia=2.0 * np.diag(np.diag(tensor)) - tensor))  # fmt: skip
    for mine, theirs in zip((found.angle, found.energy, found.secure), (plain.angle, plain.energy, plain.secure), strict=True):
        assert mine == pytest.approx(theirs, rel=1e-9, abs=1e-6)
    assert np.abs(wrong.energy - plain.energy).max() > 100.0
