"""From a landing's course to the numbers that were measured, and from both to a white residual.

Rows of a residual stand in the order of `Observation.labels`: series by series, channel by channel, then the values at rest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from orchestrator.diagnosis.landing import ATTITUDE, RATES, SPIN, TELEMETRY, TELEMETRY_SLOPES, Course
from orchestrator.diagnosis.noise import Noise, Whitening, typical_interval

Array = NDArray[np.float64]
Kept = TypeVar("Kept")
ORIGIN = "time.origin"
CLOCK = "clock."
CHANGING = dict(zip((*RATES, *TELEMETRY), (*SPIN, *TELEMETRY_SLOPES), strict=True))
"""Column -> the one with its derivative by time."""
SEEN = (CLOCK, "time.")
"""Begin of what belongs to the data's clocks and not to a unit."""
FILL = 0.02  # s: the search's own grid between the samples
CLOSE = 1e-3  # s: samples closer than this share a point of the grid
NEAR = 1e-3  # s
SHARPEST = 1e-6  # SI: of an end at zero
EDGE = 0.05  # of an interval's width, of one open to one side the end it has: how sharply its ends are meant


@dataclass(frozen=True)
class Track:
    """One measured channel of a series: where it is in a course, when it was sampled, what was read."""

    series: str
    channel: str
    """As the data call it."""
    column: str
    """As a course calls it."""
    times: Array
    readings: Array
    sigma: float
    colour: float | None


@dataclass(frozen=True)
class Reading:
    """One number at rest: value ± sigma, or an interval."""

    name: str
    column: str
    """Of `Course.final`."""
    value: float
    sigma: float
    low: float = -np.inf
    high: float = np.inf
    interval: bool = False
    kind: str = "rest"
    """rest: of `Course.final`; peak: the largest magnitude of a column, with its sign; time: an instant of the data's clock."""
    unit: str = ""

    @property
    def edge(self) -> float:
        """What counts as one standard deviation outside an interval. One open to a side has no width, and must not weigh nothing."""
        width = self.high - self.low
        return max(EDGE * (width if np.isfinite(width) else abs(self.high if np.isfinite(self.high) else self.low)), SHARPEST)


