"""Landers that are formulas, for a search without FMUs: at module level, so that a crew's processes can make them too."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.landing import Course
from orchestrator.diagnosis.observation import Observation, Reading, Track
from orchestrator.diagnosis.problem import Landings

Array = NDArray[np.float64]
STOP = 2.0


class Formula:
    """A lander whose landing is a formula."""

    varies = False

    def land(
        self, values: Mapping[str, float], grid: Array, columns: Sequence[str], final: Sequence[str], beside: object = None
    ) -> Course | None:
        course = {name: self.column(name, values, grid) for name in columns}
        return Course(grid, course, {name: self.last(name, values) for name in final})

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        raise NotImplementedError

    def last(self, name: str, values: Mapping[str, float]) -> float:
        return values[name]

    def close(self) -> None:
        return None


class Line(Formula):
    """y = a + b t, and at rest a + 2 b."""

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        return values["a"] + values["b"] * t

    def last(self, name: str, values: Mapping[str, float]) -> float:
        return values["a"] + 2.0 * values["b"]


class Ringing(Formula):
    """Two channels that ring down after touchdown; effects change how.

    x = (v + lift) exp(-(0.8 + drag) t) cos((6 + stiff) t + phase),  y = w exp(-t) sin((5 + bias) t) + kick t exp(-4 t) + tilt
    """

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        v = values
        if name == "x":
            speed = (v["v"] + v["lift"]) * np.exp(-(0.8 + v["drag"]) * t)
            return np.asarray(speed * np.cos((6.0 + v["stiff"]) * t + v["phase"]) + v["hump"] * np.exp(-(((t - 0.9) / 0.1) ** 2)))
        return np.asarray(v["w"] * np.exp(-t) * np.sin((5.0 + v["bias"]) * t) + v["kick"] * t * np.exp(-4.0 * t) + v["tilt"])


RINGING = {"v": 1.0, "w": 0.6, "phase": 0.0, "tilt": 0.0} | dict.fromkeys(("lift", "drag", "stiff", "bias", "kick", "hump"), 0.0)


def line() -> Line:
    return Line()


def ringing() -> Ringing:
    return Ringing()


class Logged:
    """Makes a lander that writes a byte to a file for each landing it flies, and stops short where told to."""

    def __init__(self, log: Path, most: int = 10**9) -> None:
        self.log, self.most = log, most

    def __call__(self) -> "LoggedRinging":
        return LoggedRinging(self.log, self.most)


class LoggedRinging(Ringing):
    def __init__(self, log: Path, most: int) -> None:
        self.log, self.most = log, most

    def land(
        self, values: Mapping[str, float], grid: Array, columns: Sequence[str], final: Sequence[str], beside: object = None
    ) -> Course | None:
        if self.log.exists() and self.log.stat().st_size >= self.most:
            raise KeyboardInterrupt
        with self.log.open("ab") as file:
            file.write(b".")
        return super().land(values, grid, columns, final)


def coordinate(name: str, sigma: float = 1.0, positive: bool = False) -> Coordinate:
    """One that adds to the variable of its name."""
    return Coordinate(name, ((name, 1.0),), sigma, positive=positive)


def tracks(lander: Formula, values: Mapping[str, float], columns: Sequence[str], times: Array, sigma: float, seed: int) -> list[Track]:
    """What white noise of sigma leaves of a landing."""
    random = np.random.default_rng(seed)
    found = []
    for name in columns:
        readings = lander.column(name, values, times) + sigma * random.standard_normal(len(times))
        found.append(Track("series", name, name, times, readings, sigma, 0.0))
    return found


def one_landing(observed: Sequence[Track], readings: Sequence[Reading], base: Mapping[str, float]) -> Landings:
    return Landings([Observation(observed, readings)], [dict(base)], [STOP])


def ringing_landing(changed: Mapping[str, float], seed: int = 0, sigma: float = 0.01) -> Landings:
    """A ringing landing in which some variables are not what the base says."""
    times = np.arange(0.02, STOP, 0.02)
    return one_landing(tracks(Ringing(), RINGING | dict(changed), ("x", "y"), times, sigma, seed), (), RINGING)


def ljung_box(residual: Array, lags: int = 5) -> float:
    """p-value of no autocorrelation up to `lags` (Ljung and Box 1978)."""
    n = len(residual)
    r = residual - residual.mean()
    q = n * (n + 2.0) * sum(float(r[k:] @ r[:-k] / (r @ r)) ** 2 / (n - k) for k in range(1, lags + 1))
    return float(chi2.sf(q, lags))
