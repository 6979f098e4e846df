"""What the instruments make of a landing: when they sample, how they err, in which units and order the data are handed over."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.landing import ATTITUDE, RATES, TELEMETRY, Course
from orchestrator.diagnosis.measured.landing import Measured, Prior, Scalar, Series
from orchestrator.diagnosis.observation import Observation, Reading, Track
from sealed.truth import final_columns
from sealed.vehicle import Known, Vehicle

Array = NDArray[np.float64]
Random = np.random.Generator
Item = TypeVar("Item")
SIGMA = {"rates": 0.0017, "attitude": 0.0009}  # rad/s, rad: Apollo's telemetry
STROKE, SKID, PENETRATION = 6.35e-3, 0.01, 6e-3  # m, standard deviations
BOUNDED = 1.0  # m: of a scalar known by bounds alone, which hardly counts for λ
OTHER = {"rad/s": ("deg/s", 180.0 / pi), "rad": ("deg", 180.0 / pi), "m": ("ft", 1.0 / 0.3048), "m/s": ("ft/s", 1.0 / 0.3048)}


@dataclass(frozen=True)
class Sampling:
    """How one landing was recorded; nothing of it should matter."""

    origin: float
    """s on the data's clock at first contact."""
    times: Mapping[str, Array]
    """series → s on the data's clock."""
    colour: float
    misstated: float
    """stated sigma over the true one."""
    intervals: tuple[str, ...]
    """scalars of which only bounds are known."""
    shuffle: int
    """Seed of units and order."""


def drawn_sampling(random: Random, colour: float, misstated: float, legs: Sequence[str]) -> Sampling:
    """20 to 50 Hz, 2 to 4 s, steady or jittered, a clock that starts anywhere."""
    origin = float(random.choice([0.0, random.uniform(-2.0, 10.0), random.uniform(10.0, 1000.0)]))
    length, before = random.uniform(2.0, 4.0), random.uniform(0.0, 0.2)
    times = {}
    for series in SIGMA:
        interval = 1.0 / random.uniform(20.0, 50.0)
        steady = np.arange(-before + random.uniform(0.0, interval), length, interval)
        jitter = random.choice([0.0, 0.1]) * interval
        times[series] = np.round(origin + steady + jitter * random.uniform(-1.0, 1.0, len(steady)), 6)
    bounds = tuple(f"penetration.{leg}" for leg in legs) if random.random() < 0.5 else ()
    return Sampling(origin, times, colour, misstated, bounds, int(random.integers(2**31)))


def observation(vehicle: Vehicle, sampling: Sampling, readings: Array | None = None) -> Observation:
    """The rows of a landing with their true noise; readings are zero where none are given."""
    tracks, at = [], 0
    for series, channels, columns in (("rates", RATES, TELEMETRY), ("attitude", ATTITUDE, ATTITUDE)):
        times = sampling.times[series]
        for channel, column in zip(channels, columns, strict=True):
            values = np.zeros(len(times)) if readings is None else readings[at : at + len(times)]
            tracks.append(Track(series, channel, column, times, values, SIGMA[series], sampling.colour))
            at += len(times)
    scalars = [Reading(name, twin, 0.0 if readings is None else float(readings[at + i]),
                       BOUNDED if name in sampling.intervals else sigma_of(name))
               for i, (name, twin) in enumerate(final_columns(vehicle).items())]  # fmt: skip
    found = Observation(tracks, scalars)
    found.shift = sampling.origin
    return found


def sigma_of(scalar: str) -> float:
    return {"stroke": STROKE, "skid": SKID}.get(scalar.partition(".")[0], PENETRATION)


def clean_readings(vehicle: Vehicle, sampling: Sampling, course: Course, values: Mapping[str, float]) -> Array:
    """What instruments without noise would have read."""
    return observation(vehicle, sampling).predicted(course, values)


def noisy(random: Random, vehicle: Vehicle, sampling: Sampling, clean: Array) -> Array:
    """AR(1) noise on the series, its colour per typical interval; white noise on the scalars, none where bounds are laid round them."""
    rows, seen = clean.copy(), observation(vehicle, sampling)
    for track, whitening, place in zip(seen.tracks, seen.whitenings, seen.places, strict=False):
        error, before = np.empty(len(track.times)), 0.0
        for k, w in enumerate(random.standard_normal(len(track.times)).tolist()):
            follow = float(whitening.follow[k])
            before = follow * before + np.sqrt(1.0 - follow**2) * track.sigma * w
            error[k] = before
        rows[place] += error
    scalars = np.array([0.0 if reading.name in sampling.intervals else reading.sigma for reading in seen.readings])
    rows[len(rows) - len(scalars) :] += scalars * random.standard_normal(len(scalars))
    return rows


def public(vehicle: Vehicle, sampling: Sampling, readings: Array, known: Sequence[Known], title: str) -> Measured:
    """The data as they are handed over."""
    random, seen = np.random.default_rng(sampling.shuffle), observation(vehicle, sampling, readings)
    series = [_series(random, seen, sampling, name) for name in SIGMA]
    values = [_scalar(random, reading, sampling) for reading in seen.readings]
    prior = [_prior(random, one) for one in known]
    return Measured(title, "made for the benchmark of the diagnosis", Path(), _shuffled(random, series), _shuffled(random, values), prior)


def _series(random: Random, seen: Observation, sampling: Sampling, name: str) -> Series:
    tracks = _shuffled(random, [track for track in seen.tracks if track.series == name])
    si = "rad/s" if name == "rates" else "rad"
    unit, factor = _unit(random, si)
    sigma = np.full(len(tracks), SIGMA[name] * sampling.misstated * factor)
    values = np.column_stack([track.readings for track in tracks]) * factor
    return Series(name, tuple(track.channel for track in tracks), sampling.times[name], values, sigma, None, (unit,) * len(tracks))


def _scalar(random: Random, reading: Reading, sampling: Sampling) -> Scalar:
    unit, factor = _unit(random, "m")
    if reading.name in sampling.intervals:
        width, share = random.uniform(0.02, 0.05), random.uniform(0.2, 0.8)
        low, high = factor * (reading.value - share * width), factor * (reading.value + (1.0 - share) * width)
        return Scalar(reading.name, "interval", 0.5 * (low + high), 0.0, low, high, unit)
    low = high = factor * reading.value
    return Scalar(reading.name, "value", low, factor * reading.sigma * sampling.misstated, low, high, unit)


def _prior(random: Random, one: Known) -> Prior:
    unit, factor = _unit(random, one.unit) if one.unit in OTHER else (one.unit, 1.0)
    mean, spread = np.array(one.mean) * factor, np.full(len(one.mean), one.spread * (1.0 if one.of_log else factor))
    found = Prior(one.name, mean, spread, None, unit)
    return replace(found, sigma=None, sigma_log=spread) if one.of_log else found


def _unit(random: Random, si: str) -> tuple[str, float]:
    return OTHER[si] if random.random() < 0.3 else (si, 1.0)


def _shuffled(random: Random, items: Sequence[Item]) -> list[Item]:
    return [items[i] for i in random.permutation(len(items))]
