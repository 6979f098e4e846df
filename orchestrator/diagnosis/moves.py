"""What was fitted, said by addresses: nuisances first, then effects on top of them, as values for the co-simulation.

Where two moves touch the same number (the friction of all soils, then that of one) the later acts on what the earlier left.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from orchestrator.diagnosis.addresses import Addresses, Slot
from orchestrator.diagnosis.effects.effect import Effect
from orchestrator.diagnosis.observation import SEEN
from orchestrator.diagnosis.outcome import Estimate
from orchestrator.errors import AddressError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Move:
    """One address moved: add factor·p, times exp(factor·p), or set to factor·p. p: one number for all, one a component, or one a slot."""

    address: str
    p: ArrayLike
    operation: Literal["add", "scale", "set"] = "add"
    factor: float = 1.0


@dataclass(frozen=True)
class Applied:
    """Values by address, as `overlay` and `CoSimulation.fly` take them, and what is for the clocks."""

    values: Mapping[str, list[float]]
    seen: Mapping[str, float]
    """clock.SERIES and time.origin, s: for `Observation.predicted`."""


def applied_moves(addresses: Addresses, moves: Iterable[Move]) -> Applied:
    """One move after the other on the base scenario."""
    numbers: dict[Slot, float] = {}
    slots: dict[str, list[Slot]] = {}
    seen: dict[str, float] = {}
    for move in moves:
        if move.address.startswith(SEEN):
            seen[move.address] = _moved(seen.get(move.address, 0.0), move, float(np.asarray(move.p).ravel()[0]))
            continue
        slots[move.address] = addresses.resolve(move.address)
        for slot, p in _spread(addresses, move, slots[move.address]).items():
            numbers[slot] = _moved(numbers.get(slot, addresses.number(slot)), move, p)
    return Applied({address: [numbers[slot] for slot in each] for address, each in slots.items()}, seen)


def effect_moves(effect: Effect, parameters: Mapping[str, float]) -> list[Move]:
    """Of an effect with its parameters' p by name; one that is not given stays at its null."""
    unknown = sorted(set(parameters) - {it.name for it in effect.parameters})
    if unknown:
        raise AddressError(f"{effect.name}: no parameter {unknown[0]}; it has {', '.join(it.name for it in effect.parameters)}")
    fixed = [Move(address, np.asarray(value, dtype=np.float64), "set") for address, value in effect.fixed.items()]
    return fixed + [
        Move(address, parameters.get(it.name, it.null), it.operation, factor)
        for it in effect.parameters
        for factor, address in it.signed_targets()
    ]


def sigma_of(move: Move, value: Sequence[float], sigma: float) -> Array:
    """Standard deviation of the moved values from that of p."""
    scale = np.abs(np.asarray(value)) if move.operation == "scale" else np.ones(len(value))
    return abs(move.factor) * sigma * scale


@dataclass(frozen=True)
class Named:
    """An effect of the library with what was estimated of it."""

    effect: Effect
    parameters: Mapping[str, Estimate]

    def moves(self) -> list[Move]:
        return effect_moves(self.effect, {name: it.value for name, it in self.parameters.items()})


def _moved(now: float, move: Move, p: float) -> float:
    if move.operation == "add":
        return now + move.factor * p
    return float(now * np.exp(move.factor * p)) if move.operation == "scale" else move.factor * p


def _spread(addresses: Addresses, move: Move, slots: Sequence[Slot]) -> dict[Slot, float]:
    """p of every slot."""
    given = np.atleast_1d(np.asarray(move.p, dtype=np.float64)).ravel().tolist()
    if len(given) == 1:
        return dict.fromkeys(slots, given[0])
    groups = addresses.groups(move.address)
    if len(given) == len(groups):
        return {slot: p for group, p in zip(groups, given, strict=True) for slot in group}
    if len(given) == len(slots):
        return dict(zip(slots, given, strict=True))
    raise AddressError(f"{addresses.where}: {move.address}: is moved by {len(given)} numbers, expects {len(groups)}; give one a component")
