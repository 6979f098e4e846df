"""FMUs are unpacked under a name made of their content: plain ASCII, one copy for all runs, never a half-written one."""

from __future__ import annotations

import hashlib
import os
import re
import tempfile
import zipfile
from pathlib import Path

from orchestrator.errors import UnitError

_PLAIN = re.compile(r"[A-Za-z0-9._/\\:-]+")


def content_hash(path: Path) -> str:
    """SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def unpack(path: Path, sha256: str) -> Path:
    """Folder that holds the unpacked FMU."""
    folder = private_folder() / sha256[:24]
    if folder.is_dir():
        return folder
    with tempfile.TemporaryDirectory(dir=folder.parent) as scratch:
        half = Path(scratch) / "fmu"
        try:
            with zipfile.ZipFile(path) as archive:
                archive.extractall(half)
        except (zipfile.BadZipFile, OSError) as error:
            raise UnitError(f"{path}: cannot be unpacked ({error}); build or download it again") from None
        try:
            half.rename(folder)
        except OSError:                      # another process was faster with the same content
            if not folder.is_dir():
                raise
    return folder


def private_folder() -> Path:
    """A private folder whose path holds plain ASCII only: some runtimes crash on `#`, `+`, `%` or anything beyond ASCII."""
    owner = str(os.getuid()) if hasattr(os, "getuid") else "user"
    for base in (Path(tempfile.gettempdir()), Path("/var/tmp"), Path("/tmp")):
        root = base / f"unpacked-fmus-{owner}"
        if not _PLAIN.fullmatch(str(root)):
            continue
        try:
            root.mkdir(mode=0o700, exist_ok=True)
        except OSError:
            continue
        if not hasattr(os, "getuid") or root.stat().st_uid == os.getuid():
            return root
    raise UnitError("no temporary folder with a plain ASCII path; set TMPDIR to one")
