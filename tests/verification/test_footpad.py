"""Five contact points under one footpad: sums, cone, plowing, memory, and all eight blocks of tangents against finite differences."""

import numpy as np
import pytest
from apollo_samples import PAD
from lander.laws.footpad import (
    DATUM,
    DEPTH,
    PLACE,
    SLIDE,
    PadMotion,
    deepest,
    lever,
    pad_power,
    pad_wrench,
    remember,
    slid,
    start_memory,
)
from lander.laws.soil import PUBLISHED, RATE_INDEPENDENT, UNLATCHED, Soil, normal_force
from lander.laws.surface import inclined_plane
from lander.laws.vectors import Vector, identity
from lander.units.regolith_contact import RegolithContact
from scipy.spatial.transform import Rotation

SOIL = Soil(PUBLISHED, 30000.0, 1.5, 30000.0, 0.1, 1e-4, 1e-4, 0.36, 290.8, 1e-3)
LEVEL, SLOPE = inclined_plane(0.0, 0.0), inclined_plane(0.08, -0.2)


def motion(place: Vector, turn: Vector = (0.0, 0.0, 0.0), velocity: Vector = (0.0, 0.0, 0.0), rate: Vector = (0.0, 0.0, 0.0)) -> PadMotion:
    """A pad at `place`, turned by a rotation vector."""
    rows = tuple(tuple(map(float, row)) for row in Rotation.from_rotvec(turn).as_matrix())
    return PadMotion(tuple(map(float, place)), rows, tuple(map(float, velocity)), tuple(map(float, rate)))


def memory_of(at: PadMotion, surface: object = LEVEL) -> np.ndarray:
    """Virgin memory of a pad at `at`."""
    memory = np.zeros((5, 8))
    start_memory(surface, PAD, at, memory)
    return memory


def test_five_points_together_are_one_footpad_of_table_4() -> None:
    """Verifies: K_n, C_n, K_p of Table 4 are the footpad's, a fifth to each point: the sum is the footpad's force.
    Setup: level pad sinking straight, 2 cm deep, having slid 3 cm; the single law with five times the parameters.
    Tolerance: 1e-12. The torque is the tangential force at the pad's height, 0.10 m below the ball joint.
    """
    at = motion((0.10 - 0.02, 0.03, 0.0), velocity=(-0.4, 0.0, 0.0))
    memory = memory_of(motion((0.10 - 0.01, 0.0, 0.0)))
    wrench, _ = pad_wrench(SOIL, LEVEL, PAD, at, memory)
    whole = SOIL._replace(bearing=150000.0, damping=150000.0)
    assert wrench.force[0] == pytest.approx(normal_force(whole, 0.02, 0.4, UNLATCHED).force, rel=1e-12)
    assert wrench.force[1] == pytest.approx(-1454.0 * 0.03, rel=1e-12)
    assert wrench.torque == pytest.approx((0.0, 0.0, 0.10 * 1454.0 * 0.03), rel=1e-12, abs=1e-9)


def test_the_points_are_the_centre_and_the_rim_below_the_ball_joint() -> None:
    """Verifies: Fig. 9's pattern, and that the torque of a tilted pad sets it level.
    Setup: sum and spread of the levers; a pad with its +Z rim lowered sinks there alone: it must be turned back.
    Tolerance: 1e-15; sign.
    """
    levers = np.array([lever(PAD, identity(1.0), i) for i in range(5)])
    np.testing.assert_allclose(levers.mean(axis=0), (-0.10, 0.0, 0.0), atol=1e-15)
    np.testing.assert_allclose(np.linalg.norm(levers[1:] - levers[0], axis=1), 0.47, rtol=1e-14)
    np.testing.assert_allclose(levers[1:].T @ levers[1:], np.diag([4 * 0.01, 2 * 0.47**2, 2 * 0.47**2]), atol=1e-15)
    tilt = motion((0.10 + 0.01, 0.0, 0.0), turn=(0.0, 0.05, 0.0), velocity=(-0.4, 0.0, 0.0))
    lowered = lever(PAD, tilt.attitude, 4 if lever(PAD, tilt.attitude, 4)[0] < lever(PAD, tilt.attitude, 2)[0] else 2)
    wrench, _ = pad_wrench(SOIL, LEVEL, PAD, tilt, memory_of(tilt))
    assert wrench.force[0] > 0.0
    assert wrench.torque[1] * lowered[2] > 0.0  # a turn θ about y moves it by θ r_z along x: up
    assert wrench.torque[1] == pytest.approx(lowered[2] * wrench.force[0], rel=1e-9)


