"""A leg whose body is held: it hands a force on to the body, crushes under a larger one and stays crushed, and moves with its body."""

import numpy as np
import pytest
from piece import Array, Piece, of, turned

KIND = "GearLeg"
H = 5e-3
HELD = {"body.position": (4.0, 0.0, 0.0), "body.quaternion": (1.0, 0.0, 0.0, 0.0), "body.velocity": (0.0, 0.0, 0.0),
        "body.angular_velocity": (0.0, 0.0, 0.0), "body.acceleration": (0.0, 0.0, 0.0), "body.angular_acceleration": (0.0, 0.0, 0.0)}
BELOW, ABOVE = 1000.0, 12000.0      # N: borne without crushing; more than any strut of this class bears


def pushed(piece: Piece, peak: Array, stop: float, release: float = 1e9, held: dict[str, tuple[float, ...]] = HELD) -> dict[str, Array]:
    """A force on the pad that grows over 0.1 s, stays, and goes over 0.05 s after `release`."""
    def course(t: float) -> dict[str, object]:
        share = min(1.0, t / 0.1) if t < release else max(0.0, 1.0 - (t - release) / 0.05)
        return {**held, "pad.force": share * peak}

    piece.ready({**held, "pad.force": np.zeros(3)})
    return piece.run(course, stop, H)


def test_a_leg_that_nothing_touches_hangs_still(piece: Piece) -> None:
    """Half a centimetre and 300 N, thrice the weight of a leg on the Moon: what a leg may sag and weigh."""
    piece.ready(HELD)
    start = piece.vector("pad.position")
    columns = pushed(piece, np.zeros(3), 0.5)
    assert np.abs(of(columns, "pad.position") - start).max() < 5e-3
    assert np.abs(of(columns, "mount.force")).max() < 300.0


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)])
def test_a_force_on_the_pad_reaches_the_body_whole(piece: Piece, direction: tuple[float, float, float]) -> None:
    """Statics: force F and torque r × F about B's origin, r from there to the ball joint. 5 % and 60 N for what still moves."""
    force = BELOW * np.array(direction)
    piece.ready(HELD)
    without = pushed(piece, np.zeros(3), 1.0)
    columns = pushed(piece, force, 1.0)
    got, moment = (of(columns, f"mount.{m}")[-1] - of(without, f"mount.{m}")[-1] for m in ("force", "torque"))
    lever = of(columns, "pad.position")[-1] - np.array(HELD["body.position"])
    assert got == pytest.approx(force, abs=0.05 * BELOW + 10.0)
    assert moment == pytest.approx(np.cross(lever, force), abs=(0.05 * BELOW + 10.0) * float(np.linalg.norm(lever)))


def test_a_large_force_crushes_the_leg_and_it_stays_crushed(piece: Piece) -> None:
    """Pushed up and let go: the pad moves up relative to the body, keeps at least half of it, and most of the work is not given back."""
    piece.ready(HELD)
    start = piece.vector("pad.position")
    columns = pushed(piece, np.array([ABOVE, 0.0, 0.0]), 0.6, release=0.2)
    rise = of(columns, "pad.position")[:, 0] - start[0]
    assert rise.max() > 0.01
    assert rise[-1] > 0.5 * rise.max()
    assert np.abs(of(columns, "pad.velocity")[-1]).max() < 0.3
    times = H * np.arange(1, len(rise) + 1)
    share = np.where(times < 0.2, np.minimum(1.0, times / 0.1), np.maximum(0.0, 1.0 - (times - 0.2) / 0.05))
    power = ABOVE * share * of(columns, "pad.velocity")[:, 0]
    assert np.trapezoid(power, times) > 0.5 * np.trapezoid(np.maximum(power, 0.0), times)
    if piece.has("energy.dissipated"):
        assert columns["energy.dissipated"][-1] > 0.5 * np.trapezoid(power, times)


def test_a_leg_moves_with_its_body(piece: Piece) -> None:
    """At a constant velocity nothing but the place changes."""
    v = np.array([-0.5, 0.3, -0.2])
    start = np.array(HELD["body.position"])
    piece.ready({**HELD, "body.velocity": v})
    pad = piece.vector("pad.position")
    columns = piece.run(lambda t: {**HELD, "body.position": start + v * t, "body.velocity": v}, 0.5, H)
    assert of(columns, "pad.position")[-1] - pad == pytest.approx(0.5 * v, abs=5e-3)
    assert of(columns, "pad.velocity")[-1] == pytest.approx(v, abs=0.02)
    assert np.abs(of(columns, "mount.force")).max() < 300.0


def test_a_body_turned_about_the_vertical_turns_the_pad_and_feels_the_same_in_its_own_frame(piece: Piece) -> None:
    """Gravity acts along that axis, so that nothing else changes; 1 %."""
    angle = 0.7
    q = (float(np.cos(angle / 2)), float(np.sin(angle / 2)), 0.0, 0.0)
    force = np.array([800.0, 300.0, -200.0])
    straight = pushed(piece, force, 0.3)
    turned_body = pushed(piece, turned(np.array(q), force), 0.3, held={**HELD, "body.quaternion": q})
    origin = np.array(HELD["body.position"])
    pad, expected = of(turned_body, "pad.position")[-1] - origin, turned(np.array(q), of(straight, "pad.position")[-1] - origin)
    assert pad == pytest.approx(expected, abs=1e-3)
    for member in ("mount.force", "mount.torque"):
        one, other = of(straight, member)[-1], of(turned_body, member)[-1]
        assert other == pytest.approx(one, abs=0.01 * float(np.abs(one).max()))
