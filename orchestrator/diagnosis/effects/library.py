"""Folders of effects -> effects by name."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from pathlib import Path

from pydantic import ValidationError

from orchestrator.diagnosis.effects.effect import Effect, known_keys
from orchestrator.diagnosis.places import CLOCK, parse, spelt_out
from orchestrator.errors import AddressError, EffectError, nearest
from orchestrator.scenario.faults import first_fault

LIBRARY = Path("scenarios") / "candidates"
"""The effects that come with the project, from its folder."""


def load_library(folders: Sequence[Path]) -> dict[str, Effect]:
    """Every *.toml of the folders, by the file's name; a name may stand in one folder only."""
    found: dict[str, Effect] = {}
    origin: dict[str, Path] = {}
    for folder in folders:
        if not folder.is_dir():
            raise EffectError(f"{folder}: no such folder; --effects expects one that holds effects (NAME.toml)")
        for path in sorted(folder.glob("*.toml")):
            if path.stem in found:
                raise EffectError(f"{path}: an effect {path.stem} is also in {origin[path.stem]}; rename one")
            found[path.stem], origin[path.stem] = load_effect(path), folder
    if not found:
        raise EffectError(f"{', '.join(map(str, folders)) or 'no folder'}: holds no effect; expects files NAME.toml (decision 9)")
    for name, effect in found.items():
        for twin in effect.twins:
            if twin not in found:
                raise EffectError(f"{origin[name] / name}.toml: twins: no effect {twin}; {nearest(twin, found)}")
    return found


def load_effect(path: Path) -> Effect:
    """One effect, or one line about the first thing wrong with its file."""
    try:
        tree = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise EffectError(f"{path}: not valid TOML: {error}; correct it there") from None
    except (OSError, UnicodeDecodeError) as error:
        raise EffectError(f"{path}: cannot be read ({error}); give a TOML file in UTF-8") from None
    try:
        effect = Effect.model_validate(tree)
    except ValidationError as error:
        raise EffectError(f"{path}: {first_fault(error, known_keys, path.name)}") from None
    effect._name = path.stem
    for parameter in effect.parameters:
        for _, address in parameter.signed_targets():
            _check_target(address, parameter.operation, f"{path}: parameters.{parameter.name}.target")
    for address in effect.fixed:
        _check_target(address, "set", f"{path}: fixed")
    return effect


def _check_target(address: str, operation: str, where: str) -> None:
    """Its form; whether the units have it is the scenario's matter."""
    try:
        places = {parse(part).place for part in spelt_out(address)}
    except AddressError as error:
        raise EffectError(f"{where}: {error}") from None
    if CLOCK in places and operation == "scale":
        raise EffectError(f"{where}: {address}: a clock has no value to scale; use add")
