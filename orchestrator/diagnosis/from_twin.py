"""The twin's values -> the same by address: what the search fitted, for the co-simulation to fly."""

from __future__ import annotations

from collections.abc import Mapping

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.moves import Applied
from orchestrator.diagnosis.observation import SEEN
from orchestrator.diagnosis.places import LEGS, PLACES, parse
from orchestrator.errors import AddressError
from orchestrator.master.slave import stem

STEPPING = ("tolerance", "longest_step", "longest_substep", "variation")
"""Of the twin's own integrator: the units have theirs."""
GROUND = "terrain."
"""What lies on the plane: the scenario's own, moved by no coordinate."""
AZIMUTH = "azimuth"
_INSIDE = tuple(place for place in PLACES if place not in ("body", "gear"))
_TWICE = {"mass": ("body.mass", "gear.vehicle_mass"), "gravity": ("body.gravity", "gear.gravity"),
          "footpad_radius": ("gear.footpad_radius", "soil.footpad_radius"),
          "footpad_height": ("gear.footpad_height", "soil.footpad_height")}  # fmt: skip


def said_by_address(addresses: Addresses, values: Mapping[str, float]) -> Applied:
    """values: by the twin's names, `sensor.NAME`, `clock.SERIES`, `time.origin`. Those that the scenario has anyway are left out."""
    seen = {name: value for name, value in values.items() if name.startswith(SEEN)}
    vectors: dict[str, dict[str, float]] = {}
    for name, value in values.items():
        if name not in seen and name not in STEPPING and not name.startswith(GROUND):
            vectors.setdefault(stem(name), {})[name] = float(value)
    found: dict[str, list[float]] = {}
    for vector, elements in vectors.items():
        for address in _addresses(addresses, vector):
            slots = addresses.resolve(address)
            names = addresses.twin(address) or _of_one_leg(address)
            base = [addresses.number(slot) for slot in slots]
            moved = _spread(names, elements, base)
            if moved != base:
                found[address] = moved
    return Applied(found, seen)


def _addresses(addresses: Addresses, vector: str) -> tuple[str, ...]:
    if vector == AZIMUTH and not addresses.is_twin:
        return tuple(f"gear[{leg}].{AZIMUTH}" for leg in LEGS)
    if vector in _TWICE:
        return _TWICE[vector]
    if vector.partition(".")[0] in _INSIDE:
        return (vector,)
    for place in ("body", "gear"):
        if vector in addresses.interface(place, None, vector).vectors:
            return (f"{place}.{vector}",)
    raise AddressError(f"{addresses.where}: {vector}: no unit has what the twin calls so")


def _of_one_leg(address: str) -> list[str]:
    """The twin's azimuths have no address of their own: they are the legs' names for it."""
    return [f"{AZIMUTH}[{LEGS.index(parse(address).leg or LEGS[0]) + 1}]"]


def _spread(names: list[str], elements: Mapping[str, float], base: list[float]) -> list[float]:
    """For each slot: the slots run through the twin's elements, once for each unit that has them all."""
    return [elements.get(names[i % len(names)], number) for i, number in enumerate(base)]
