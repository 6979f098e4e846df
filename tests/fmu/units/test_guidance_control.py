"""Guidance may do what it likes with the engine before contact; what it says must hang together, and after contact the engine goes off."""

import numpy as np
import pytest
from piece import Array, Piece, of

KIND = "GuidanceControl"
H = 0.02
THRUST = {"thrust_before_contact": 8000.0, "thrust_start": 8000.0, "decay_time": 0.5}      # for units that have these parameters
DESCENT = {"body.position": (8.0, 0.0, 0.0), "body.velocity": (-0.8, 0.1, 0.0)}


def flown(piece: Piece, contact: float, stop: float, step: float = H) -> dict[str, Array]:
    """A level descent with all pads touching at a time."""
    def course(t: float) -> dict[str, object]:
        height = 8.0 - 0.8 * min(t, contact)
        signals = {f"contact{k}": float(t >= contact - 1e-9) for k in range(1, 5)}
        return {"body.position": (height, 0.0, 0.0), "body.velocity": (-0.8 if t < contact else 0.0, 0.0, 0.0), **signals}

    piece.ready(DESCENT, **THRUST)
    return piece.run(course, stop, step)


def test_the_wrench_before_contact_is_that_of_one_lander(piece: Piece) -> None:
    """The descent engine gave at most 47 kN; it pushes up, and about a metre's lever at most."""
    columns = flown(piece, 1e9, 2.0)
    force, torque = of(columns, "engine.force"), of(columns, "engine.torque")
    assert force[:, 0].min() >= -1e-6
    assert np.linalg.norm(force, axis=1).max() < 6e4
    assert np.linalg.norm(torque, axis=1).max() < 6e4


def test_after_contact_the_engine_goes_off_and_stays_off(piece: Piece) -> None:
    """Within five seconds: a tail-off takes about one."""
    columns = flown(piece, 1.0, 8.0)
    late = of(columns, "engine.force")[round(6.0 / H):]
    assert np.abs(late[:, 0]).max() < 100.0


def test_what_it_says_of_the_engine_hangs_together(piece: Piece) -> None:
    columns = flown(piece, 1.0, 3.0)
    force = of(columns, "engine.force")
    if piece.has("engine.thrust"):
        thrust = of(columns, "engine.thrust")[:, 0]
        assert (np.linalg.norm(force, axis=1) >= 0.9 * thrust - 1.0).all()
    if piece.has("engine.on"):
        assert (np.abs(force[of(columns, "engine.on")[:, 0] == 0.0, 0]) < 100.0).all()


def test_mean_forces_add_up_to_the_same_impulse_for_every_step(piece: Piece) -> None:
    """Whole impulse over 3 s with steps of H and H/2; 5 % of it for a controller that samples."""
    if not piece.has("engine.force_mean"):
        pytest.skip("gives no mean")
    coarse, fine = (step * of(flown(piece, 1.0, 3.0, step), "engine.force_mean").sum(axis=0) for step in (H, H / 2))
    assert fine == pytest.approx(coarse, abs=0.05 * float(np.abs(coarse).max()) + 1.0)
