"""Relief of the ground: interpolation, normals, craters and boulders, and a footpad on them."""

import math
from typing import Any

import numpy as np
import pytest
from lander.laws.crater import Boulder, Crater, boulder_profile, crater_height, crater_profile
from lander.laws.footpad import COLUMNS, POINTS, Footpad, PadMotion, pad_wrench, start_memory
from lander.laws.height_map import HeightMap, map_height
from lander.laws.relief import Relief
from lander.laws.soil import Soil, predicted_depth
from lander.laws.soil_stepping import InterfaceModel, PadStart, Shift, step_soil
from lander.laws.surface import Surface, depth_at, gap_at, inclined_plane, normal_at
from lander.laws.vectors import ZERO, identity, rotation
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

NO_MAP = HeightMap(np.zeros((0, 0)), 0.0, 0.0, 1.0, 1.0, 1.0, 0.0)
LEVEL = Surface(ZERO, (1.0, 0.0, 0.0))
UPRIGHT = rotation((1.0, 0.0, 0.0, 0.0))


def rough_map(heading: float = 0.0) -> HeightMap:
    """Nodes 0.3 m apart to the north, 0.4 m to the east, heights of a few centimetres."""
    heights = 0.05 * np.random.default_rng(3).standard_normal((21, 17))
    return HeightMap(heights, -3.0, -3.2, 0.3, 0.4, math.cos(heading), math.sin(heading))


def relief(m: HeightMap = NO_MAP, craters: Any = (), boulders: Any = ()) -> Relief:
    return Relief(m, np.array(craters, dtype=float).reshape(-1, 5), np.array(boulders, dtype=float).reshape(-1, 4))


def varied_surface() -> Surface:
    """A slope, a turned map, a crater and a boulder at once."""
    crater, boulder = Crater(0.4, -0.3, 1.6, 0.2, 0.05), Boulder(-0.5, 0.6, 0.4, 0.2)
    return inclined_plane(0.08, 0.4)._replace(relief=relief(rough_map(0.7), [crater], [boulder]))


def keys_along(nodes: Any, step: float, at: float) -> float:
    """Keys' interpolation in one dimension, built by scipy: a cubic Hermite spline with central differences as slopes."""
    slopes = (nodes[2:] - nodes[:-2]) / (2.0 * step)
    return float(CubicHermiteSpline(step * np.arange(1, len(nodes) - 1), nodes[1:-1], slopes)(at))


def test_a_map_between_its_nodes_is_scipys_hermite_spline_along_each_axis() -> None:
    """Verifies: bicubic convolution (Keys 1981, a = -1/2).

    Setup: 200 places on a rough tile; the reference goes along each row by scipy.interpolate.CubicHermiteSpline, then across.
    Tolerance: 1e-14 m on 0.1 m, rounding.
    """
    m = rough_map()
    for y, z in np.random.default_rng(1).uniform(-2.0, 2.0, (200, 2)):
        rows = np.array([keys_along(row, m.step_east, y - m.east) for row in m.heights])
        assert map_height(m, y, z).value == pytest.approx(keys_along(rows, m.step_north, z - m.north), abs=1e-14)


def test_a_map_goes_through_its_nodes_and_is_exact_for_a_paraboloid() -> None:
    """Verifies: nodes are kept; polynomials of second order come back with slope and curvature. Tolerance: rounding, 1e-13 relative."""
    m = rough_map()
    assert map_height(m, m.east + 5 * m.step_east, m.north + 7 * m.step_north).value == pytest.approx(m.heights[7, 5], abs=1e-14)
    north, east = m.north + m.step_north * np.arange(21)[:, None], m.east + m.step_east * np.arange(17)[None, :]
    h = map_height(m._replace(heights=0.1 * north**2 - 0.2 * north * east + 0.3 * east), 0.77, -1.13)
    value, h_y, h_z = 0.1 * 1.13**2 + 0.2 * 1.13 * 0.77 + 0.3 * 0.77, 0.3 + 0.2 * 1.13, -0.2 * 1.13 - 0.2 * 0.77
    assert tuple(h) == pytest.approx((value, h_y, h_z, 0.0, -0.2, 0.2), abs=1e-12)


