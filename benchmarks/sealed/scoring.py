"""One case: its diagnosis against its key."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from orchestrator.diagnosis.hypothesis import parts_of

Tree = Mapping[str, Any]
Answer = Literal["right", "set", "wrong set", "wrong", "abstained", "refused", "nothing", "unjudged"]
"""right or wrong name; a set with or without the truth; none in it; "none of my effects"; "nothing missing";
data or numbers at fault, or no diagnosis."""
SURE = 0.9


@dataclass(frozen=True)
class Score:
    """What came of one case."""

    case: str
    kind: str
    energy: float
    truth: tuple[str, ...]
    verdict: str
    named: tuple[str, ...]
    """Names in the verdict; where it cannot tell, its answers, a pair written "a + b"."""
    answer: Answer
    probability: float
    """The least stated of the names; 0 without a name."""
    hits: int
    """Names that are in the truth."""
    closure: float
    """On the held-out landing; NaN where there is none."""
    errors: Mapping[str, float] = field(default_factory=dict)
    """effect.parameter → (found - true)/true, NaN-free."""
    pulls: Mapping[str, float] = field(default_factory=dict)
    """effect.parameter → (found - true)/stated sigma."""
    port: bool | None = None
    """Right port of a law outside the library; None elsewhere."""
    form: bool | None = None
    """Right form or its class."""
    seconds: float = math.nan
    simulations: float = math.nan
    by: str = ""
    """Commit of the method."""
    method: str = ""
    """What was called: `orchestrator diagnose`, or a baseline."""
    seed: tuple[int, ...] = ()
    """Makes the case again; no two cases share one."""
    skipped: tuple[str, ...] = ()
    """Effects that were drawn for it and not detectable."""


def scored(case: str, key: Tree, diagnosis: Tree | None, run: Tree | None = None, closure: float | None = None) -> Score:
    """closure: computed anew from the noise-free truth; without it what the diagnosis says itself."""
    said: Tree = diagnosis or {"verdict": "none given"}
    truth, named = tuple(effect["name"] for effect in key["effects"]), _named(said)
    parts = {part for name in named for part in parts_of(name)}
    effects = list(said.get("effects") or [])
    errors, pulls = _errors(key, effects)
    outside = key["kind"] == "outside"
    stated = (said.get("gap") or {}).get("closure")
    return Score(
        case, key["kind"], float(key["lambda"]), truth, str(said["verdict"]), named, _answer(said, key, truth, named),
        min((float(it.get("probability") or 0.0) for it in effects), default=0.0) if said["verdict"] in ("effect", "effects") else 0.0,
        len(set(truth) & parts), _number(closure if closure is not None else stated), errors, pulls,
        right_port(said, key) if outside else None, right_form(said, key) if outside else None,
        _number((run or {}).get("seconds")), _number((run or {}).get("simulations", said.get("simulations"))),
        str((run or {}).get("by", "")), method_of(str((run or {}).get("command", ""))), tuple(key.get("seed", ())),
        tuple(it["effect"] for it in key.get("skipped", ())),
    )  # fmt: skip


def method_of(command: str) -> str:
    """"orchestrator diagnose" or "sealed.baselines bic" of a command line, whichever the Python and the paths."""
    words = shlex.split(command)
    at = words.index("-m") + 1 if "-m" in words else 0
    return " ".join(it for it in words[at : at + 2] if not it.startswith("-"))


def _named(said: Tree) -> tuple[str, ...]:
    if said["verdict"] in ("effect", "effects"):
        return tuple(it["name"] for it in said.get("effects") or [])
    if said["verdict"] == "cannot_tell":
        told = said.get("cannot_tell") or {}
        return tuple(told.get("answers") or told.get("names") or [])
    return ()


def _answer(said: Tree, key: Tree, truth: Sequence[str], named: Sequence[str]) -> Answer:
    verdict = said["verdict"]
    if verdict in ("effect", "effects"):
        return "right" if set(named) == set(truth) and truth else "wrong"
    if verdict == "cannot_tell":
        law = (said.get("term") or {}).get("name")
        if key["kind"] == "outside" and law in named:
            return "set" if right_port(said, key) else "wrong set"
        return _answer_set(truth, named)
    simple: dict[str, Answer] = {"none_of_my_effects": "refused", "nothing_missing": "nothing"}
    return simple.get(str(verdict), "unjudged")


def _answer_set(truth: Sequence[str], named: Sequence[str]) -> Answer:
    """Right where one of its answers, which may be a pair, is the whole truth."""
    if not named:
        return "abstained"
    return "set" if any(set(parts_of(name)) == set(truth) for name in named) else "wrong set"


def _errors(key: Tree, effects: Sequence[Tree]) -> tuple[dict[str, float], dict[str, float]]:
    """Of parameters that the truth has and the verdict gives; errors as a share of the largest true parameter of the same effect."""
    errors, pulls = {}, {}
    true = {effect["name"]: effect for effect in key["effects"]}
    for effect in effects:
        mine = true.get(effect["name"])
        for name, found in (effect.get("parameters") or {}).items():
            if mine is None or name not in mine["parameters"]:
                continue
            prior = mine["prior"][name]
            largest = max(abs(value) / mine["prior"][it] for it, value in mine["parameters"].items()) * prior
            difference = float(found["value"]) - float(mine["parameters"][name])
            errors[f"{effect['name']}.{name}"] = difference / largest if largest else math.nan
            if found.get("sigma"):
                pulls[f"{effect['name']}.{name}"] = difference / float(found["sigma"])
    return {k: v for k, v in errors.items() if math.isfinite(v)}, pulls


def right_port(said: Tree, key: Tree) -> bool:
    """`term.port` of the diagnosis is the port of the hidden law."""
    return bool((said.get("term") or {}).get("port") == key["effects"][0]["port"])


def right_form(said: Tree, key: Tree) -> bool:
    """`term.fixed` (address → exponent, phase), or that of one of `term.rivals` in its class, is that of the hidden law."""
    term = said.get("term") or {}
    rivals = [it for it in term.get("rivals") or [] if isinstance(it, Mapping)]
    return any(same_form(it, key["effects"][0]) for it in (term, *rivals))


def same_form(term: Tree, law: Tree) -> bool:
    """Port and exponents agree; what is not written is 0."""
    if term.get("port", law["port"]) != law["port"] or not term.get("fixed"):
        return False
    names = {*term["fixed"], *law["fixed"]}
    return all(math.isclose(float(term["fixed"].get(it, 0.0)), float(law["fixed"].get(it, 0.0)), abs_tol=1e-9) for it in names)


def opened_keys(run: Tree, keys: Path) -> list[str]:
    """What a diagnosis opened of the keys; must be nothing."""
    inside = keys.resolve()
    return [path for path in run.get("opened") or [] if Path(path).resolve().is_relative_to(inside)]


def load(path: Path) -> dict[str, Any] | None:
    if not path.is_file():
        return None
    tree: dict[str, Any] = json.loads(path.read_text("utf-8"))
    return tree


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)
