"""RateSensor through FMI against closed forms."""

from collections.abc import Callable
from math import exp, floor, pi, sin
from pathlib import Path

import numpy as np
import pytest
from hosted import OK, Hosted

Host = Callable[..., Hosted]
STEPS = [1e-3, 2.5e-3, 4e-4, 7e-3, 1e-2, 1.1e-3, 2e-2, 3e-3] * 8


def driven(one: Hosted, rate: float, slope: float) -> list[tuple[float, float]]:
    """Times and received yaw rates when the true rate is a ramp, over uneven steps that end on whole nanoseconds."""
    now, rows = 0, []
    for step in STEPS:
        one["rates.yaw"], one["rates.yaw_slope"] = rate + slope * now * 1e-9, slope
        ns = round(step * 1e9)
        assert one.step(now * 1e-9, ns * 1e-9) == OK
        now += ns
        rows.append((now * 1e-9, one["telemetry.yaw"]))
    return rows


def test_the_neutral_sensor_gives_its_input(fmus: dict[str, Path], host: Host) -> None:
    for t, received in driven(host(fmus["RateSensor"]), 0.1, -0.4):
        assert received == pytest.approx(0.1 - 0.4 * t, abs=1e-15)


def test_a_lag_behind_a_ramp_is_exact_whatever_the_steps(fmus: dict[str, Path], host: Host) -> None:
    """u = k t from rest: y = k (t - τ + τ exp(-t/τ)); the tolerance is rounding over 64 steps."""
    tau, k = 0.05, 2.0
    for t, received in driven(host(fmus["RateSensor"], time_constant=tau), 0.0, k):
        assert received == pytest.approx(k * (t - tau + tau * exp(-t / tau)), abs=1e-14)


def test_samples_are_taken_on_their_instants_and_held(fmus: dict[str, Path], host: Host) -> None:
    interval, k = 0.02, 3.0
    for t, received in driven(host(fmus["RateSensor"], sample_interval=interval), 0.5, k):
        instant = round(t * 1e9) // 20_000_000 * interval
        assert received == pytest.approx(0.5 + k * instant if instant else 0.0, abs=1e-14)      # at the start the input was zero


def test_quantum_bias_and_scale(fmus: dict[str, Path], host: Host) -> None:
    q = 0.01 * pi / 180
    sensor = host(fmus["RateSensor"], quantum=q, scale=1.5, **{"bias[1]": 0.002})
    for t, received in driven(sensor, 0.1, 0.7):
        assert received == pytest.approx(q * floor((1.5 * (0.1 + 0.7 * t) + 0.002) / q + 0.5), abs=1e-14)


def test_a_sine_sent_as_slopes_comes_out_lagged(fmus: dict[str, Path], host: Host) -> None:
    """A line through the ends of each interval h misses the sine by at most (ωh)²/8."""
    tau, omega, h = 0.1, 5.0, 0.01
    one, y = host(fmus["RateSensor"], time_constant=tau), 0.0
    for n in range(200):
        u, end = sin(omega * n * h), sin(omega * (n + 1) * h)
        one["rates.roll"], one["rates.roll_slope"] = u, (end - u) / h
        assert one.step(n * h, h) == OK
    t = np.linspace(0.0, 2.0, 400_001)
    kernel = np.exp(-(2.0 - t) / tau) / tau * np.sin(omega * t)
    y = float(np.sum(0.5 * (kernel[1:] + kernel[:-1])) * (t[1] - t[0]))
    assert one["telemetry.roll"] == pytest.approx(y, abs=(omega * h) ** 2 / 8)
