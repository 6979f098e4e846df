"""One landing for the search: the LunarLander twin's FMU from touchdown to rest, its course kept where the data want it.

A search asks for a thousand landings, so nothing here is built twice: the instance is reset and set up again.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from orchestrator.diagnosis.starts import number_of
from orchestrator.errors import OrchestratorError, StepError
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.slave2 import Fmi2Unit
from orchestrator.master.slave import Binding, Kind, Status, Value

Array = NDArray[np.float64]
AXES = ("yaw", "pitch", "roll")
RATES = tuple(f"rates.{axis}" for axis in AXES)
ATTITUDE = tuple(f"attitude.{axis}" for axis in AXES)
SPIN = tuple(f"body.angular_acceleration[{i}]" for i in (1, 2, 3))
TELEMETRY = tuple(f"telemetry.{axis}" for axis in AXES)
TELEMETRY_SLOPES = tuple(f"telemetry_slope.{axis}" for axis in AXES)
"""Columns that a course may have beside those of the telemetry: their derivatives by time."""
SENSOR = "sensor."
FLOWN = 2  # parts of an interval of the grid in which the twin is flown where the sensor behind it does something
PARTS = 2  # of each of these, for the sensor
ARRAY = "position_start["
HEIGHT = f"{ARRAY}1]"
VARIATION = "variation"
NOMINALS = 6  # kept in the unit's memory at most, of about 7 MB each
ALOFT = 10.0  # m: from where the height of the first contact is found


@dataclass(frozen=True)
class Nominal:
    """A landing that the unit keeps under a number."""

    place: int
    rows: Array
    last: Array


@dataclass(frozen=True)
class Course:
    """A landing: columns over `times` (s since first contact) and what is left at the end."""

    times: Array
    columns: Mapping[str, Array]
    final: Mapping[str, float]


class Lander(Protocol):
    """What the search flies. Values by the names of the twin's variables; those of the rate sensor with `sensor.` before them."""

    varies: bool
    """Whether a landing can be flown beside another, by its steps: sooner, and so that the two differ by their values alone."""

    def land(
        self,
        values: Mapping[str, float],
        grid: Array,
        columns: Sequence[str],
        final: Sequence[str],
        beside: Mapping[str, float] | None = None,
    ) -> Course | None:
        """The landing over the grid (s, from 0); None where these values cannot be flown to the end.

        beside: values of another landing over this grid, a nominal one; given where the lander `varies`.
        """

    def close(self) -> None: ...


