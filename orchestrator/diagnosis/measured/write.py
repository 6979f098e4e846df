"""Measured -> a folder that `read_measured` gives back."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from numpy.typing import NDArray

from orchestrator.diagnosis.measured.channels import COLUMNS
from orchestrator.diagnosis.measured.landing import Measured, Prior, Scalar, Series

_NAMES = {name: column for column, name in COLUMNS.items()}


def write_measured(folder: Path, measured: Measured) -> Path:
    """landing.toml and a CSV file for each series, in SI, every digit of every number; a gap is an empty cell. `measured.folder` is
    not used.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for one in measured.series:
        _write_series(folder / f"{one.name}.csv", one)
    tree: dict[str, Any] = {"title": measured.title, "source": measured.source}
    tree["series"] = {one.name: _series(one) for one in measured.series}
    tree["values"] = {one.name: _scalar(one) for one in measured.values}
    tree["prior"] = {one.name: _prior(one) for one in measured.prior}
    path = folder / "landing.toml"
    path.write_text(tomli_w.dumps({key: value for key, value in tree.items() if value}), encoding="utf-8")
    return path


def _write_series(path: Path, one: Series) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["time_s", *_columns(one)])
        for time, row in zip(one.times.tolist(), one.values.tolist(), strict=True):
            rows.writerow([time, *("" if math.isnan(cell) else cell for cell in row)])


def _columns(one: Series) -> list[str]:
    return [_NAMES.get(channel, channel) for channel in one.channels]


def _series(one: Series) -> dict[str, Any]:
    columns = _columns(one)
    units = one.unit or tuple("rad/s" if channel.startswith("rates.") else "rad" for channel in one.channels)
    entry: dict[str, Any] = {
        "file": f"{one.name}.csv",
        "unit": units[0] if len(set(units)) == 1 else dict(zip(columns, units, strict=True)),
        "sigma": float(one.sigma[0]) if np.all(one.sigma == one.sigma[0]) else dict(zip(columns, one.sigma.tolist(), strict=True)),
        "colour": "estimate" if one.colour is None else float(one.colour),
    }
    return entry | ({"columns": columns} if one.name in ("rates", "attitude") and len(columns) < 3 else {})


def _scalar(one: Scalar) -> dict[str, Any]:
    if one.kind == "value":
        return {"value": float(one.value), "sigma": float(one.sigma), "unit": one.unit}
    return {key: float(edge) for key, edge in (("low", one.low), ("high", one.high)) if math.isfinite(edge)} | {"unit": one.unit}


def _prior(one: Prior) -> dict[str, Any]:
    key, spread = ("sigma", one.sigma) if one.sigma is not None else ("sigma_log", one.sigma_log)
    entry = {"mean": _numbers(one.mean), key: _numbers(spread)}
    return entry | ({"unit": one.unit} if one.unit else {})


def _numbers(array: NDArray[np.float64] | None) -> float | list[float]:
    listed: list[float] = np.atleast_1d(np.asarray(array)).tolist()
    return listed[0] if len(listed) == 1 else listed
