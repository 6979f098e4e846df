"""How often a unit's doStep was called, rejected and repeated steps included.

The environment variable STEP_COUNTS names a folder; NAME.count in it holds one 64-bit integer, mapped into memory: no rollback
takes it back, and it is there however the process ends. Without the variable the count stays in the process.
"""

import mmap
import os
from pathlib import Path

BYTES = 8
maps: dict[str, mmap.mmap] = {}


class StepCount:
    """The count of one kind of unit in this process."""

    def __init__(self, name: str) -> None:
        if name not in maps:
            maps[name] = mapped(os.environ.get("STEP_COUNTS", ""), name)
        self.number = memoryview(maps[name]).cast("q")

    def add(self) -> None:
        self.number[0] += 1


def mapped(folder: str, name: str) -> mmap.mmap:
    """Eight bytes, in the folder's file or of nobody."""
    if not folder:
        return mmap.mmap(-1, BYTES)
    path = Path(folder) / f"{name}.count"
    if not path.exists():
        path.write_bytes(bytes(BYTES))
    with path.open("r+b") as file:
        return mmap.mmap(file.fileno(), BYTES)