def test_a_turned_map_is_read_along_its_own_north() -> None:
    """A heading of 90 degrees: L's +Z looks east, +Y south. Tolerance: rounding."""
    straight, turned = rough_map(), rough_map(0.5 * math.pi)
    assert map_height(turned, -0.9, 1.1).value == pytest.approx(map_height(straight, 1.1, 0.9).value, abs=1e-14)


def test_outside_the_map_and_beside_a_missing_node_there_is_no_height() -> None:
    m = rough_map()
    m.heights[10, 8] = math.nan
    y, z = m.east + 8 * m.step_east, m.north + 10 * m.step_north
    for away in (0.0, 0.5, 1.9):
        assert math.isnan(map_height(m, y + away * m.step_east, z).value)
    assert math.isfinite(map_height(m, y + 2.1 * m.step_east, z).value)
    assert math.isnan(map_height(m, 0.0, 50.0).value)


def test_the_normal_is_that_of_finite_differences_of_the_height() -> None:
    """Verifies: normals of map, crater, boulder and slope together.

    Setup: 300 places; the normal from central differences of the gap over 1e-6 m. Tolerance: 1e-8, twice the differences' own error.
    """
    surface, e = varied_surface(), 1e-6
    for y, z in np.random.default_rng(5).uniform(-1.5, 1.5, (300, 2)):
        slope_y = -(gap_at(surface, (0.0, y + e, z)) - gap_at(surface, (0.0, y - e, z))) / (2.0 * e)
        slope_z = -(gap_at(surface, (0.0, y, z + e)) - gap_at(surface, (0.0, y, z - e))) / (2.0 * e)
        length = math.sqrt(1.0 + slope_y**2 + slope_z**2)
        assert normal_at(surface, (0.0, y, z)) == pytest.approx((1.0 / length, -slope_y / length, -slope_z / length), abs=1e-8)


def test_a_crater_has_the_depth_rim_and_flank_of_its_closed_form() -> None:
    """Verifies: Pike's numbers for a fresh crater, h = d (r/R)² - (d - h_r) inside and h_r (R/r)³ outside, away from the rounded crest.

    Tolerance: rounding; the crest within a fifth of the rim's height, as the profile's docstring says.
    """
    c = Crater(1.0, 2.0, 10.0, 1.96, 0.36)
    assert crater_height(c, 1.0, 2.0).value == pytest.approx(-1.6, abs=1e-12)
    assert crater_height(c, 1.0, 5.0).value == pytest.approx(1.96 * 0.36 - 1.6, abs=1e-12)
    assert crater_height(c, 1.0 + 10.0, 2.0).value == pytest.approx(0.36 / 8.0, abs=1e-12)
    assert 0.8 * 0.36 < crater_profile(c, 5.0)[0] < 0.36


@pytest.mark.parametrize("profile", ["crater", "boulder", "steep boulder"])
def test_profiles_have_a_continuous_slope_and_their_own_derivatives(profile: str) -> None:
    """Verifies: h', h'/r, h''. Setup: central differences on a grid that does not meet the seams. Tolerance: differences' error."""
    shapes = {
        "crater": lambda r: crater_profile(Crater(0.0, 0.0, 2.0, 0.4, 0.07), r),
        "boulder": lambda r: boulder_profile(Boulder(0.0, 0.0, 0.5, 0.2), r),
        "steep boulder": lambda r: boulder_profile(Boulder(0.0, 0.0, 0.5, 0.6), r),
    }
    at, e = shapes[profile], 1e-6
    for r in np.linspace(0.011, 2.5, 997):
        _, first, over, second = at(r)
        assert first == pytest.approx((at(r + e)[0] - at(r - e)[0]) / (2.0 * e), abs=1e-4)
        assert over == pytest.approx(first / r, abs=1e-12)
        if abs(at(r + 2 * e)[3] - at(r - 2 * e)[3]) < 1e-3:
            assert second == pytest.approx((at(r + e)[1] - at(r - e)[1]) / (2.0 * e), abs=1e-3)


