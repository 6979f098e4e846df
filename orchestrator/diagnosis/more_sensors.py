"""Sensors that a landing did not have: what each would have recorded, so that one set of flights tells what it would be worth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.landing import ATTITUDE, RATES
from orchestrator.diagnosis.observation import Observation, Reading, Track
from orchestrator.diagnosis.problem import Landings

Array = NDArray[np.float64]
STRUTS = ("primary", "left", "right")
SERIES = "more"
"""A recorder of its own: the telemetry's filter and clocks do not touch it."""


@dataclass(frozen=True)
class Sensor:
    """Columns of the twin, sampled at `rate` Hz, or read once at the end where it is 0."""

    name: str
    columns: tuple[str, ...]
    sigma: float
    unit: str
    rate: float = 0.0
    kind: str = "rest"
    """Of a single reading, as `Reading.kind`."""


SENSORS = (
    Sensor("body acceleration, 50 Hz", tuple(f"body.acceleration[{i}]" for i in (1, 2, 3)), 0.05, "m/s2", 50.0),
    Sensor("rates on board, 100 Hz", RATES, 0.0017, "rad/s", 100.0),
    Sensor("attitude ten times finer, 50 Hz", ATTITUDE, 0.9e-4, "rad", 50.0),
    Sensor("strut loads, 50 Hz", tuple(f"leg{k}.{s}.load" for k in (1, 2, 3, 4) for s in STRUTS), 200.0, "N", 50.0),
    Sensor("pad depths, 50 Hz", tuple(f"soil{k}.penetration" for k in (1, 2, 3, 4)), 2e-3, "m", 50.0),
    Sensor("pad depths and skids at rest", tuple(f"soil{k}.{w}" for k in (1, 2, 3, 4) for w in ("penetration", "skid")), 2e-3, "m"),
    Sensor("contact times", tuple(f"soil{k}.contact_time" for k in (1, 2, 3, 4)), 5e-3, "s", kind="time"),
)


@dataclass(frozen=True)
class Equipped:
    """Landings as they would have been recorded with every sensor on board."""

    landings: Landings
    measured: Array
    """Rows that the data have, of all rows."""
    rows: dict[Sensor, Array]
    """Rows of each sensor."""


def equipped(landings: Landings, sensors: Sequence[Sensor] = SENSORS) -> Equipped:
    """The same landings with the sensors' rows behind those measured. A sensor that every landing has already is left out."""
    news = [s for s in sensors if not all(_has(o, s) for o in landings.observations)]
    observations = [_with(o, news, stop) for o, stop in zip(landings.observations, landings.stop, strict=True)]
    larger = Landings(observations, landings.bases, landings.stop)
    measured: list[Array] = []
    rows: dict[Sensor, list[Array]] = {s: [] for s in news}
    for old, new, part in zip(landings.observations, observations, larger.parts, strict=True):
        places = [np.arange(part.start + p.start, part.start + p.stop) for p in new.places]
        first = len(new.tracks)
        measured += [*places[: len(old.tracks)], *places[first : first + len(old.readings)]]
        track, reading = len(old.tracks), first + len(old.readings)
        for s in news:
            count = len(s.columns)
            at = track if s.rate else reading
            rows[s] += places[at : at + count]
            track, reading = (track + count, reading) if s.rate else (track, reading + count)
    return Equipped(larger, np.concatenate(measured), {s: np.concatenate(parts) for s, parts in rows.items()})


def _with(observation: Observation, sensors: Sequence[Sensor], stop: float) -> Observation:
    tracks = [*observation.tracks, *(t for s in sensors if s.rate for t in _tracks(s, observation.shift, stop))]
    readings = [*observation.readings, *(r for s in sensors if not s.rate for r in _readings(s))]
    larger = Observation(tracks, readings)
    larger.shift = observation.shift
    return larger


def _tracks(sensor: Sensor, shift: float, stop: float) -> list[Track]:
    times = shift + np.arange(1, round(stop * sensor.rate)) / sensor.rate
    return [Track(SERIES, sensor.name, column, times, np.zeros(len(times)), sensor.sigma, 0.0) for column in sensor.columns]


def _readings(sensor: Sensor) -> list[Reading]:
    return [Reading(sensor.name, column, 0.0, sensor.sigma, kind=sensor.kind) for column in sensor.columns]


def _has(observation: Observation, sensor: Sensor) -> bool:
    """Whether the data hold these columns as well as the sensor would."""
    if not sensor.rate:
        known = {r.column for r in observation.readings if r.sigma <= sensor.sigma and not r.interval}
    else:
        fine = [t for t in observation.tracks if t.sigma <= sensor.sigma and len(t.times) > 1]
        known = {t.column for t in fine if float(np.median(np.diff(t.times))) <= 1.01 / sensor.rate}
    return set(sensor.columns) <= known
