"""Soil under one footpad that is moved by hand: it pushes up, never pulls hard, brakes a slide, and takes energy."""

import numpy as np
import pytest
from piece import Array, Piece, of

KIND = "RegolithContact"
H = 2e-3


def touching(piece: Piece, y: float = 0.0, z: float = 0.0) -> float:
    """Height of the ball joint at which the pad just touches, m."""
    height = 3.0
    piece.ready({"pad.position": (height, y, z)})
    return height - piece["gap"]


def moved(
    piece: Piece, velocity: tuple[float, ...], stop: float, above: float = 1e-3, y: float = 0.0, z: float = 0.0
) -> dict[str, Array]:
    """The pad carried at a constant velocity, from a little above the ground."""
    start, v = np.array([touching(piece, y, z) + above, y, z]), np.array(velocity)
    piece.ready({"pad.position": start, "pad.velocity": v})
    return piece.run(lambda t: {"pad.position": start + v * t, "pad.velocity": v}, stop, H)


def test_above_the_ground_it_does_nothing_and_knows_its_gap(piece: Piece) -> None:
    columns = moved(piece, (-0.5, 0.3, 0.0), 0.05, above=0.1)
    assert np.abs(of(columns, "pad.force")).max() == 0.0
    assert not of(columns, "contact").any()
    assert columns["gap"][0] - columns["gap"][-1] == pytest.approx(0.5 * (0.05 - H), rel=0.02)


def test_a_pad_pressed_down_is_pushed_up_the_more_the_deeper(piece: Piece) -> None:
    """Monotone from step to step, a twentieth of the peak aside: a law may soften, it may not let go."""
    columns = moved(piece, (-0.2, 0.0, 0.0), 0.15)
    force = of(columns, "pad.force")
    assert of(columns, "contact")[-1] == 1.0
    assert columns["gap"][-1] < -0.02
    assert force[-1, 0] > 100.0
    assert np.diff(force[:, 0]).min() > -0.05 * force[:, 0].max()
    assert np.abs(force[:, 1:]).max() < 0.05 * force[:, 0].max()


@pytest.mark.parametrize(("axis", "speed"), [(1, 0.3), (1, -0.3), (2, 0.3), (2, -0.3)])
def test_a_slide_is_braked_along_its_own_line(piece: Piece, axis: int, speed: float) -> None:
    velocity = np.array([-0.1, 0.0, 0.0])
    velocity[axis] = speed
    force = of(moved(piece, tuple(velocity), 0.2), "pad.force")[-1]
    assert force[axis] * speed < 0.0
    assert 0.02 * force[0] < abs(force[axis]) < 3.0 * force[0]
    assert abs(force[3 - axis]) < 0.1 * abs(force[axis])


def test_the_ground_is_the_same_to_the_left_and_to_the_right(piece: Piece) -> None:
    """Mirrored motion, mirrored force, on level ground: 1 %."""
    left, right = (of(moved(piece, (-0.1, speed, 0.0), 0.2), "pad.force")[-1] for speed in (0.3, -0.3))
    assert right == pytest.approx(left * (1.0, -1.0, 1.0), abs=0.01 * float(np.abs(left).max()))


def test_the_ground_is_the_same_a_metre_away(piece: Piece) -> None:
    """On level ground the place does not count: 1 %."""
    here, there = (of(moved(piece, (-0.1, 0.1, 0.0), 0.2, y=y, z=z), "pad.force")[-1] for y, z in ((0.0, 0.0), (1.0, -2.0)))
    assert there == pytest.approx(here, abs=0.01 * float(np.abs(here).max()))


def test_it_takes_energy_and_gives_back_less(piece: Piece) -> None:
    """Pressed 2 cm in and drawn out: what the pad's hand puts in, ∫F·v, stays positive, and above the ground there is no force."""
    top, v = touching(piece) + 1e-3, 0.2

    def height(t: float) -> tuple[float, float]:
        return (top - v * t, -v) if t < 0.1 - 1e-9 else (top - 0.2 * v + v * t, v)

    def course(t: float) -> dict[str, tuple[float, float, float]]:
        x, rate = height(t)
        return {"pad.position": (x, 0.0, 0.0), "pad.velocity": (rate, 0.0, 0.0)}

    piece.ready(course(0.0))
    columns = piece.run(course, 0.25, H)
    force = of(columns, "pad.force")[:, 0]
    times = H * np.arange(1, len(force) + 1)
    given = -np.trapezoid(force * np.where(times <= 0.1, -v, v), times)
    assert given > 0.2 * force.max() * 0.01
    assert force[times > 0.1].min() > -0.2 * force.max()
    assert force[-1] == pytest.approx(0.0, abs=1e-6 * force.max())
    if piece.has("pad.work"):
        assert columns["pad.work"][-1] == pytest.approx(given, rel=0.1)
