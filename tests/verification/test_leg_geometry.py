"""The leg's geometry against the numbers checked in physics.md and against plain trigonometry."""

from math import atan2, degrees, hypot, isnan, pi

import numpy as np
import pytest
from apollo_samples import CG_HEIGHT
from lander.laws.leg_geometry import GearDimensions, GeometryError, leg_geometry
from scipy.spatial.transform import Rotation

DIMENSIONS = GearDimensions()


def test_the_undeformed_leg_has_the_checked_dimensions() -> None:
    """Verifies: l_conn is measured from the ball joint: connection at r 3.789 h 1.165 m, secondaries 1.372 m, primary 3.015 m at 23.06 deg.
    Setup: Table 2's dimensions; closed forms from the two joints of the primary.
    Tolerance: half a millimetre and 0.005 deg, the digits given; 1e-12 against the closed form.
    """
    leg = leg_geometry(DIMENSIONS, 0.0, CG_HEIGHT, 0.812)
    rise, run = 2.874 - 0.10, 4.242 - 3.061
    assert leg.length == pytest.approx(hypot(rise, run), rel=1e-12)
    assert leg.length == pytest.approx(3.015, abs=5e-4)
    assert degrees(atan2(run, rise)) == pytest.approx(23.06, abs=5e-3)
    upper, pad = np.array(leg.upper), np.array(leg.pad)
    joint = upper + leg.cylinder * (pad - upper) / leg.length
    assert np.linalg.norm(pad - joint) == pytest.approx(1.157, rel=1e-12)
    assert joint[2] == pytest.approx(3.789, abs=5e-4)
    assert joint[0] + CG_HEIGHT == pytest.approx(1.165, abs=5e-4)
    assert leg.right_length == pytest.approx(1.372, abs=5e-4)
    assert leg.left_length == pytest.approx(np.linalg.norm(joint - np.array(leg.left)), rel=1e-12)
    assert leg.piston == pytest.approx(leg.length - 0.812, rel=1e-12)
    assert pad[0] + CG_HEIGHT == pytest.approx(0.10, rel=1e-12)


def test_right_is_right_looking_outward() -> None:
    """Verifies: which secondary is "right".
    Setup: the forward leg (+Z): right is +Y. The right leg (+Y): looking outward from the vehicle, right is aft, -Z.
    Tolerance: exact; half the truss width.
    """
    forward, starboard = (leg_geometry(DIMENSIONS, azimuth, CG_HEIGHT, 0.812) for azimuth in (0.0, 0.5 * pi))
    assert forward.right[1] == pytest.approx(0.5 * 2.239, rel=1e-12)
    assert forward.left[1] == pytest.approx(-0.5 * 2.239, rel=1e-12)
    assert starboard.right[2] == pytest.approx(-0.5 * 2.239, rel=1e-12)
    assert starboard.pad[1] == pytest.approx(4.242, rel=1e-12)


@pytest.mark.parametrize("count", [3, 4, 6, 8])
def test_any_number_of_legs_is_one_leg_turned(count: int) -> None:
    """Verifies: azimuth symmetry, +Z towards +Y.
    Setup: every joint of leg k is that of the first turned by scipy about x, by minus the azimuth (Y to Z is the positive sense).
    Tolerance: 1e-14 m, roundings.
    """
    first = leg_geometry(DIMENSIONS, 0.0, CG_HEIGHT, 0.812)
    for k in range(count):
        azimuth = 2.0 * pi * k / count
        leg = leg_geometry(DIMENSIONS, azimuth, CG_HEIGHT, 0.812)
        turn = Rotation.from_rotvec([-azimuth, 0.0, 0.0])
        for ours, other in zip(leg[:4], first[:4], strict=True):
            np.testing.assert_allclose(ours, turn.apply(other), atol=4e-15)
        np.testing.assert_allclose(leg[4:], first[4:], rtol=1e-14)


@pytest.mark.parametrize(
    ("change", "limit", "message"),
    [
        ({"connection": 3.1}, 0.812, "connection is 3.1 m, must be below the primary's length 3.01"),
        ({}, 1.2, "primary stroke limit is 1.2 m, must be above 0 and below connection 1.157 m"),
        ({}, float("nan"), "primary stroke limit is nan m"),
        ({"footprint_radius": -1.0}, 0.812, "footprint_radius is -1 m, must be above 0"),
        ({"connection": float("inf")}, 0.812, "connection is inf m, must be above 0"),
        ({"truss_height_upper": 0.05}, 0.812, "truss_height_upper is 0.05 m, must be above footpad_height 0.1 m"),
        ({"secondary_truss_width": 0.01, "truss_radius_lower": 3.789, "truss_height_lower": 1.165}, 0.812, "lower truss coincide"),
    ],
)
def test_a_leg_that_cannot_close_is_refused_with_its_numbers(change: dict[str, float], limit: float, message: str) -> None:
    """Verifies: GeometryError for every impossible leg, with the dimension and the limit.
    Setup: one dimension at a time out of its range.
    Tolerance: the message word by word.
    """
    with pytest.raises(GeometryError) as error:
        leg_geometry(DIMENSIONS._replace(**change), 0.0, CG_HEIGHT, limit)
    assert message in str(error.value)
    assert isnan(limit) or "nan" not in str(error.value)
