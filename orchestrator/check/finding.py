"""What a check says: one line a person can act on."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import StrEnum


class Verdict(StrEnum):
    PASS = "pass"
    NOTE = "note"
    """Not tried, or worth knowing; nothing to mend."""
    WARN = "warn"
    """The unit works in its place, but worse than it could."""
    FAIL = "FAIL"


@dataclass(frozen=True)
class Finding:
    check: str
    verdict: Verdict
    found: str
    """What was found, with both values where two are compared."""
    where: str = ""
    """The variable or port; empty: the whole unit."""
    do: str = ""

    def as_json(self) -> dict[str, str]:
        return {name: str(value) for name, value in asdict(self).items()}

    @staticmethod
    def from_json(data: dict[str, str]) -> Finding:
        return Finding(**{**data, "verdict": Verdict(data["verdict"])})  # type: ignore[arg-type]

    @property
    def line(self) -> str:
        """As in an error message."""
        where = f"{self.where}: " if self.where else ""
        return f"{where}{self.found}" + (f"; {self.do}" if self.do else "")
