"""What instruments make of a landing, written as the data format of docs/diagnosis.md has it, by hand: no code of the project's."""

from __future__ import annotations

from math import degrees, sqrt
from pathlib import Path

import numpy as np

from .landing import LEGS, Array, Course, Landing

GYRO, IMU = 0.0017, 0.0009  # rad/s, rad
COLOUR = 0.3  # AR(1), from sample to sample at 50 Hz
SIGMA = {"stroke": 0.00635, "penetration": 0.006, "skid": 0.01}  # m
PRIOR = """[prior]
velocity_body = {{ mean = {velocity}, sigma = 0.03, unit = "m/s" }}
attitude = {{ mean = {attitude}, sigma = 0.0035, unit = "rad" }}
rates = {{ mean = {rates}, sigma = 0.00175, unit = "rad/s" }}
ground_slope = {{ mean = {slope}, sigma = 0.007, unit = "rad" }}
ground_azimuth = {{ mean = {azimuth}, sigma = 0.07, unit = "rad" }}
"soil.bearing_strength" = {{ mean = {strength}, sigma_log = 0.12 }}
"soil.friction" = {{ mean = {friction}, sigma = 0.03 }}
"""


def write(folder: Path, course: Course, expected: Landing, random: np.random.Generator, lag: float = 0.0) -> None:
    """Rates in deg/s with the axes in another order, attitude in rad, on a clock that starts anywhere; scalars at rest.

    expected   the landing as it was planned: means of the priors;  lag  s, first order, of the gyros
    """
    folder.mkdir(parents=True, exist_ok=True)
    times = np.arange(0.004, 3.0, 0.02)
    clock = times + round(float(random.uniform(50.0, 60.0)), 3)
    rates = sampled(course.times, lagged(course.times, course.rates, lag), times) + noise(random, len(times), GYRO)
    attitude = sampled(course.times, course.attitude, times) + noise(random, len(times), IMU)
    rows(folder / "gyro.csv", "time_s,roll_rate,yaw_rate,pitch_rate", clock, np.degrees(rates[:, [2, 0, 1]]))
    rows(folder / "imu.csv", "time_s,yaw,pitch,roll", clock, attitude)
    lines = [
        'title = "A landing in another engine"', 'source = "MuJoCo"',
        "[series.rates]", 'file = "gyro.csv"', 'unit = "deg/s"', f"sigma = {degrees(GYRO)}", 'colour = "estimate"',
        "[series.attitude]", 'file = "imu.csv"', 'unit = "rad"', f"sigma = {IMU}", 'colour = "estimate"', "[values]",
    ]  # fmt: skip
    for leg in LEGS:
        for name in (*(f"stroke.{leg}.{it}" for it in ("primary", "right", "left")), f"penetration.{leg}", f"skid.{leg}"):
            sigma = SIGMA[name.partition(".")[0]]
            value = course.values[name] + sigma * random.standard_normal()
            lines.append(f'"{name}" = {{ value = {value:.5f}, sigma = {sigma}, unit = "m" }}')
    prior = PRIOR.format(
        velocity=list(expected.velocity), attitude=list(expected.attitude), rates=list(expected.rates), slope=expected.slope,
        azimuth=expected.azimuth, strength=expected.bearing_strength, friction=expected.friction,
    )  # fmt: skip
    (folder / "landing.toml").write_text("\n".join(lines) + "\n" + prior, "utf-8")


def drawn(random: np.random.Generator, expected: Landing) -> dict[str, object]:
    """A landing's own start and ground, from the priors."""
    return {
        "velocity": tuple(random.normal(expected.velocity, 0.03)), "attitude": tuple(random.normal(expected.attitude, 0.0035)),
        "rates": tuple(random.normal(expected.rates, 0.00175)), "slope": random.normal(expected.slope, 0.007),
        "azimuth": random.normal(expected.azimuth, 0.07),
    }  # fmt: skip


def lagged(times: Array, values: Array, constant: float) -> Array:
    """τ dy/dt = u - y, from rest."""
    if constant <= 0.0:
        return values
    found = values.copy()
    share = 1.0 - np.exp(-np.diff(times) / constant)
    for k in range(1, len(times)):
        found[k] = found[k - 1] + share[k - 1] * (values[k] - found[k - 1])
    return found


def sampled(times: Array, values: Array, at: Array) -> Array:
    return np.column_stack([np.interp(at, times, values[:, k]) for k in range(values.shape[1])])


def noise(random: np.random.Generator, count: int, sigma: float) -> Array:
    """AR(1) on three channels."""
    found = sigma * random.standard_normal((count, 3))
    for k in range(1, count):
        found[k] = COLOUR * found[k - 1] + sqrt(1.0 - COLOUR**2) * found[k]
    return found


def rows(file: Path, header: str, times: Array, values: Array) -> None:
    text = [",".join([f"{t:.4f}", *(f"{x:.7f}" for x in row)]) for t, row in zip(times.tolist(), values.tolist(), strict=True)]
    file.write_text("\n".join([header, *text]) + "\n", "utf-8")
