"""Courses as CSV, SI units: courses/LANDING_CHANNEL.csv, courses/LANDING_rest.csv, and courses/index.csv that lists them."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.report.courses import ChannelCourse, LandingCourses, RestValue
from orchestrator.diagnosis.report.file_names import FileNames

Array = NDArray[np.float64]
FOLDER = "courses"
COLUMNS = ("time_s", "measured", "sigma", "residual_before", "residual_after", "before", "before_fitted", "after", "band")
REST = ("name", "unit", "measured", "sigma", "low", "high", "before", "before_fitted", "after")
INDEX = ("file", "landing", "kind", "series", "channel", "unit")


def write_courses(folder: Path, courses: Sequence[LandingCourses]) -> list[Path]:
    """All files below `folder`; what is not known stays an empty cell. Rows are the instants of data and simulation together."""
    place = folder / FOLDER
    place.mkdir(parents=True, exist_ok=True)
    names, written, index = FileNames(), [], []
    names.stem("index")
    for landing in courses:
        for channel in landing.channels:
            path = place / f"{names.stem(landing.name, channel.channel)}.csv"
            written.append(_write(path, COLUMNS, _rows(channel)))
            index.append((path.name, landing.name, landing.kind, channel.series, channel.channel, channel.unit))
        if landing.rest:
            path = place / f"{names.stem(landing.name, 'rest')}.csv"
            written.append(_write(path, REST, (_rest_row(value) for value in landing.rest)))
            index.append((path.name, landing.name, landing.kind, "", "values at rest", ""))
    return [_write(place / "index.csv", INDEX, index), *written]


def _rows(channel: ChannelCourse) -> Iterable[list[str]]:
    times = np.union1d(channel.data_times, channel.times)
    sigma = np.full(len(channel.data_times), channel.sigma)
    read = [channel.data, sigma, channel.residual_before, channel.residual_after]
    simulated = [channel.before, channel.before_fitted, channel.after, channel.band]
    columns = [times, *(_spread(times, channel.data_times, c) for c in read), *(_spread(times, channel.times, c) for c in simulated)]
    return ([_cell(x) for x in row] for row in np.column_stack(columns).tolist())


def _spread(times: Array, own: Array, column: Array | None) -> Array:
    """A column at its own instants, NaN at the others."""
    full = np.full(len(times), np.nan)
    if column is not None and len(own):
        full[np.searchsorted(times, own)] = column
    return full


def _rest_row(value: RestValue) -> list[str]:
    numbers = (value.value, value.sigma, value.low, value.high, value.before, value.before_fitted, value.after)
    return [value.name, value.unit, *(_cell(x) for x in numbers)]


def _cell(value: float | None) -> str:
    return "" if value is None or not np.isfinite(value) else f"{value:.10g}"


def _write(path: Path, header: Sequence[str], rows: Iterable[Sequence[str]]) -> Path:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)
    return path
