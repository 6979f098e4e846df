"""A missing effect as the search sees it."""

from __future__ import annotations

from dataclasses import dataclass

from orchestrator.diagnosis.coordinates import Coordinate


@dataclass(frozen=True)
class Hypothesis:
    """Coordinates beyond the nuisances, and where to start them: p, one tuple a start."""

    name: str
    coordinates: tuple[Coordinate, ...]
    starts: tuple[tuple[float, ...], ...] = ()

    def scaled_starts(self) -> list[tuple[float, ...]]:
        """The starts as z."""
        return [tuple(c.scaled(p) for p, c in zip(start, self.coordinates, strict=True)) for start in self.starts]

    @property
    def slots(self) -> set[str]:
        """What it moves."""
        return {name for c in self.coordinates for name, _ in c.slots}


NULL = Hypothesis("nothing missing", ())


def joined(first: Hypothesis, second: Hypothesis) -> Hypothesis:
    """Both effects at once."""
    return Hypothesis(f"{first.name} + {second.name}", (*first.coordinates, *second.coordinates))


def turned_round(pair: str) -> str:
    """The pair's name with its effects the other way round."""
    return " + ".join(reversed(parts_of(pair)))


def parts_of(name: str) -> tuple[str, ...]:
    """The names that `joined` put together; none for nothing missing."""
    return () if name == NULL.name else tuple(name.split(" + "))
