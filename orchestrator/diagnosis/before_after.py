"""Data, simulation before and simulation after, sample by sample: what the figures of a report are drawn from."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from orchestrator.diagnosis.proof import NULL, WINNER, Observed, Proof

Array = NDArray[np.float64]
HEADER = ("landing", "channel", "time_s", "data", "before", "after", "sigma")


@dataclass(frozen=True)
class Track:
    """One channel of one landing, or one number at rest (`times` is then empty and the rest has one element)."""

    landing: str
    channel: str
    times: Array
    """s, as the data have them."""
    data: Array
    """NaN where only an interval is known."""
    before: Array
    after: Array
    sigma: float


def before_after(proof: Proof) -> list[Track]:
    """Every channel and reading of every landing that was flown; NaN where one side is missing."""
    return [track for landing in proof.landings for track in _of_landing(proof, landing)]


def write_before_after(folder: Path, tracks: Sequence[Track]) -> tuple[Path, Path]:
    """before_after.csv and .parquet, one row a sample."""
    rows = [row for track in tracks for row in _rows(track)]
    folder.mkdir(parents=True, exist_ok=True)
    text, table = folder / "before_after.csv", folder / "before_after.parquet"
    with text.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(HEADER)
        writer.writerows(rows)
    columns = list(zip(*rows, strict=True)) if rows else [()] * len(HEADER)
    kinds = [pa.string()] * 2 + [pa.float64()] * 5
    arrays = [pa.array(column, type=kind) for column, kind in zip(columns, kinds, strict=True)]
    pq.write_table(pa.table(dict(zip(HEADER, arrays, strict=True))), table)
    return text, table


def _of_landing(proof: Proof, landing: Observed) -> Iterator[Track]:
    observation = landing.observation
    nothing = np.full(observation.size, np.nan)
    sides = {it.belief: it.predicted for it in proof.flown if it.landing == landing.name and it.predicted is not None}
    before, after = sides.get(NULL, nothing), sides.get(WINNER, nothing)
    for track, noise, place in zip(observation.tracks, observation.noises, observation.places, strict=False):
        yield Track(landing.name, track.channel, track.times, track.readings, before[place], after[place], noise.sigma)
    for reading, place in zip(observation.readings, observation.places[len(observation.tracks) :], strict=True):
        data = np.array([np.nan if reading.interval else reading.value])
        sigma = np.nan if reading.interval else reading.sigma
        yield Track(landing.name, reading.name, np.zeros(0), data, before[place], after[place], sigma)


def _rows(track: Track) -> Iterator[tuple[object, ...]]:
    times = track.times.tolist() or [float("nan")] * len(track.data)
    for row in zip(times, track.data.tolist(), track.before.tolist(), track.after.tolist(), strict=True):
        yield (track.landing, track.channel, *row, track.sigma)
