"""Which kind of unit an FMU means to be, from its ports."""

from __future__ import annotations

from collections.abc import Sequence

from orchestrator.check.contract import Contract, contract_of, kinds
from orchestrator.master.slave import Interface

_LEAST = 0.6
"""Share of the required variables that must be there, by name and causality."""


def guessed(interface: Interface, own_word: str = "") -> Contract | None:
    """The kind of which most is there; `own_word` is what the FMU itself says, where it says anything."""
    known = [contract_of(kind) for kind in kinds()]
    for contract in known:
        if contract.kind == own_word:
            return contract
    return _best(interface, known)


def _best(interface: Interface, known: Sequence[Contract]) -> Contract | None:
    ranked = sorted(((_likeness(interface, contract), contract) for contract in known), key=lambda pair: pair[0], reverse=True)
    (best, contract), (second, _) = ranked[0], ranked[1]
    return contract if best[0] >= _LEAST and best > second else None


def _likeness(interface: Interface, contract: Contract) -> tuple[float, float]:
    """Share of what is required that is there; then how much of what the unit has is known to the contract."""
    there = [bool(interface.elements(member.name, member.causality)) for member in contract.required]
    coupled = {name for name, elements in interface.vectors.items() if elements[0].causality in ("input", "output")}
    known = {member.name for member in contract.members}
    return sum(there) / len(there), len(coupled & known) / max(1, len(coupled))
