"""Data of docs/real-cases.md, third case: a landing of our own whose rates went through a telemetry filter.

Written to scenarios/measured/smoothed_rates (rates and attitude) and smoothed_rates_alone (the same rates by themselves). The landing is
the co-simulation of apollo11_zupp.toml, what its priors leave open drawn from them.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from orchestrator.diagnosis.flight import CoSimulation
from orchestrator.diagnosis.measured import Measured, Prior, Series, write_measured

SCENARIOS = Path(__file__).resolve().parents[1] / "scenarios"
LAG = 0.05  # s
INTERVAL = 0.05  # s: 20 Hz
LENGTH = 3.0  # s
SIGMA = {"rates": 0.0017, "attitude": 0.0009}  # rad/s, rad
SEED = 11
AXES = ("yaw", "pitch", "roll")
STARTS = {
    "velocity_body": ([-0.5730, -0.6147, -0.2130], 0.03, "m/s"),
    "attitude": ([0.263370, 0.016459, 0.044419], 0.0035, "rad"),
    "rates": ([-0.0108, 0.0, -0.05], 0.00175, "rad/s"),
    "ground_slope": ([0.078540], 0.007, "rad"),
    "ground_azimuth": ([0.0], 0.07, "rad"),
}
SOIL = {"soil.bearing_strength": ([350254.0], 0.12), "soil.friction": ([0.33], 0.03)}


def landed(random: np.random.Generator) -> dict[str, np.ndarray]:
    """Noisy samples (n, 3) of each series, at multiples of INTERVAL since first contact."""
    moved = {name: np.array(mean) + sigma * random.standard_normal(len(mean)) for name, (mean, sigma, _) in STARTS.items()}
    drawn = {name: value if len(value) > 1 else value[0] for name, value in moved.items()}
    drawn["soil.bearing_strength"] = SOIL["soil.bearing_strength"][0][0] * np.exp(0.12 * random.standard_normal())
    drawn["soil.friction"] = SOIL["soil.friction"][0][0] + 0.03 * random.standard_normal()
    columns = {"rates": [f"sensor.telemetry.{a}" for a in AXES], "attitude": [f"body.attitude.{a}" for a in AXES]}
    flown = CoSimulation(SCENARIOS / "apollo11_zupp.toml")
    flight = flown.fly({**drawn, "sensor.time_constant": LAG}, stop=LENGTH, columns=[c for some in columns.values() for c in some])
    flown.close()
    if flight.course is None:
        raise SystemExit(flight.reason)
    course = flight.course
    clean = {s: np.column_stack([np.interp(times(), course.times, course.columns[c]) for c in some]) for s, some in columns.items()}
    return {series: rows + SIGMA[series] * random.standard_normal(rows.shape) for series, rows in clean.items()}


def times() -> np.ndarray:
    return np.round(np.arange(0.0, LENGTH + 0.5 * INTERVAL, INTERVAL), 6)


def measured(samples: dict[str, np.ndarray]) -> Measured:
    """What the instruments handed over; nothing of it tells of the filter."""
    units = {"rates": ("rad/s",) * 3, "attitude": ("rad",) * 3}
    series = [
        Series(name, tuple(f"{name}.{a}" for a in AXES), times(), rows.round(7), np.full(3, SIGMA[name]), 0.0, units[name])
        for name, rows in samples.items()
    ]
    priors = [Prior(name, np.array(mean), np.full(len(mean), sigma), None, unit) for name, (mean, sigma, unit) in STARTS.items()]
    priors.append(Prior("soil.bearing_strength", np.array(SOIL["soil.bearing_strength"][0]), None, np.array([0.12])))
    priors.append(Prior("soil.friction", np.array(SOIL["soil.friction"][0]), np.array([0.03]), None))
    source = "benchmarks/smoothed_rates.py: the co-simulation of apollo11_zupp.toml, rates through a RateSensor; not a measurement"
    return Measured("Rates and attitude, the rates smoothed by telemetry", source, Path(), series, [], priors)


def main() -> None:
    whole = measured(landed(np.random.default_rng(SEED)))
    write_measured(SCENARIOS / "measured" / "smoothed_rates", whole)
    alone = replace(whole, title="The same rates by themselves", series=[one for one in whole.series if one.name == "rates"])
    write_measured(SCENARIOS / "measured" / "smoothed_rates_alone", alone)


if __name__ == "__main__":
    main()
