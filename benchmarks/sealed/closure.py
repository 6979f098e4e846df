"""Gap closure on the held-out landing, computed anew: the share of the signature's energy after nuisances that the verdict takes away.

1 - λ(truth - revised)/λ(truth - base), all without noise, at the true nuisances and the true reality gap: nothing in it is the diagnosis'
own but the names and numbers of its verdict.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from orchestrator.diagnosis.effects import Effect
from sealed.energy import energy
from sealed.hidden import Signatures
from sealed.kinds import Plan
from sealed.make import HOLDOUT, scenes_of
from sealed.outside import law
from sealed.vehicle import Vehicle

Tree = Mapping[str, Any]
FELT = 9.0  # λ on the held-out landing below which there is no gap to close


def closure(vehicle: Vehicle, key: Tree, diagnosis: Tree) -> float:
    """NaN where the held-out landing does not show what is hidden, or the verdict names nothing."""
    revised = _revised(vehicle, diagnosis)
    if not revised or not key["effects"]:
        return math.nan
    lander = vehicle.lander()
    try:
        signatures = Signatures(vehicle, scenes_of(vehicle, plan_of(key), key["seed"])[HOLDOUT], lander)
        before = signatures.whitened(np.array(key["holdout"]["clean"]))
        if energy(before, signatures.slopes) < FELT:
            return math.nan
        change = signatures.signature([effect for effect, _ in revised], [z for _, z in revised])
        return math.nan if change is None else 1.0 - energy(before - change, signatures.slopes) / energy(before, signatures.slopes)
    finally:
        lander.close()


def kept_closure(vehicle: Vehicle, key: Tree, diagnosis: Tree, path: Path) -> float:
    """The same, kept in a file."""
    if path.is_file():
        value = json.loads(path.read_text("utf-8"))
    else:
        found = closure(vehicle, key, diagnosis)
        value = found if math.isfinite(found) else None
        path.write_text(json.dumps(value) + "\n", "utf-8")
    return math.nan if value is None else float(value)


def plan_of(key: Tree) -> Plan:
    return Plan(key["number"], key["kind"], key["target"], key["colour"], key["misstated"], key["path"])


def _revised(vehicle: Vehicle, diagnosis: Tree) -> list[tuple[Effect, Sequence[float]]]:
    """Effects of the verdict, or the term it found, at their values."""
    named = [it for it in diagnosis.get("effects") or [] if it["name"] in vehicle.effects]
    found = [_at(vehicle, vehicle.effects[it["name"]], it["parameters"]) for it in named]
    term = diagnosis.get("term") or {}
    if not found and diagnosis.get("verdict") == "none_of_my_effects":
        found = [_law_of(it, f"term{k}") for k, it in enumerate((term, term.get("second") or {})) if _has_size(it)]
    return found


def _has_size(term: Tree) -> bool:
    return bool(term.get("fixed") and (term.get("coefficient") or {}).get("value"))


def _law_of(term: Tree, name: str) -> tuple[Effect, Sequence[float]]:
    value = float(term["coefficient"]["value"])
    exponents = {address.partition(".")[2]: exponent for address, exponent in term["fixed"].items()}
    return law(name, abs(value), "term", term["port"], "active", **exponents), [math.copysign(1.0, value)]


def _at(vehicle: Vehicle, effect: Effect, parameters: Tree) -> tuple[Effect, Sequence[float]]:
    values = [float(parameters[it.name]["value"]) if it.name in parameters else it.null for it in effect.parameters]
    return effect, [(p - c.mean) / c.sigma for p, c in zip(values, vehicle.coordinates(effect), strict=True)]