class TwinLander:
    """The twin's FMU with the sensor's behind it."""

    def __init__(self, lander: Path, sensor: Path, base: Mapping[str, float]) -> None:
        """`base`: the values of the scenario, as `Lander.land` takes them."""
        self.base = dict(base)
        self.unit = Fmi2Unit("lander", lander, read_interface(lander))
        self.sensor = Fmi2Unit("sensor", sensor, read_interface(sensor))
        self.bound: tuple[tuple[str, ...], tuple[str, ...]] | None = None
        self.starts = {name: number_of(v.start) for name, v in self.unit.interface.variables.items()}
        self.varies = VARIATION in self.unit.interface.variables
        self.nominals: dict[Hashable, Nominal] = {}
        legs = [name for name in self.unit.interface.variables if name.startswith("soil") and name.endswith(".gap")]
        self.gaps = tuple(legs)
        self._bind_sensor()

    def land(
        self,
        values: Mapping[str, float],
        grid: Array,
        columns: Sequence[str],
        final: Sequence[str],
        beside: Mapping[str, float] | None = None,
    ) -> Course | None:
        wanted = tuple(dict.fromkeys([*RATES, *SPIN, *columns]))
        self._bind(wanted, tuple(final))
        own, sensor = self._parted(values)
        nominal, others = self._parted(beside) if beside is not None else (None, {})
        neutral = self._neutral(sensor)
        flown = grid if neutral and self._neutral(others) else subdivided(grid, FLOWN)
        try:
            rows, last = self._flown(own, flown) if nominal is None else self._flown_beside(nominal, own, flown)
        except OrchestratorError:
            return None
        course = {name: rows[:, i] for i, name in enumerate(wanted)}
        course |= _as_received(course) if neutral else self._sensed(flown, course, sensor)
        course = course if flown is grid else {name: column[::FLOWN] for name, column in course.items()}
        return Course(grid, course, dict(zip(final, last.tolist(), strict=True)))

    def _parted(self, values: Mapping[str, float]) -> tuple[dict[str, float], dict[str, float]]:
        """All values of the twin's, and of the sensor's by its own names."""
        every = {**self.base, **values}
        own = {name: value for name, value in every.items() if not name.startswith(SENSOR)}
        return own, {n[len(SENSOR) :]: v for n, v in every.items() if n.startswith(SENSOR)}

    def _neutral(self, sensor: Mapping[str, float]) -> bool:
        return all(number_of(self.sensor.interface.variables[name].start) == value for name, value in sensor.items())

    def _flown(self, own: Mapping[str, float], grid: Array) -> tuple[Array, Array]:
        """The columns that are bound at the grid's instants, and the final values."""
        self._touch_down(own, float(grid[-1]))
        rows = self._fly(grid)
        return rows, self.outputs[rows.shape[1] + len(self.gaps) :].copy()

    def _flown_beside(self, nominal: Mapping[str, float], own: Mapping[str, float], grid: Array) -> tuple[Array, Array]:
        """As `_flown`, by the steps of the nominal landing, which is flown where the unit does not keep it yet."""
        key = (self.bound, grid.tobytes(), tuple(sorted(nominal.items())))
        kept = self.nominals.pop(key, None)
        if kept is None:
            if len(self.nominals) == NOMINALS:
                del self.nominals[next(iter(self.nominals))]
            place = min(set(range(1, NOMINALS + 1)) - {one.place for one in self.nominals.values()})
            try:
                kept = Nominal(place, *self._flown({**nominal, VARIATION: place}, grid))
            except OrchestratorError:
                return self._flown(own, grid)
        self.nominals[key] = kept  # the last one used is the last to be forgotten
        return (kept.rows, kept.last) if own == nominal else self._flown({**own, VARIATION: -kept.place}, grid)

    def close(self) -> None:
        self.unit.close()
        self.sensor.close()

    def _bind(self, columns: tuple[str, ...], final: tuple[str, ...]) -> None:
        if self.bound == (columns, final):
            return
        names = (*columns, *self.gaps, *final)
        self.outputs = np.zeros(len(names))
        self.unit.bind(Binding((), (), names, len(columns), np.zeros(0), self.outputs))
        self.bound = (columns, final)

    def _touch_down(self, values: Mapping[str, float], stop: float) -> None:
        """Initialised with the lowest pad just at the ground: the gap is linear in the height, so one correction is exact."""
        start: dict[str, Value] = {name: self._kind(name, value) for name, value in values.items() if value != self.starts[name]}
        start[HEIGHT] = ALOFT
        first = len(self.bound[0]) if self.bound else 0
        gaps = slice(first, first + len(self.gaps))
        self.unit.set_up(0.0, stop, start)
        self.unit.exchange()
        start[HEIGHT] = ALOFT - float(self.outputs[gaps].min())
        self.unit.change({name: value for name, value in start.items() if name.startswith(ARRAY)})
        if self.unit.complaint:
            raise StepError(self.unit.complaint)
        self.unit.begin()

    def _kind(self, name: str, value: float) -> Value:
        kind = self.unit.interface.variables[name].kind
        return value if kind is Kind.REAL else round(value) if kind is Kind.INTEGER else bool(value)

    def _fly(self, grid: Array) -> Array:
        count = len(self.bound[0]) if self.bound else 0
        rows = np.empty((len(grid), count))
        rows[0] = self.outputs[:count]
        instants = grid.tolist()
        for i in range(1, len(instants)):
            if self.unit.step(instants[i - 1], instants[i] - instants[i - 1]) is not Status.OK:
                raise StepError("the twin refused a step")
            rows[i] = self.outputs[:count]
        self.unit.observe()
        return rows

    def _bind_sensor(self) -> None:
        inputs = (*RATES, *(f"{name}_slope" for name in RATES))
        self.sensor_in, self.sensor_out = np.zeros(6), np.zeros(3)
        self.sensor.bind(Binding(inputs, (), TELEMETRY, 3, self.sensor_in, self.sensor_out))

    def _sensed(self, grid: Array, course: Mapping[str, Array], values: Mapping[str, float]) -> dict[str, Array]:
        """What the ground receives of the rates, by the sensor's own FMU."""
        variables = self.sensor.interface.variables
        fine = subdivided(grid, PARTS)
        known = [CubicHermiteSpline(grid, course[rate], course[spin]) for rate, spin in zip(RATES, SPIN, strict=True)]
        rates = np.column_stack([curve(fine) for curve in known])
        received = np.empty_like(rates)
        self.sensor_in[:3], self.sensor_in[3:] = rates[0], 0.0
        self.sensor.set_up(float(fine[0]), float(fine[-1]), {n: v for n, v in values.items() if v != number_of(variables[n].start)})
        self.sensor.exchange()
        self.sensor.begin()
        received[0] = self.sensor_out
        steps = np.diff(fine)
        slopes = np.diff(rates, axis=0) / steps[:, None]
        for i, (time, step) in enumerate(zip(fine.tolist(), steps.tolist(), strict=False)):
            self.sensor_in[:3], self.sensor_in[3:] = rates[i], slopes[i]
            self.sensor.step(time, step)
            received[i + 1] = self.sensor_out
        changing = np.gradient(received, fine, axis=0)
        return dict(zip((*TELEMETRY, *TELEMETRY_SLOPES), np.hstack([received, changing])[::PARTS].T, strict=True))


def _as_received(course: Mapping[str, Array]) -> dict[str, Array]:
    """The telemetry of a sensor that does nothing."""
    return {new: course[old] for new, old in zip((*TELEMETRY, *TELEMETRY_SLOPES), (*RATES, *SPIN), strict=True)}


def subdivided(grid: Array, parts: int) -> Array:
    """So many intervals for each.

    The sensor takes straight lines, and over 20 ms the rates are none (0.23 sigma at a lag of 0.1 s). Nor are they cubics where a pad
    touches: interpolated over 20 ms, a lag of 6 ms came out 0.09 sigma off (RMS), over 10 ms 0.03.
    """
    places = np.arange(parts * (len(grid) - 1) + 1) / parts
    return np.asarray(np.interp(places, np.arange(len(grid)), grid))