SOIL = Soil(1, 70e3, 1.0, 2e3, 0.05, 1e-4, 1e-2, 0.33, 300.0, 1e-2)


def test_the_pads_tangents_on_a_relief_are_those_of_finite_differences() -> None:
    """Verifies: -dF/dx and -dF/dv of the wrench over curved ground, with the turning of the normal.

    Setup: a pad some millimetres deep on map, crater and boulder, sinking and sliding; central differences. Tolerance: 1e-6
    of the largest entry; the differences' own error.
    """
    surface, pad, memory = varied_surface(), Footpad(0.05, 0.1), np.zeros((POINTS, COLUMNS))
    y, z = 0.55, 0.5
    x = 0.1 - gap_at(surface, (0.0, y, z)) - 0.02
    motion = PadMotion((x, y, z), UPRIGHT, (-0.015, 0.1, -0.05), (0.0, 0.0, 0.0))
    start_memory(surface, pad, motion, memory)
    tangents = pad_wrench(SOIL, surface, pad, motion, memory)[1]

    def force(position: Any, velocity: Any) -> Any:
        moved = motion._replace(position=tuple(position), velocity=tuple(velocity))
        return np.array(pad_wrench(SOIL, surface, pad, moved, memory)[0].force)

    for k, e, by_place in ((tangents.k_xx, 1e-7, True), (tangents.c_xx, 1e-6, False)):
        numeric = np.zeros((3, 3))
        for j in range(3):
            d = e * np.eye(3)[j]
            p, v = np.array(motion.position), np.array(motion.velocity)
            numeric[:, j] = -(force(p + d, v) - force(p - d, v) if by_place else force(p, v + d) - force(p, v - d)) / (2.0 * e)
        assert np.array(k) == pytest.approx(numeric, abs=1e-6 * np.abs(numeric).max())


def flown(soil: Soil, surface: Surface, pad: Footpad, mass: float, place: Any, velocity: Any, time: float, interval: float) -> Any:
    """A free mass with a pad that cannot turn, at most 0.5 ms a substep: its path, and its memory at the end."""
    model = InterfaceModel((-1.63, 0.0, 0.0), identity(1.0 / mass), identity(0.0), identity(0.0), ZERO, ZERO, ZERO, 0.0, ZERO)
    memory = np.zeros((POINTS, COLUMNS))
    at = PadMotion(place, UPRIGHT, velocity, ZERO)
    start_memory(surface, pad, at, memory)
    path = [(*at.position, *at.velocity)]
    for _ in range(round(time / interval)):
        start = PadStart(at.position, (1.0, 0.0, 0.0, 0.0), at.velocity, ZERO)
        at, _, _, _, ok = step_soil(soil, surface, pad, model, start, Shift(ZERO, ZERO), memory, interval, 5e-4)
        assert ok
        path.append((*at.position, *at.velocity))
    return np.array(path), memory


