"""A search's fit as the co-simulation can fly it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from orchestrator.diagnosis.addresses import Addresses, Slot
from orchestrator.diagnosis.coordinates import applied
from orchestrator.diagnosis.effects.effect import Insert
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.from_twin import said_by_address
from orchestrator.diagnosis.moves import Applied
from orchestrator.diagnosis.observation import SEEN
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.proof import Belief

Fitted = tuple[Landings, Fit]


def belief_of(addresses: Addresses, name: str, fits: Sequence[Fitted], inserts: Sequence[Insert] = ()) -> Belief:
    """fits: of the landings in the order of the proof's, e.g. first the fitted ones together, then the held-out ones together."""
    said = [one for landings, fit in fits for one in fitted_values(addresses, landings, fit)]
    rows = [fit.predicted[part] for landings, fit in fits for part in landings.parts]
    return Belief(name, [one.values for one in said], [one.seen for one in said], tuple(inserts), rows)


def without_effect(addresses: Addresses, name: str, fits: Sequence[Fitted], nuisances: int) -> Belief:
    """The same nuisances, which are the first coordinates, and none of the effect. Nothing was searched there, so nothing is compared."""
    said = [one for landings, fit in fits for one in fitted_values(addresses, landings, fit, nuisances)]
    return Belief(name, [one.values for one in said], [one.seen for one in said])


def fitted_values(addresses: Addresses, landings: Landings, fit: Fit, first: int | None = None) -> list[Applied]:
    """Values by address of each landing at the fit; of its `first` coordinates only, where given."""
    coordinates, z = fit.coordinates[:first], fit.z[:first]
    every: list[Mapping[str, float]] = [{**base, **applied(base, coordinates, z, k)} for k, base in enumerate(landings.bases)]
    return [said_by_address(addresses, values) if in_twin(values) else _said_by_unit(addresses, values) for values in every]


def in_twin(values: Mapping[str, float]) -> bool:
    """Whether the search flew the twin: its `mass` has no unit before it."""
    return any("." not in name for name in values)


def _said_by_unit(addresses: Addresses, values: Mapping[str, float]) -> Applied:
    """What a search through the master was given, less what the scenario has anyway."""
    seen = {name: value for name, value in values.items() if name.startswith(SEEN)}
    own = {name: [value] for name, value in values.items() if name not in seen and value != _now(addresses, name)}
    return Applied(own, seen)


def _now(addresses: Addresses, name: str) -> float:
    unit, _, variable = name.partition(".")
    return addresses.number(Slot(unit, variable))
