"""The scenario as revised: the effects that were found, as overlays that run with `orchestrator run`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.effects.effect import Insert
from orchestrator.diagnosis.moves import Applied, Move, Named, applied_moves, sigma_of
from orchestrator.diagnosis.observation import SEEN
from orchestrator.diagnosis.overlay import Change, overridden, slot_of_unit, write_overlay
from orchestrator.scenario.read import Tree

REVISED = "revised.toml"


def write_revision(
    folder: Path,
    addresses: Addresses,
    named: Sequence[Named],
    title: str = "",
    remarks: Sequence[str] = (),
    master: Mapping[str, float] | None = None,
    overrides: Sequence[str] = (),
) -> Path:
    """revised.toml: the effects' values and the units they add; what was only uncertain before the landing stays as it was.

    Offsets of clocks are no unit's: they stand in `[results] clock_offsets`. master: settings other than the scenario's;  overrides: what
    the command line set, which the scenario's file does not have.
    """
    moves = [move for it in named for move in it.moves()]
    applied = applied_moves(addresses, moves)
    changes = [_change(addresses, address, applied, named) for address in applied.values]
    lines = [*remarks, *(f"--set {override}" for override in overrides), *_clock_remarks(applied.seen)]
    besides = overridden(addresses) if overrides else {}
    tables = _clock_table(applied.seen) | ({"master": dict(master)} if master else {})
    return write_overlay(folder / REVISED, addresses, changes, inserts_of(named), title, lines, tables, besides)


def write_landing(
    folder: Path, number: int, revised: Path, values: Mapping[str, ArrayLike], seen: Mapping[str, float], name: str = ""
) -> Path:
    """landing_N.toml on top of the revised scenario: this landing as fitted, nuisances and all. values: by address, all of them."""
    addresses = Addresses(draw_up(read_scenario(revised), revised))
    changes = [Change(address, value) for address, value in values.items() if not address.startswith(SEEN)]
    changes = [change for change in changes if _differs(addresses, change)]
    title = f"{addresses.blueprint.scenario.table.title}: landing {number}{f' ({name})' if name else ''} as fitted"
    path = folder / f"landing_{number}.toml"
    return write_overlay(path, addresses, changes, (), title, _clock_remarks(seen), _clock_table(seen))


def inserts_of(named: Sequence[Named]) -> list[Insert]:
    """Units that the effects add, each once."""
    found = {it.effect.insert.unit: it.effect.insert for it in named if it.effect.insert is not None}
    return list(found.values())


def _change(addresses: Addresses, address: str, applied: Applied, named: Sequence[Named]) -> Change:
    """With the standard deviation and the title of the effects behind it."""
    value = applied.values[address]
    variance, titles, known = np.zeros(len(value)), [], False
    for it in named:
        for parameter in it.effect.parameters:
            estimate = it.parameters.get(parameter.name)
            for factor, target in parameter.signed_targets():
                if target == address and estimate is not None:
                    move = Move(address, estimate.value, parameter.operation, factor)
                    variance = variance + sigma_of(move, value, estimate.sigma) ** 2
                    titles.append(it.effect.title)
                    known = True
    sigma = np.sqrt(variance) if known else None
    why = ", ".join(dict.fromkeys(titles)) or "goes with it"
    if len(set(value)) == 1 and len(addresses.groups(address)) == 1:
        return Change(address, value[0], None if sigma is None else sigma[:1], addresses.unit_of_measure(address), why)
    return Change(address, value, sigma, addresses.unit_of_measure(address), why)


def _differs(addresses: Addresses, change: Change) -> bool:
    own = slot_of_unit(addresses, change.address)
    if own is not None:
        return bool(change.value != addresses.number(own))
    now = applied_moves(addresses, [Move(change.address, change.value, "set")]).values[change.address]
    return now != [addresses.number(slot) for slot in addresses.resolve(change.address)]


def _clock_remarks(seen: Mapping[str, float]) -> list[str]:
    said = "added to what the clock of the data reads; no unit has it"
    return [f"{name} = {offset:.4g} s: {said}" for name, offset in seen.items() if offset]


def _clock_table(seen: Mapping[str, float]) -> Tree:
    offsets = {name.partition(".")[2]: offset for name, offset in seen.items() if offset and name.startswith("clock.")}
    return {"results": {"clock_offsets": offsets}} if offsets else {}
