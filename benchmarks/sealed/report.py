"""Scores of a set as Markdown, ready for docs/diagnosis-bench.md, with its JSON and its figure."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

from tables import markdown, write_json

from sealed import targets
from sealed.closure import kept_closure
from sealed.figures import psychometric
from sealed.pool import one_method
from sealed.scoring import Score, load, opened_keys, scored
from sealed.vehicle import Vehicle

CURVE = "bench_psychometric.png"


class UnsealedError(Exception):
    """A diagnosis that saw a key, or a key that is not the one the set was made with."""


def scores_of(keys: Path, results: Path, recompute: bool, told: Callable[[str], None] | None = None) -> list[Score]:
    """All cases that have a result; `recompute`: closure from the noise-free truth, half a minute a case the first time."""
    vehicle = Vehicle() if recompute else None
    found = []
    for path in sorted(keys.glob("[0-9]*.json")):
        key, place = load(path) or {}, results / path.stem
        run, diagnosis = load(place / "run.json"), load(place / "diagnosis.json")
        if run is None and diagnosis is None:
            continue
        if diagnosis is not None and not (run or {}).get("watched"):
            raise UnsealedError(f"{place}: nobody noted which files this diagnosis opened; its result is void")
        seen = opened_keys(run or {}, keys)
        if seen:
            raise UnsealedError(f"{place}: this diagnosis opened {seen[0]}; its result is void")
        closure = kept_closure(vehicle, key, diagnosis, place / "closure.json") if vehicle and diagnosis else None
        found.append(scored(path.stem, key, diagnosis, run, closure))
        if told is not None:
            told(path.stem)
    one_method(found)
    return found


def report(scores: Sequence[Score], out: Path, title: str = "") -> str:
    """DIR/score.md, score.json and the figure; the Markdown."""
    out.mkdir(parents=True, exist_ok=True)
    psychometric(scores, out / CURVE)
    parts = [title, _head(scores), markdown(targets.table(scores)), f"![right names against signature energy]({CURVE})\n"]
    parts += ["How often a stated probability is right:\n", markdown(targets.reliability(scores))]
    parts += ["Parameters of rightly named effects:\n", markdown(targets.parameter_errors(scores))]
    wrong = targets.confusion(scores)
    parts += ["Every case answered otherwise than it should be:\n", markdown(wrong) if wrong else "None.\n"]
    parts += [_too_small(scores)]
    text = "\n".join(part for part in parts if part)
    (out / "score.md").write_text(text, "utf-8")
    write_json(out, "score", [_plain(asdict(score)) for score in scores])
    return text


def _head(scores: Sequence[Score]) -> str:
    simulations = sorted(s.simulations for s in scores if math.isfinite(s.simulations))
    unjudged = sum(s.answer == "unjudged" for s in scores)
    middle = f", {simulations[len(simulations) // 2]:,.0f} simulations in the median case" if simulations else ""
    told = f"{unjudged} without a verdict on effects (they count against every target for verdicts; closure and minutes leave them out)"
    return f"{len(scores)} cases{middle}; {told}.{_of_plowing(scores)}\n"


def _of_plowing(scores: Sequence[Score]) -> str:
    count = sum(s.truth == targets.PLOWING for s in scores)
    return f" {count} of a law that is plowing by another name is left out." if count else ""


def _too_small(scores: Sequence[Score]) -> str:
    """Effects that were drawn and could not reach the asked energy within three prior standard deviations."""
    counts = Counter(name for score in scores for name in score.skipped)
    shown = ", ".join(f"{name} {count}" for name, count in counts.most_common())
    return f"Drawn, but not detectable at the energy asked for (times): {shown or 'none'}.\n"


def _plain(tree: dict[str, object]) -> dict[str, object]:
    return {key: None if isinstance(value, float) and not math.isfinite(value) else value for key, value in tree.items()}
