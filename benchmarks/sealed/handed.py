"""A case as its public folder gives it, turned into the search's problem without any of the diagnosis: what the baselines start from."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.effects import Effect
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.measured import Measured, read_measured
from orchestrator.diagnosis.observation import ORIGIN, Observation, Reading, Track, of_units
from orchestrator.diagnosis.problem import Landings, Model
from sealed.truth import STOP, final_columns
from sealed.vehicle import Known, Vehicle

Array = NDArray[np.float64]
EARLY, LATE, FINE = -0.1, 0.4, 5e-3  # s after the first sample: where first contact is looked for, and in which steps


class Handed:
    """One landing: its rows, its nuisances, and its clock set so that the scenario at the prior mean fits best."""

    def __init__(self, vehicle: Vehicle, folder: Path, lander: Lander) -> None:
        measured = read_measured(folder)
        self.vehicle, self.lander = vehicle, lander
        self.observation = _observation(vehicle, measured)
        self.nuisances = vehicle.nuisances([_known(it) for it in measured.prior])
        self.observation.shift = self._first_contact()

    def model(self, coordinates: Sequence[Coordinate], effect: Effect | None = None) -> Model:
        """The problem over some coordinates; nuisances that are not among them stay at their prior mean."""
        free = {c.name for c in coordinates}
        still = [c for c in self.nuisances if c.name not in free]
        base = {**self.vehicle.base, **self.vehicle.values(still, np.zeros(len(still)), effect)}
        return Model(Landings([self.observation], [of_units(base)], [STOP]), coordinates, self.lander)

    def _first_contact(self) -> float:
        """Of one landing at the prior mean, moved along the data's clock."""
        begin = float(min(track.times[0] for track in self.observation.tracks))
        self.observation.shift = begin + 0.5 * (EARLY + LATE)
        values = self.model(()).landings.bases[0]
        grid = self.observation.grid(STOP, {}, np.inf)
        course = self.lander.land(values, grid, self.observation.columns, self.observation.final)
        if course is None:
            return begin
        moved = np.arange(EARLY, LATE, FINE) - 0.5 * (EARLY + LATE)
        misfit = [float(np.sum(self.observation.residual(self.observation.predicted(course, {ORIGIN: by})) ** 2)) for by in moved.tolist()]
        return self.observation.shift + float(moved[int(np.argmin(misfit))])


def _observation(vehicle: Vehicle, measured: Measured) -> Observation:
    tracks = []
    for series in measured.series:
        for k, channel in enumerate(series.channels):
            there = series.mask[:, k]
            column = channel.replace("rates.", "telemetry.")
            tracks.append(Track(series.name, channel, column, series.times[there], series.values[there, k], float(series.sigma[k]), 0.0))
    columns = final_columns(vehicle)
    readings = [Reading(it.name, columns[it.name], it.value, it.sigma, it.low, it.high, it.kind == "interval") for it in measured.values]
    return Observation(tracks, readings)


def _known(prior: object) -> Known:
    spread = prior.sigma if prior.sigma is not None else prior.sigma_log  # type: ignore[attr-defined]
    mean = tuple(float(x) for x in np.ravel(prior.mean))  # type: ignore[attr-defined]
    return Known(prior.name, mean, float(np.ravel(spread)[0]), prior.unit, prior.sigma_log is not None)  # type: ignore[attr-defined]