def test_friction_takes_energy_on_the_cone_and_plowing_stays_in_the_soil(random: np.random.Generator) -> None:
    """Verifies: on a slope, the tangential part is in the plane, opposes the slip, and is μ F_n; the power of the wrench is negative.
    Setup: random slips of 0.5 m/s with a little sinking, pad level with the slope; K_p = 0.
    Tolerance: 1e-5: the regularisation's ½ (v_s/v)² is 2e-6.
    """
    soil, normal = SOIL._replace(plowing=0.0), np.array(SLOPE.normal)
    turn = np.cross((1.0, 0.0, 0.0), normal)
    turn *= np.arcsin(np.linalg.norm(turn)) / np.linalg.norm(turn)
    for _ in range(5):
        slip = np.cross(normal, random.normal(size=3))
        slip *= 0.5 / np.linalg.norm(slip)
        at = motion(tuple((0.10 - 0.03) * normal), tuple(turn), tuple(slip - 0.05 * normal))
        wrench, _ = pad_wrench(soil, SLOPE, PAD, at, memory_of(at, SLOPE))
        force = np.array(wrench.force)
        push = force @ normal
        assert push > 100.0
        np.testing.assert_allclose(force - push * normal, -0.36 * push * slip / 0.5, atol=1e-5 * push)
        assert pad_power(wrench, at) < 0.0


def test_memory_follows_the_pad() -> None:
    """Verifies: slide counts the way in the soil only, also within the step of first contact; depth, place and datum are those of the end.
    Setup: from 1 cm above to 3 cm below while moving 8 cm sideways in one step: a quarter of it in the air; then 2 cm on; then out.
    Tolerance: 1e-12.
    """
    memory = memory_of(motion((0.11, 0.0, 0.0)))
    assert deepest(memory) == pytest.approx(-0.01, rel=1e-12)
    remember(SOIL, LEVEL, PAD, motion((0.07, 0.0, 0.08), velocity=(-0.4, 0.0, 0.0)), memory)
    assert slid(memory) == pytest.approx(0.06, rel=1e-12)
    np.testing.assert_allclose(memory[:, DATUM], UNLATCHED)
    np.testing.assert_allclose(memory[:, DEPTH], 0.03, rtol=1e-12)
    remember(SOIL, LEVEL, PAD, motion((0.07, 0.02, 0.08), velocity=(-5e-5, 0.0, 0.0)), memory)
    np.testing.assert_allclose(memory[0, SLIDE : SLIDE + 3], (0.0, 0.02, 0.06), atol=1e-14)
    np.testing.assert_allclose(memory[:, DATUM], 0.03, rtol=1e-12)
    remember(SOIL, LEVEL, PAD, motion((0.12, 0.50, 0.0), velocity=(0.4, 0.0, 0.0)), memory)
    np.testing.assert_allclose(memory[0, SLIDE : SLIDE + 3], (0.0, 0.02, 0.06), atol=1e-14)
    np.testing.assert_allclose(memory[0, PLACE : PLACE + 3], (0.02, 0.50, 0.0), atol=1e-14)
    out, _ = pad_wrench(SOIL, LEVEL, PAD, motion((0.12, 0.5, 0.0)), memory)
    assert out.force == (0.0, 0.0, 0.0)


def six(wrench: object) -> np.ndarray:
    """Force and torque as one array."""
    return np.concatenate([wrench.force, wrench.torque])


