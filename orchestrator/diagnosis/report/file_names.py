"""Names of files from names of landings, series and channels, which may hold anything."""

from __future__ import annotations

import re

_SPARED = re.compile(r"[^A-Za-z0-9._+\-]+")


class FileNames:
    """Stems without slashes or blanks, each given out once (also where file systems do not tell capitals)."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def stem(self, *parts: str) -> str:
        """The parts joined by underscores; a number behind where that is taken already."""
        wanted = "_".join(_SPARED.sub("-", part).strip(".") or "unnamed" for part in parts)
        if wanted.startswith(("+", "-")):
            wanted = "_" + wanted
        name, count = wanted, 1
        while name.lower() in self._taken:
            count += 1
            name = f"{wanted}_{count}"
        self._taken.add(name.lower())
        return name
