"""A rate sensor gives each of three rates as its own, with its sign, late at most."""

from math import exp

import numpy as np
import pytest
from piece import Piece, of

KIND = "RateSensor"
AXES = ("yaw", "pitch", "roll")


def received(piece: Piece, rates: dict[str, float], stop: float = 5.0, step: float = 0.02, **parameters: float) -> np.ndarray:
    """Telemetry of constant rates that begin at t = 0."""
    piece.ready({}, **parameters)
    columns = piece.run(lambda t: {f"rates.{axis}": rates.get(axis, 0.0) for axis in AXES}, stop, step)
    return np.hstack([of(columns, f"telemetry.{axis}") for axis in AXES])


@pytest.mark.parametrize("rate", [0.4, -0.4])
@pytest.mark.parametrize("axis", AXES)
def test_a_lasting_rate_arrives_on_its_own_channel_with_its_sign(piece: Piece, axis: str, rate: float) -> None:
    """Within a tenth: scale, bias and quantum of an honest gyro are smaller by far; a wrong sign or axis is ten times that."""
    last = received(piece, {axis: rate})[-1]
    for other, value in zip(AXES, last, strict=True):
        assert value == pytest.approx(rate if other == axis else 0.0, abs=0.1 * abs(rate)), f"telemetry.{other} for rates.{axis} = {rate}"


def test_nothing_arrives_before_it_happens_and_nothing_overshoots(piece: Piece) -> None:
    """A step of the rate is never more than itself, a tenth for scale and quantum aside, and never of the other sign."""
    yaw = received(piece, {"yaw": 0.4}, stop=2.0)[:, 0]
    assert yaw.min() > -0.04
    assert yaw.max() < 0.44


def test_a_lag_delays_a_step_as_first_order_does(piece: Piece) -> None:
    """y = u (1 - exp(-t/τ)) for units with the parameter `time_constant`; 2 % for an integrator of their own."""
    if not piece.has("time_constant"):
        pytest.skip("has no parameter time_constant")
    yaw = received(piece, {"yaw": 0.4}, stop=1.0, step=0.01, time_constant=0.2)[:, 0]
    for t in (0.1, 0.2, 0.5, 1.0):
        assert yaw[round(t / 0.01) - 1] == pytest.approx(0.4 * (1.0 - exp(-t / 0.2)), abs=0.008)


@pytest.mark.parametrize("about", range(3))
def test_a_small_rotation_of_the_axes_adds_its_cross_product_with_the_rates(piece: Piece, about: int) -> None:
    """φ about X and a rate about Y give φ times it about Z, and so round; the rates are yaw about X, pitch about Y, roll about Z."""
    if not piece.has("misalignment[1]"):
        pytest.skip("has no parameter misalignment")
    turning, turned = (about + 1) % 3, (about + 2) % 3
    last = received(piece, {AXES[turning]: 0.4}, stop=0.1, **{f"misalignment[{about + 1}]": 0.05})[-1]
    expected = np.zeros(3)
    expected[turning], expected[turned] = 0.4, 0.02
    assert last == pytest.approx(expected, abs=1e-12)  # rounding of numbers below 1