@pytest.mark.parametrize("law", [PUBLISHED, RATE_INDEPENDENT])
@pytest.mark.parametrize("sinking", [0.3, 6e-5])
def test_tangents_against_finite_differences(law: int, sinking: float, random: np.random.Generator) -> None:
    """Verifies: the eight blocks of `PadTangents`.
    Setup: a tilted, sliding pad on the slope without rotation rate (the blocks leave out how a turn changes the points' velocities), some
    points in their unloading band; five-point differences of the wrench by position, rotation, velocity and rate. The blocks hold the arms
    fixed: the geometric part of the turn, Σ (θ x r_i) x f_i, is added to k_rr here.
    Tolerance: 1e-5 of each block's largest element: truncation at a thousandth of band and residual rate.
    """
    soil = SOIL._replace(law=law)
    normal = np.array(SLOPE.normal)
    place = (0.10 - 0.03) * normal + np.array([0.0, 0.4, -0.3])
    velocity = np.cross(normal, (0.1, 0.3, -0.2)) - sinking * normal
    turn = np.array([0.1, 0.01, 0.02])
    base = motion(place, turn, velocity)
    memory = memory_of(motion(place + np.array([0.001, 0.01, 0.02]), turn), SLOPE)
    memory[:, DATUM] = [UNLATCHED, 0.05, UNLATCHED, 0.04, 0.02]
    depths = memory_of(base, SLOPE)[:, DEPTH]
    assert (depths > 0.005).sum() >= 3
    memory[0, DATUM] = depths[0] + 4e-5
    _, blocks = pad_wrench(soil, SLOPE, PAD, base, memory)

    def wrench(x: np.ndarray, r: np.ndarray, v: np.ndarray, w: np.ndarray) -> np.ndarray:
        turned = (Rotation.from_rotvec(r) * Rotation.from_rotvec(turn)).as_rotvec()
        return six(pad_wrench(soil, SLOPE, PAD, motion(place + x, turned, velocity + v, w), memory)[0])

    def derivative(argument: int, step: float) -> np.ndarray:
        columns = []
        for axis in np.eye(3):
            f = {}
            for k in (-2, -1, 1, 2):
                arguments = [np.zeros(3)] * 4
                arguments[argument] = k * step * axis
                f[k] = wrench(*arguments)
            columns.append((8 * (f[1] - f[-1]) - (f[2] - f[-2])) / (12 * step))
        return -np.array(columns).T

    arms = [np.array(lever(PAD, base.attitude, i)) for i in range(5)]
    geometric = np.zeros((3, 3))
    for i in range(5):
        f = point_force(soil, base, memory, i)
        for j, axis in enumerate(np.eye(3)):
            geometric[:, j] -= np.cross(np.cross(axis, arms[i]), f)
    pairs = (
        (derivative(0, 1e-7), (blocks.k_xx, blocks.k_rx)),
        (derivative(1, 1e-7), (blocks.k_xr, np.array(blocks.k_rr) + geometric)),
        (derivative(2, 1e-7), (blocks.c_xx, blocks.c_rx)),
        (derivative(3, 1e-7), (blocks.c_xr, blocks.c_rr)),
    )
    for found, (upper, lower) in pairs:
        for part, block in ((found[:3], np.array(upper)), (found[3:], np.array(lower))):
            np.testing.assert_allclose(block, part, atol=1e-5 * np.abs(part).max())


def point_force(soil: Soil, at: PadMotion, memory: np.ndarray, i: int) -> np.ndarray:
    """Force on point i alone, from the law of one point written out for a pad that does not turn."""
    normal = np.array(SLOPE.normal)
    arm = np.array(lever(PAD, at.attitude, i))
    depth = -normal @ (np.array(at.position) + arm)
    if depth <= 0.0:
        return np.zeros(3)
    velocity = np.array(at.velocity)
    push = normal_force(soil, depth, -normal @ velocity, memory[i, DATUM]).force
    slip = velocity - normal * (normal @ velocity)
    way = np.array(at.position) + arm - memory[i, PLACE : PLACE + 3]
    way -= normal * (normal @ way)
    return push * normal - push * soil.friction * slip / np.hypot(np.linalg.norm(slip), soil.slip_velocity) - soil.plowing * way


def test_a_graze_within_an_interval_is_the_first_contact() -> None:
    """Verifies: contact_time of a pad that comes down to the ground and is off it again when the interval ends.
    Setup: 0.1 mm above the ground at -50 mm/s, pulled up at 10 m/s2 (mobility of 500 kg): down to -25 µm after 5 ms, 1.1 mm above after 20.
    Tolerance: 0.6 ms, a little more than a substep; without soil the pad would be at the ground after 2.76 ms.
    """
    one = RegolithContact(instance_name="soil")
    one["pad.position"], one["pad.velocity"] = (0.1001, 0.0, 0.0), (-0.05, 0.0, 0.0)
    one["pad.model_acceleration"], one["pad.model_mobility"] = (10.0, 0.0, 0.0), np.eye(3).ravel() / 500.0
    one.setup_experiment(0.0, None, None)
    one.exit_initialization_mode()
    assert one.do_step(0.0, 0.02), one.message
    assert one["contact"][0] == 0.0
    assert one["contact_time"][0] == pytest.approx(2.76e-3, abs=6e-4)