def test_a_frictionless_point_in_a_bowl_slides_as_an_independent_integrator_says_and_keeps_its_energy() -> None:
    """Verifies: depth, normal and force belong together on curved ground.

    Setup: 100 kg on hard, frictionless soil (law 2) in a bowl h = a (y² + z²), pushed sideways; reference: Lagrange's equations of a
    bead on that surface, scipy's DOP853 at 1e-12. Tolerance: 1 um of 2.7 m of way after 4 s, and 2e-5 of the energy exchanged. Both grow
    with the depth, here 16 um, as decision 12 says (measured: 0.07 um and 6.5e-6; at 1.6 mm of depth a hundred times that).
    """
    a, gravity = 0.125 / 2.0, 1.63
    bowl = LEVEL._replace(relief=relief(craters=[Crater(0.0, 0.0, 8.0, 1.0, 0.0)]))
    hard = Soil(2, 2e6, 1.0, 0.0, 0.0, 1e-5, 1e-4, 0.0, 0.0, 1e-3)
    y0, vz = 1.8, 0.5
    sunk = 100.0 * gravity / 1e7
    start = (a * y0 * y0 - 1.0 - sunk, y0, 0.0)

    def bead(_: float, s: Any) -> Any:
        y, z, v, w = s
        slope = 2.0 * a * np.array((y, z))
        curved = 2.0 * a * (v * v + w * w)
        push = -(gravity + curved) / (1.0 + slope @ slope) * slope
        return (v, w, *push)

    reference = solve_ivp(bead, (0.0, 4.0), (y0, 0.0, 0.0, vz), method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    path, _ = flown(hard, bowl, Footpad(1e-6, 0.0), 100.0, start, (0.0, 0.0, vz), 4.0, 1e-2)
    assert path[-1, 1:3] == pytest.approx(reference[:2], abs=1e-6)
    energy = gravity * path[:, 0] + 0.5 * (path[:, 3:] ** 2).sum(axis=1)
    exchanged = gravity * np.ptp(path[:, 0])
    assert np.ptp(energy) < 2e-5 * exchanged


def test_a_pad_set_down_on_a_boulder_rests_on_its_middle_at_the_depth_of_equation_10() -> None:
    """Verifies: a boulder carries one point.

    Setup: 200 kg set down on the top of a boulder of 0.15 m, published law; eq. 10 with a fifth of K_n. Tolerance: 2 %, what the residual
    sink rate does to eq. 10 in Figure 11's check as well.
    """
    boulder = LEVEL._replace(relief=relief(boulders=[Boulder(0.0, 0.0, 0.4, 0.15)]))
    soil, pad = SOIL._replace(damping=0.0, ramp=0.0, residual=1e-4, friction=0.33), Footpad(0.47, 0.1)
    path, memory = flown(soil, boulder, pad, 200.0, (0.25, 0.0, 0.0), ZERO, 0.6, 1e-3)
    depth = predicted_depth(200.0, 1.63, 70e3, 1.0)
    assert 0.25 - path[-1, 0] == pytest.approx(depth, rel=0.02)
    assert all(memory[i, 7] < 0.0 for i in range(1, POINTS)), "the rim hangs in the air"


def test_a_pad_on_a_boulder_beside_its_middle_is_turned_away_from_it() -> None:
    """A boulder under the +Y point lifts that side: the torque about Z is negative (Y goes up about -Z). No tolerance: a sign."""
    surface = LEVEL._replace(relief=relief(boulders=[Boulder(0.47, 0.0, 0.4, 0.15)]))
    pad, memory = Footpad(0.47, 0.1), np.zeros((POINTS, COLUMNS))
    motion = PadMotion((0.24, 0.0, 0.0), UPRIGHT, (-0.1, 0.0, 0.0), ZERO)
    start_memory(surface, pad, motion, memory)
    wrench, _ = pad_wrench(SOIL, surface, pad, motion, memory)
    assert wrench.force[0] > 0.0
    assert wrench.torque[2] < 0.0


def test_a_level_map_is_the_plane_to_the_last_bit() -> None:
    m = HeightMap(np.zeros((9, 9)), -2.0, -2.0, 0.5, 0.5, 1.0, 0.0)
    flat, plane = LEVEL._replace(relief=relief(m)), LEVEL
    for x in np.random.default_rng(2).uniform(-1.0, 1.0, (50, 3)):
        assert depth_at(flat, tuple(x)) == depth_at(plane, tuple(x))
        assert normal_at(flat, tuple(x)) == normal_at(plane, tuple(x))
