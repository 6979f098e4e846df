"""Makes scenarios/measured/example_soil: two synthetic landings whose soil damps by 20 kN s/m, which no scenario says.

    python benchmarks/example_soil.py

Flown by the twin at a tolerance of 1e-7 m/s (a search's is 3e-4); conditions drawn from priors and the vehicle's tolerances, white noise.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.effects import load_library
from orchestrator.diagnosis.measured import write_measured
from orchestrator.diagnosis.measured.landing import Measured, Prior, Scalar, Series
from orchestrator.diagnosis.observation import Observation
from orchestrator.diagnosis.problem import Model
from orchestrator.diagnosis.setup import set_up

Array = NDArray[np.float64]
SCENARIOS = Path(__file__).resolve().parents[1] / "scenarios"
SCENARIO = SCENARIOS / "apollo11_zupp.toml"
OUT = SCENARIOS / "measured" / "example_soil"
DAMPING = 20e3  # N s/m at every pad
TIGHT = {"tolerance": 1e-7, "longest_step": 5e-3}
TIMES = np.round(np.arange(0.0, 3.0001, 0.05), 6)  # s
LEGS, STRUTS = ("+Z", "+Y", "-Z", "-Y"), ("primary", "right", "left")
SERIES = {"rates": (("rates.yaw", "rates.pitch", "rates.roll"), 0.0017, "rad/s"),
          "attitude": (("attitude.yaw", "attitude.pitch", "attitude.roll"), 0.0009, "rad")}  # fmt: skip
AT_REST = {f"stroke.{leg}.{strut}": 6.35e-3 for leg in LEGS for strut in STRUTS}
AT_REST |= {f"{what}.{leg}": sigma for what, sigma in (("penetration", 6e-3), ("skid", 0.01)) for leg in LEGS}
CONDITIONS: dict[str, tuple[list[float], float, str]] = {
    "velocity_body": ([-0.5730, -0.6147, -0.2130], 0.03, "m/s"),
    "attitude": ([0.2634, 0.01646, 0.04442], 0.0035, "rad"),
    "rates": ([-0.0108, 0.0, -0.05], 0.00175, "rad/s"),
    "ground_slope": ([0.0785], 0.007, "rad"),
    "ground_azimuth": ([0.0], 0.07, "rad"),
    "soil.friction": ([0.33], 0.03, "1"),
}
OTHERWISE: dict[str, list[float]] = {"velocity_body": [-0.70, -0.35, 0.10], "attitude": [0.10, -0.02, 0.01], "ground_slope": [0.05]}
"""The held-out landing: another approach to the same soil."""


def main() -> None:
    gap = np.random.default_rng(20).standard_normal(16)
    for seed, (name, means) in enumerate({"fit": {}, "holdout": OTHERWISE}.items(), 21):
        write_measured(OUT / name, made(name, means, gap, seed))


def made(name: str, means: Mapping[str, list[float]], gap: Array, seed: int) -> Measured:
    """A landing as recorded; gap: z of the vehicle's tolerances, the same for both."""
    random = np.random.default_rng(seed)
    blank = empty(name, means)
    effects = {"soil_damping": load_library([SCENARIOS / "candidates"])["soil_damping"]}
    setup = set_up(draw_up(read_scenario(SCENARIO), SCENARIO), [blank], effects, SCENARIOS / "tolerances.toml")
    setup.landings.bases[0].update(TIGHT)
    hidden = setup.hypotheses[0].coordinates
    z = np.concatenate([random.standard_normal(len(setup.nuisances)), gap[: len(setup.tolerances)], [DAMPING / hidden[0].sigma]])
    z[len(setup.nuisances) - 1] = 0.0  # the data's clock is at zero at first contact
    lander = setup.make()
    clean = Model(setup.landings, (*setup.nuisances, *setup.tolerances, *hidden), lander).predict(z)
    lander.close()
    if clean is None:
        raise SystemExit(f"{name}: cannot be flown; take another seed")
    return recorded(blank, setup.landings.observations[0], clean, random)


def empty(name: str, means: Mapping[str, list[float]]) -> Measured:
    """What was recorded and known, without the readings."""
    series = [
        Series(which, channels, TIMES, np.zeros((len(TIMES), len(channels))), np.full(len(channels), sigma), 0.0, (unit,) * len(channels))
        for which, (channels, sigma, unit) in SERIES.items()
    ]
    values = [Scalar(which, "value", 0.0, sigma, 0.0, 0.0, "m") for which, sigma in AT_REST.items()]
    prior = [
        Prior(which, np.array(means.get(which, mean)), np.full(len(mean), sigma), None, unit)
        for which, (mean, sigma, unit) in CONDITIONS.items()
    ]
    prior.append(Prior("soil.bearing_strength", np.array([350254.0]), None, np.array([0.12]), "N/m"))
    source = "synthetic: benchmarks/example_soil.py, by the twin; no real landing"
    return Measured(f"Example landing, {name}", source, OUT / name, series, values, prior)


def recorded(blank: Measured, seen: Observation, clean: Array, random: np.random.Generator) -> Measured:
    """The landing with white noise, to the digits a record would keep."""
    sigma = np.concatenate([*(np.full(len(t.times), t.sigma) for t in seen.tracks), [r.sigma for r in seen.readings]])
    rows = np.round(clean + sigma * random.standard_normal(len(clean)), 6)
    series, at = [], 0
    for one in blank.series:
        count = one.values.size
        series.append(replace(one, values=rows[at : at + count].reshape(len(one.channels), -1).T))
        at += count
    values = [replace(one, value=x, low=x, high=x) for one, x in zip(blank.values, np.round(rows[at:], 4).tolist(), strict=True)]
    return replace(blank, series=series, values=values)


if __name__ == "__main__":
    main()