class Observation:
    """What one landing left: tracks and readings, and the noise believed of each track."""

    def __init__(self, tracks: Sequence[Track], readings: Sequence[Reading]) -> None:
        self.tracks, self.readings = tuple(tracks), tuple(readings)
        self.shift = 0.0
        """s: time of the data at first contact, as first guessed; a coordinate refines it."""
        self.set_noise([Noise(t.sigma, t.colour or 0.0, typical_interval(t.times)) for t in self.tracks])
        peaks = [r.column for r in self.readings if r.kind == "peak"]
        self.columns = tuple(dict.fromkeys(c for c in (*(t.column for t in self.tracks), *peaks) if not c.startswith("telemetry.")))
        self.final = tuple(dict.fromkeys(r.column for r in self.readings if r.kind != "peak"))
        self._dated = list({(t.series, t.times.tobytes()): t for t in self.tracks}.values())
        """One track of each set of instants."""
        self.places = _places([len(t.times) for t in self.tracks] + [1] * len(self.readings))

    @property
    def size(self) -> int:
        return self.places[-1].stop if self.places else 0

    @property
    def series(self) -> dict[str, list[int]]:
        """The places of each series' tracks among the tracks."""
        found: dict[str, list[int]] = {}
        for place, track in enumerate(self.tracks):
            found.setdefault(track.series, []).append(place)
        return found

    @property
    def labels(self) -> list[str]:
        """A name for every row."""
        return [t.channel for t in self.tracks for _ in t.times] + [r.name for r in self.readings]

    def set_noise(self, noises: Sequence[Noise]) -> None:
        self.noises = tuple(noises)
        self.whitenings = [Whitening(t.times, noise) for t, noise in zip(self.tracks, noises, strict=True)]

    def grid(self, stop: float, values: Mapping[str, float], horizon: float = np.inf) -> Array:
        """Instants (s since first contact) to land by: every sample as these values date it, and points between, to past the horizon.

        A rate has corners where pads touch: interpolated over 20 ms it would be off by half its noise, so samples are met exactly.
        """
        dated = [t.times - self.late(t, values) for t in self._dated]
        samples = np.concatenate(dated) if dated else np.zeros(0)
        end = min(stop, horizon + 2.0 * FILL)
        samples = samples[(samples > CLOSE) & (samples < end - CLOSE)]
        own = np.arange(0.0, end, FILL) if self.tracks else np.linspace(0.0, end, 9)[:-1]
        points = np.sort(np.concatenate([samples, [end]]))
        near = np.searchsorted(points, own).clip(1, len(points) - 1) if len(points) > 1 else np.zeros(len(own), dtype=int)
        apart = np.minimum(np.abs(own - points[near]), np.abs(own - points[near - 1])) > 0.25 * FILL
        merged = np.sort(np.concatenate([points, own[apart], [0.0]]))
        return thinned(merged)

    def late(self, track: Track, values: Mapping[str, float]) -> float:
        """s by which the track's time tags run after first contact."""
        return self.shift + values.get(ORIGIN, 0.0) + values.get(CLOCK + track.series, 0.0)

    def dated_alike(self, values: Mapping[str, float], others: Mapping[str, float]) -> bool:
        """Whether samples so dated may be read off a course whose grid meets them as dated by the others: so near to a point of the grid a
        corner of a rate that lies in the interval is felt with the square of the distance: all samples of a landing by 0.8 standard
        deviations together at 1 ms, by 10 at 3 ms (the Apollo 11 landing with a step under a pad; straight lines: 3.4 and 8).
        """
        return all(abs(self.late(t, values) - self.late(t, others)) < NEAR for t in self._dated)

    def predicted(self, course: Course, values: Mapping[str, float]) -> Array:
        """The numbers that this course would have left, in their own units; intervals give their final value."""
        return np.asarray(self.predicted_dated(course, [values])[0])

    def predicted_dated(self, course: Course, dated: Sequence[Mapping[str, float]]) -> Array:
        """(k, n): `predicted` of one course under several datings, each column interpolated once."""
        rows = []
        for track in self.tracks:
            late = np.array([self.late(track, values) for values in dated])
            rows.append(sampled(course, track.column, track.times - late[:, None]))
        last = [[self._read(r, course, values) for r in self.readings] for values in dated]
        return np.hstack([*rows, np.array(last).reshape(len(dated), len(self.readings))])

    def residual(self, predicted: Array) -> Array:
        """White residual: data less prediction, in standard deviations. An interval counts only outside its ends."""
        parts = [w(t.readings - predicted[p]) for t, w, p in zip(self.tracks, self.whitenings, self.places, strict=False)]
        last = predicted[self.places[len(self.tracks)].start :] if self.readings else np.zeros(0)
        return np.concatenate([*parts, np.array([_missed(r, x) for r, x in zip(self.readings, last.tolist(), strict=True)])])

    def whitened(self, slopes: Array, predicted: Array) -> Array:
        """Derivatives of the white prediction from those of the prediction, (n, m); inside an interval nothing changes."""
        parts = [w(slopes[p]) for w, p in zip(self.whitenings, self.places, strict=False)]
        first = self.places[len(self.tracks)].start if self.readings else 0
        rows = [_weight(r, predicted[first + i]) * slopes[first + i] for i, r in enumerate(self.readings)]
        return np.concatenate([*parts, np.array(rows).reshape(len(rows), slopes.shape[1])])

    def weights(self, horizon: float) -> Array:
        """1 for the rows that count when a landing is flown to `horizon` s only: samples until then; readings at rest at the end alone."""
        rows = [(t.times - self.shift <= horizon).astype(np.float64) for t in self.tracks]
        return np.concatenate([*rows, np.full(len(self.readings), float(horizon == np.inf))])

    def raw(self, predicted: Array, place: int) -> Array:
        """Data less prediction of one track in its own unit."""
        return self.tracks[place].readings - predicted[self.places[place]]

    def _read(self, reading: Reading, course: Course, values: Mapping[str, float]) -> float:
        if reading.kind == "peak":
            column = course.columns[reading.column]
            return float(column[np.argmax(np.abs(column))])
        late = self.shift + values.get(ORIGIN, 0.0) if reading.kind == "time" else 0.0
        return course.final[reading.column] + late


def of_units(values: Mapping[str, Kept]) -> dict[str, Kept]:
    """The values without those that only the data's clocks know."""
    return {name: value for name, value in values.items() if not name.startswith(SEEN)}


def thinned(instants: Array) -> Array:
    """Rising instants without those that follow the last one kept within CLOSE; the first and the last stay."""
    if bool((np.diff(instants) > CLOSE).all()):
        return instants
    kept = [instants[0]]
    for instant in instants[1:-1]:
        if instant - kept[-1] > CLOSE and instants[-1] - instant > CLOSE:
            kept.append(instant)
    return np.array([*kept, instants[-1]])


def sampled(course: Course, column: str, times: Array) -> Array:
    """A column at other instants: cubic where its rate of change is known, straight lines elsewhere.

    Before first contact (s < 0) the vehicle flies free: rates stay, angles go on along their slope. After the end the last value holds.
    """
    grid, y = course.times, course.columns[column]
    if CHANGING.get(column) in course.columns:
        inside = CubicHermiteSpline(grid, y, course.columns[CHANGING[column]])(np.clip(times, grid[0], grid[-1]))
        return np.asarray(inside)
    inside = np.interp(times, grid, y)
    if column in ATTITUDE:
        early = times < grid[0]
        first = (y[1] - y[0]) / (grid[1] - grid[0])
        inside = np.where(early, y[0] + first * (times - grid[0]), inside)
    return np.asarray(inside)


def _missed(reading: Reading, value: float) -> float:
    if not reading.interval:
        return (reading.value - value) / reading.sigma
    outside = max(reading.low - value, 0.0) - max(value - reading.high, 0.0)
    return outside / reading.edge


def _weight(reading: Reading, value: float) -> float:
    """How fast the residual of a reading falls with its prediction."""
    if not reading.interval:
        return 1.0 / reading.sigma
    return 0.0 if reading.low <= value <= reading.high else 1.0 / reading.edge


def _places(sizes: Sequence[int]) -> list[slice]:
    ends = np.cumsum([0, *sizes]).tolist()
    return [slice(a, b) for a, b in pairwise(ends)]
