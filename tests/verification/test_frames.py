"""Frames, signs and the ground, against elementary matrices and the pads' gaps at the start of the two published landings."""

from math import cos, radians, sin

import numpy as np
import pytest
from apollo_samples import ADAMS, ZUPP, Landing, lowest_gaps, vehicle
from lander.laws.surface import depth_at, gap_at, inclined_plane
from lander.laws.vectors import (
    across,
    apply,
    apply_transposed,
    cross,
    from_rotation_vector,
    from_yaw_pitch_roll,
    multiply,
    product,
    rotation,
    skew,
    solve,
    yaw_pitch_roll,
)
from scipy.spatial.transform import Rotation

ANGLES = (0.3, -0.2, 0.5)  # yaw, pitch, roll


def elementary(axis: int, angle: float) -> np.ndarray:
    """Active rotation about a coordinate axis."""
    c, s = cos(angle), sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    m = np.eye(3)
    m[i, i], m[i, j], m[j, i], m[j, j] = c, -s, s, c
    return m


def test_body_to_local_is_roll_after_pitch_after_yaw() -> None:
    """Verifies: R(B to L) = Rz(roll) Ry(pitch) Rx(yaw), and its inverse.
    Setup: product of three elementary matrices, one triple of unequal angles.
    Tolerance: 1e-15 per element, a few roundings.
    """
    yaw, pitch, roll = ANGLES
    expected = elementary(2, roll) @ elementary(1, pitch) @ elementary(0, yaw)
    attitude = from_yaw_pitch_roll(*ANGLES)
    np.testing.assert_allclose(np.array(rotation(attitude)), expected, atol=1e-15, rtol=0.0)
    np.testing.assert_allclose(yaw_pitch_roll(attitude), ANGLES, atol=1e-15, rtol=0.0)


def test_pitch_lifts_the_nose_roll_lowers_the_right_side_yaw_turns_the_nose_left() -> None:
    """Verifies: the signs of the three angles in words.
    Setup: nose +Z and right side +Y of B, seen in L (up +X, right +Y).
    Tolerance: exact to rounding; the sine of the angle is the coordinate.
    """
    nose, right = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
    assert apply(rotation(from_yaw_pitch_roll(0.0, 0.1, 0.0)), nose)[0] == pytest.approx(sin(0.1), rel=1e-14)
    assert apply(rotation(from_yaw_pitch_roll(0.0, 0.0, 0.1)), right)[0] == pytest.approx(-sin(0.1), rel=1e-14)
    assert apply(rotation(from_yaw_pitch_roll(0.1, 0.0, 0.0)), nose)[1] == pytest.approx(-sin(0.1), rel=1e-14)


@pytest.mark.parametrize("length", [1e-12, 1e-9, 2e-8, 1e-3, 2.0])
def test_rotations_against_scipy(length: float, random: np.random.Generator) -> None:
    """Verifies: rotation vector to quaternion (through its switch at 1e-8), Hamilton product and rotation matrix.
    Setup: scipy's Rotation, random axes.
    Tolerance: 1e-15 absolute: roundings of numbers below one.
    """
    a, b = random.normal(size=(2, 3))
    a *= length / np.linalg.norm(a)
    expected = Rotation.from_rotvec(a) * Rotation.from_rotvec(b)
    q = multiply(from_rotation_vector(tuple(a)), from_rotation_vector(tuple(b)))
    np.testing.assert_allclose(np.array(rotation(q)), expected.as_matrix(), atol=2e-15, rtol=0.0)


def test_vector_algebra_against_numpy(random: np.random.Generator) -> None:
    """Verifies: product, transposed product, cross, skew, across and Cramer's rule.
    Setup: random matrices and vectors, numpy.
    Tolerance: 1e-13 relative, the condition of a random 3x3 system.
    """
    m, n = random.normal(size=(2, 3, 3))
    a, b = random.normal(size=(2, 3))
    rows = tuple(map(tuple, m)), tuple(map(tuple, n))
    unit = a / np.linalg.norm(a)
    pairs = (
        (product(*rows), m @ n),
        (apply_transposed(rows[0], tuple(a)), m.T @ a),
        (cross(tuple(a), tuple(b)), np.cross(a, b)),
        (apply(skew(tuple(a)), tuple(b)), np.cross(a, b)),
        (across(tuple(unit), tuple(b)), b - unit * (unit @ b)),
        (solve(rows[0], tuple(b)), np.linalg.solve(m, b)),
    )
    for ours, theirs in pairs:
        np.testing.assert_allclose(np.array(ours), theirs, rtol=1e-12, atol=1e-14)


def test_the_ground_rises_forward_and_its_normal_turns_with_the_azimuth() -> None:
    """Verifies: N = Rx(azimuth) Ry(slope) x̂ up to the sense in which the ground rises: toward +Z at azimuth 0; gap and depth.
    Setup: elementary matrices; a point 1 m ahead on the level of the origin lies tan(slope) below a ground that rises toward it.
    Tolerance: 1e-15, roundings.
    """
    slope, azimuth = radians(4.5), radians(-12.0)
    plane = inclined_plane(slope, azimuth)
    expected = elementary(0, azimuth) @ np.array([cos(slope), 0.0, -sin(slope)])
    np.testing.assert_allclose(plane.normal, expected, atol=1e-15, rtol=0.0)
    ahead = (0.0, 0.0, 1.0)
    level = inclined_plane(slope, 0.0)
    assert gap_at(level, ahead) == pytest.approx(-np.tan(slope), rel=1e-14)
    assert depth_at(level, ahead) == pytest.approx(sin(slope), rel=1e-14)
    raised = inclined_plane(slope, 0.0, (0.7, 0.0, 0.0))
    assert gap_at(raised, (0.9, 0.0, 0.0)) == pytest.approx(0.2, rel=1e-14)


def gaps(landing: Landing) -> np.ndarray:
    """Gaps of +Y, +Z, -Z, -Y with the lowest pad on the ground, m."""
    turned = rotation(from_yaw_pitch_roll(landing.yaw, landing.pitch, landing.roll))
    z, y, back, left = lowest_gaps(vehicle(landing), turned)
    found = np.array([y, z, back, left])
    return found - found.min()


@pytest.mark.parametrize(
    ("landing", "expected"), [(ZUPP, (0.0, 0.045, 0.455, 0.500)), (ADAMS, (0.0, 0.039, 0.428, 0.468))], ids=["zupp", "adams"]
)
def test_pad_gaps_at_the_start_are_those_of_the_specification(landing: Landing, expected: tuple[float, ...]) -> None:
    """Verifies: frames, leg geometry and ground together: physics.md, "Frames and signs".
    Setup: gaps of the pads' lowest points in the order +Y, +Z, -Z, -Y; the same with slope, azimuth or yaw reversed.
    Tolerance: 1 mm, to which the specification gives them; a reversed sign must miss by ten times that.
    """
    np.testing.assert_allclose(gaps(landing), expected, atol=1e-3, rtol=0.0)
    for name in ("slope", "azimuth", "yaw"):
        value = getattr(landing, name)
        if value != 0.0:
            other = gaps(landing._replace(**{name: -value}))
            assert np.abs(other - expected).max() > 1e-2, f"{name} reversed gives the same gaps"
