"""A checkpoint as a file: a line with format and SHA-256, then an npz archive. Never half-written, never read when damaged."""

from __future__ import annotations

import hashlib
import io
import json
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.errors import UserError

FORMAT = "lander-checkpoint-1"
KEPT = 3
"""Files kept: the newest, and older ones to fall back on."""
_NAME = re.compile(r"checkpoint_(\d+)\.bin")


class CheckpointError(UserError):
    """No checkpoint to go on from: none there, all damaged, or made with other units or by another version."""


class DamageError(Exception):
    """One line about a file that is not whole."""


def write(folder: Path, number: int, about: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> Path:
    """Into a temporary file, flushed to the disk, then renamed; files of other runs and old ones go afterwards."""
    body = io.BytesIO()
    text = json.dumps(about, default=lambda value: value.item()).encode()
    np.savez(body, allow_pickle=False, about=np.frombuffer(text, dtype=np.uint8), **{f"_{key}": value for key, value in arrays.items()})
    content = body.getbuffer()
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"checkpoint_{number:06d}.bin"
    half = path.with_suffix(".part")
    with half.open("wb") as file:
        file.write(f"{FORMAT} {hashlib.sha256(content).hexdigest()}\n".encode())
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    half.replace(path)
    stale = [file for other, file in numbered(folder).items() if not number - KEPT < other <= number]
    for old in (*stale, *folder.glob("checkpoint_*.part")):
        old.unlink(missing_ok=True)
    return path


def read(path: Path) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """What `write` was given, or a DamageError."""
    try:
        line, _, content = path.read_bytes().partition(b"\n")
    except OSError as error:
        raise DamageError(f"{path.name}: cannot be read ({error.strerror})") from None
    form, _, digest = line.decode("ascii", "replace").partition(" ")
    if re.fullmatch(r"lander-checkpoint-\d+", form) and form != FORMAT:
        raise CheckpointError(f"{path}: has the format {form}, this version reads {FORMAT}; resume with the version that wrote it")
    if form != FORMAT or hashlib.sha256(content).hexdigest() != digest:
        raise DamageError(f"{path.name}: is truncated or damaged (its SHA-256 does not fit)")
    with np.load(io.BytesIO(content), allow_pickle=False) as archive:
        about: dict[str, Any] = json.loads(archive["about"].tobytes())
        return about, {key[1:]: archive[key] for key in archive.files if key != "about"}


def numbered(folder: Path) -> dict[int, Path]:
    """Number -> file, newest first."""
    found = {int(match[1]): path for path in folder.glob("checkpoint_*.bin") if (match := _NAME.fullmatch(path.name))}
    return dict(sorted(found.items(), reverse=True))


def clear(folder: Path) -> None:
    """A new run begins here: nothing of an older one may be resumed."""
    for path in numbered(folder).values():
        path.unlink(missing_ok=True)
