"""When checkpoints are written: at the start, at the first step at or after each multiple of an interval, and on Ctrl-C."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from orchestrator.blueprint import Blueprint
from orchestrator.checkpoint.checkpoint import FOLDER, Checkpoint, pack
from orchestrator.checkpoint.file import CheckpointError, write
from orchestrator.checkpoint.origin import origin
from orchestrator.checkpoint.snapshot import take
from orchestrator.checkpoint.trial import require_claims, require_numbers, require_truth
from orchestrator.errors import ScenarioError
from orchestrator.master.master import Master
from orchestrator.master.settings import NANOSECONDS, in_ns


class Schedule:
    """Of one run; `begin`, then `after_step` after each, then `interrupt` where the user ended it."""

    def __init__(self, directory: Path, every: int, after: int = -1) -> None:
        """`every` in ns; `after` is the number of the checkpoint the run goes on from."""
        self._folder = directory / FOLDER
        self._every = every
        self._number = after + 1

    @classmethod
    def asked(cls, directory: Path, every: float) -> Schedule:
        """By `--checkpoint-every`, s."""
        if not (0.0 < every < float("inf") and in_ns(every)):
            raise ScenarioError(f"--checkpoint-every {every:g}: expects seconds of simulated time, at least 1e-9")
        return cls(directory, in_ns(every))

    @classmethod
    def continued(cls, directory: Path, checkpoint: Checkpoint) -> Schedule:
        return cls(directory, checkpoint.every, checkpoint.number)

    def check(self, master: Master) -> None:
        """Before anything is computed."""
        require_claims(master.system.slaves)
        require_numbers(master.system)

    def begin(self, master: Master, blueprint: Blueprint, fresh: bool) -> None:
        """After `prepare`. The first file is written at once: from here on this run, and no older one, is what `resume` finds."""
        if fresh:
            require_truth(master)
        self._master = master
        limits, table = master.limits, blueprint.scenario.table
        self._begin = in_ns(table.start_time)
        self._about: dict[str, Any] = origin(blueprint) | {
            "every": self._every,
            "stop": in_ns(table.stop_time),
            "reach": limits.maximum + limits.minimum,
        }
        try:
            self._write()
        except OSError as error:
            raise CheckpointError(f"{self._folder}: cannot be written ({error.strerror}); give another --out") from None

    def after_step(self) -> None:
        if self._master.time >= self._due and not self._master.complete:
            self._try_to_write()

    def interrupt(self) -> None:
        """The user ended the run between two steps."""
        self._try_to_write()

    def _try_to_write(self) -> None:
        """A full disk costs a checkpoint, not the run."""
        try:
            self._write()
        except OSError as error:
            self._due = self._next_multiple()
            time = self._master.time / NANOSECONDS
            where = f"{self._folder}: checkpoint at t = {time:.9g} s"
            self._master.warnings.append(f"{where}: cannot be written ({error.strerror}); make room there")

    def _write(self) -> None:
        state, arrays = pack(take(self._master))
        write(self._folder, self._number, self._about | state | {"time": self._master.time}, arrays)
        self._number += 1
        self._due = self._next_multiple()

    def _next_multiple(self) -> int:
        return self._begin + ((self._master.time - self._begin) // self._every + 1) * self._every
