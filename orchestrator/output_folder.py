"""A folder that results go to."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryFile

from orchestrator.errors import UserError


def can_take_results(folder: Path, option: str = "--out") -> None:
    """Make the folder and see that files can be written to it: before a run, not after it. UserError where they cannot."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise UserError(f"{folder}: cannot take the results ({error.strerror}); give another {option}") from None
