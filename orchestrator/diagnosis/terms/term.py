"""A generic term: one coefficient times a product of powers at a port, for an effect that has no name yet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.vehicle import slots_of

Port = Literal["soil.normal", "soil.tangential", "strut", "body", "sensor"]
Energy = Literal["dissipative", "conservative", "active", "none"]
WIDEST = 10.0  # sigma of the coefficient's prior
STEPS: dict[Port, float] = {"soil.normal": 0.3, "soil.tangential": 0.03, "strut": 0.1, "body": 0.5, "sensor": 0.2}
"""Of z, for differences: what a landing feels, but not so much that it bends."""


@dataclass(frozen=True)
class Term:
    """c times a basis without unit. Decision 9 has the laws behind the addresses."""

    name: str
    port: Port
    unit: str
    """Kind of unit it acts in: soil, gear, body, sensor."""
    dependence: str
    """In words: "pad normal, quadratic in sink rate, while sinking"."""
    formula: str
    coefficient: str
    """Address of c."""
    fixed: tuple[tuple[str, float | int], ...]
    """Addresses of exponents, phase, axis, basis with their values."""
    sigma: float
    """Standard deviation of c before the landing, about 0."""
    measure: str
    """Unit of c."""
    positive: Energy
    """What it does to the energy for c > 0."""
    negative: Energy
    equals: str = ""
    """Effect of the library that is the same law, or has it as a component: refused there, it is not offered here as something new."""
    one_sided: bool = False
    """c >= 0 only."""

    def energy(self, c: float) -> Energy:
        """Passivity: a law that resists for c > 0 feeds the motion for c < 0, and is then called active."""
        return self.positive if c >= 0.0 else self.negative

    def words(self, c: float) -> str:
        """With what it does to the energy."""
        energy = self.energy(c)
        return self.dependence if energy == "none" else f"{self.dependence}, {energy}"

    def hypothesis(self, addresses: Addresses) -> Hypothesis | None:
        """As the search takes it; None where the twin of this scenario has no such port."""
        slots = _names(addresses, self.coefficient)
        fixed = [(name, float(value)) for address, value in self.fixed for name in _names(addresses, address)]
        if not slots or any(not _names(addresses, address) for address, _ in self.fixed):
            return None
        coordinate = Coordinate(
            self.name,
            tuple((name, 1.0) for name in slots),
            self.sigma,
            low=0.0 if self.one_sided else -WIDEST * self.sigma,
            high=WIDEST * self.sigma,
            positive=self.one_sided,
            unit=self.measure,
            step=STEPS[self.port],
            fixed=tuple(fixed),
        )
        return Hypothesis(self.name, (coordinate,))


def _names(addresses: Addresses, address: str) -> list[str]:
    return [name for group in slots_of(addresses, address) for name in group]
