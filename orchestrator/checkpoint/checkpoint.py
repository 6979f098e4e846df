"""A checkpoint read back, and the choice of the one to go on from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.blueprint import Blueprint
from orchestrator.checkpoint.file import CheckpointError, DamageError, numbered, read
from orchestrator.checkpoint.memory import Memory
from orchestrator.checkpoint.origin import blueprint_of
from orchestrator.checkpoint.snapshot import Snapshot, UnitState
from orchestrator.master.settings import in_ns

FOLDER = "checkpoints"


@dataclass(frozen=True)
class Checkpoint:
    number: int
    every: int
    """ns between checkpoints."""
    blueprint: Blueprint
    snapshot: Snapshot
    notes: list[str]
    """One line each about newer files that were passed over."""


def pack(snapshot: Snapshot) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """As JSON and arrays."""
    units = {name: {"steps": u.steps, "seconds": u.seconds, "messages": u.messages} for name, u in snapshot.units.items()}
    arrays = {f"master {path}": array for path, array in snapshot.master.arrays.items()}
    states = {f"state {name}": np.frombuffer(u.state, dtype=np.uint8) for name, u in snapshot.units.items()}
    return {"master": snapshot.master.plain, "units": units}, arrays | states


def unpack(about: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> Snapshot:
    units = {name: UnitState(state=arrays[f"state {name}"].tobytes(), **unit) for name, unit in about["units"].items()}
    prefix = "master "
    kept = {key.removeprefix(prefix): array for key, array in arrays.items() if key.startswith(prefix)}
    return Snapshot(Memory(dict(about["master"]), kept), units)


def newest(directory: Path, stop_time: float | None = None) -> Checkpoint:
    """The newest whole checkpoint of a run directory that a run to `stop_time` (s; None: as asked then) passes through."""
    files = numbered(directory / FOLDER)
    if not files:
        raise CheckpointError(f"{directory}: holds no checkpoint; give the folder of a run made with --checkpoint-every")
    notes: list[str] = []
    for number, path in files.items():
        try:
            about, arrays = read(path)
        except DamageError as damage:
            notes.append(f"{damage}; going on from the one before")
            continue
        if stop_time is None or _passed_through(about, stop_time):
            return Checkpoint(number, about["every"], blueprint_of(about, stop_time), unpack(about, arrays), notes)
    if len(notes) == len(files):
        raise CheckpointError(f"{directory}: all of its {len(files)} checkpoints are truncated or damaged; run again")
    raise CheckpointError(
        f"{directory}: no checkpoint is far enough before the stop times, {about['stop'] / 1e9:g} s then and {stop_time:g} s now,"
        " for the steps to it to be the same; give a later one, or run again"
    )


def _passed_through(about: Mapping[str, Any], stop_time: float) -> bool:
    """Whether no step up to there was, or would have been, cut to meet a stop time other than the present one."""
    stop = in_ns(stop_time)
    return bool(stop == about["stop"] or min(stop, about["stop"]) - about["time"] >= about["reach"])
