"""A folder of measured data -> Measured, or one line about the first thing wrong with it."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from orchestrator.diagnosis.measured.channels import CANONICAL, COLUMNS, COMPLETE, TIMES, channel, check_scalar, si_unit
from orchestrator.diagnosis.measured.landing import Measured, Prior, Scalar, Series
from orchestrator.diagnosis.measured.schema import LandingTable, PriorTable, SeriesTable, ValueTable, known_keys
from orchestrator.diagnosis.measured.sheet import read_sheet
from orchestrator.diagnosis.measured.units import measure
from orchestrator.errors import MeasuredError, nearest
from orchestrator.scenario.faults import first_fault

Array = NDArray[np.float64]
FILE = "landing.toml"
T = TypeVar("T")


def read_measured(folder: Path) -> Measured:
    """Everything in SI. Gaps (empty cells, nan) are kept as NaN; see Series.mask."""
    where = f"{folder.name or folder}/{FILE}"
    table = _checked(_tree(folder, where), where)
    if not table.series and not table.values:
        raise MeasuredError(f"{where}: holds no data; add a [series.NAME] or [values]")
    series = [_series(name, entry, folder, f"{where}: series.{name}") for name, entry in table.series.items()]
    seen: dict[str, str] = {}
    for one in series:
        for name in one.channels:
            if name in seen:
                raise MeasuredError(f"{where}: series.{one.name}: {name} is also in series.{seen[name]}; a channel may stand in one")
            seen[name] = one.name
    values = [_scalar(name, entry, f"{where}: values.{name}") for name, entry in table.values.items()]
    priors = [_prior(name, entry, f"{where}: prior.{name}") for name, entry in table.prior.items()]
    return Measured(table.title or folder.name, table.source, folder, series, values, priors)


def _tree(folder: Path, where: str) -> dict[str, object]:
    path = folder / FILE
    if not folder.is_dir():
        raise MeasuredError(f"{folder}: no such folder; --measured expects one that holds {FILE}")
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise MeasuredError(f"{folder}: holds no {FILE}; it says what was measured (docs/diagnosis.md)") from None
    except tomllib.TOMLDecodeError as error:
        raise MeasuredError(f"{where}: not valid TOML: {error}; correct it there") from None
    except (OSError, UnicodeDecodeError) as error:
        raise MeasuredError(f"{where}: cannot be read ({error}); give a TOML file in UTF-8") from None


def _checked(tree: Mapping[str, object], where: str) -> LandingTable:
    try:
        return LandingTable.model_validate(tree)
    except ValidationError as error:
        raise MeasuredError(f"{where}: {first_fault(error, known_keys, FILE)}") from None


def _series(name: str, entry: SeriesTable, folder: Path, where: str) -> Series:
    sheet = read_sheet(folder / entry.file, where)
    times = _times(sheet, f"{where}: {entry.file}")
    columns = _columns(name, entry, [key for key in sheet if key not in TIMES], f"{where}: {entry.file}")
    channels = {channel(column, f"{where}: {entry.file}"): column for column in columns}
    if len(channels) < len(columns):
        raise MeasuredError(f"{where}: {entry.file}: two columns hold one channel; remove one")
    ordered = sorted(channels, key=lambda it: CANONICAL.index(it) if it in CANONICAL else len(CANONICAL))
    measures = [measure(_of(entry.unit, channels[it], f"{where}: unit"), f"{where}: {channels[it]}", si_unit(it)) for it in ordered]
    for it in ordered:
        if not np.isfinite(sheet[channels[it]]).any():
            raise MeasuredError(f"{where}: {entry.file}: column {channels[it]} holds no number at all; fill it or leave it out")
    factors = np.array([it.factor for it in measures])
    values = np.column_stack([sheet[channels[it]] for it in ordered]) * factors
    sigma = np.array([_of(entry.sigma, channels[it], f"{where}: sigma") for it in ordered]) * factors
    colour = None if entry.colour == "estimate" else entry.colour
    return Series(name, tuple(ordered), times, values, sigma, colour, tuple(it.si for it in measures))


def _times(sheet: Mapping[str, Array], where: str) -> Array:
    named = [name for name in TIMES if name in sheet]
    if not named:
        raise MeasuredError(f'{where}: has no column "time_s"; {nearest("time_s", sheet)}')
    times = sheet[named[0]]
    if not np.isfinite(times).all():
        raise MeasuredError(f"{where}: sample {int(np.argmin(np.isfinite(times))) + 1}: {named[0]} is empty; every sample needs its time")
    back = np.flatnonzero(np.diff(times) <= 0.0)
    if back.size:
        i = int(back[0])
        raise MeasuredError(f"{where}: {named[0]} goes from {times[i]!s} s to {times[i + 1]!s} s at sample {i + 2}, expects rising times")
    return times


def _columns(name: str, entry: SeriesTable, there: list[str], where: str) -> list[str]:
    """The columns to use, all of them in the file."""
    asked = list(COMPLETE.get(name, ())) if entry.columns is None else entry.columns
    for column in asked:
        if column not in there and not (entry.columns is None and COLUMNS[column] in there):
            hint = "" if entry.columns is not None else "; `columns` may say which there are"
            raise MeasuredError(f'{where}: has no column "{column}"; {nearest(column, there)}{hint}')
    chosen = there if entry.columns is None else asked
    if not chosen:
        raise MeasuredError(f"{where}: has no column but its time; add a channel, e.g. roll_rate")
    return chosen


def _of(given: T | dict[str, T], column: str, where: str) -> T:
    """What holds for a column: one for all, or its entry."""
    if not isinstance(given, dict):
        return given
    entry = given.get(column, given.get(COLUMNS.get(column, "")))
    if entry is None:
        raise MeasuredError(f'{where}: has no entry for column "{column}"; {nearest(column, given)}')
    return entry


def _scalar(name: str, entry: ValueTable, where: str) -> Scalar:
    check_scalar(name, where)
    of = measure(entry.unit, where, si_unit(name))
    if entry.value is not None and entry.sigma is not None:
        value, sigma = entry.value * of.factor, entry.sigma * of.factor
        return Scalar(name, "value", value, sigma, value, value, of.si)
    low = -math.inf if entry.low is None else entry.low * of.factor
    high = math.inf if entry.high is None else entry.high * of.factor
    middle = 0.5 * (low + high) if math.isfinite(high - low) else math.nan
    return Scalar(name, "interval", middle, 0.0, low, high, of.si)


def _prior(name: str, entry: PriorTable, where: str) -> Prior:
    of = measure(entry.unit or "1", where)
    mean = np.atleast_1d(np.asarray(entry.mean, dtype=np.float64)) * of.factor
    spread = np.atleast_1d(np.asarray(entry.sigma if entry.sigma is not None else entry.sigma_log, dtype=np.float64))
    spread = np.broadcast_to(spread, mean.shape).copy()
    unit = of.si if entry.unit else ""
    if entry.sigma_log is not None:
        return Prior(name, mean, None, spread, unit)
    return Prior(name, mean, spread * of.factor, None, unit)
