"""The targets of the diagnosis, one row each: how many, how often, Wilson's bound, met or missed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

from sealed.kinds import NULLS
from sealed.scoring import SURE, Score
from sealed.wilson import wilson

Row = dict[str, Any]
Test = Callable[[Score], bool]
CEILING = ((16.0, 0.82), (25.0, 0.93), (49.0, 0.98), (100.0, 1.0))
"""λ, share of right names that a perfect judge reaches."""
MINUTES = 10.0
PLOWING = ("outside_tangent_slide",)
"""A law said to be outside the library that is `plowing` by another name; sets made before it was noticed (commit 27b3626) may hold it."""


@dataclass(frozen=True)
class Target:
    """A share of some cases, at least or at most."""

    text: str
    of: Test
    hit: Test
    bound: float
    at_most: bool = False


def _kind(*kinds: str) -> Test:
    return lambda score: score.kind in kinds and score.truth != PLOWING


def _named(score: Score) -> bool:
    return score.verdict in ("effect", "effects")


def _surely_named(score: Score) -> bool:
    return _named(score) and score.probability >= SURE and score.truth != PLOWING


def _right(score: Score) -> bool:
    return score.answer == "right"


TARGETS = (
    Target("false alarm on nulls, white noise", _kind("null white"), lambda s: s.answer != "nothing", 0.02, True),
    Target("false alarm on nulls, coloured noise", _kind("null coloured"), lambda s: s.answer != "nothing", 0.05, True),
    Target("right name at λ 25", _kind("single 25"), _right, 0.85),
    Target("right name at λ 49", _kind("single 49"), _right, 0.92),
    Target("right name at λ 100 and up", _kind("single 100", "single large"), _right, 0.95),
    Target("named with probability 0.9 or more and right", _surely_named, _right, 0.97),
    Target("twins: right set or right name", _kind("twin"), lambda s: s.answer in ("set", "right"), 0.85),
    Target("twins: wrong single name", _kind("twin"), lambda s: s.answer in ("wrong", "unjudged"), 0.05, True),
    Target("decoys given a name", _kind("decoy"), lambda s: _named(s) or s.answer == "unjudged", 0.05, True),
    Target("outside the library: refuses a library name", _kind("outside"), lambda s: s.answer in ("refused", "set"), 0.85),
    Target("outside the library: right port", _kind("outside"), lambda s: bool(s.port) and s.answer != "unjudged", 0.85),
    Target("outside the library: right form or its class", _kind("outside"), lambda s: bool(s.form) and s.answer != "unjudged", 0.70),
    Target("two effects: both", _kind("two"), _right, 0.65),
    Target("two effects: at least one", _kind("two"), lambda s: _named(s) and s.hits >= 1, 0.95),
)


def table(scores: Sequence[Score]) -> list[Row]:
    """Every target, then gap closure and cost."""
    rows = [row(target, scores) for target in TARGETS]
    singles = [s.closure for s in scores if s.truth and s.kind != "outside" and _named(s)]
    outside = [s.closure for s in scores if s.kind == "outside" and s.truth != PLOWING and s.answer != "unjudged"]
    nameless = [s.closure for s in scores if s.truth and s.kind != "outside" and s.answer == "refused"]
    rows.append(median_row("gap closed on a held-out landing, median of the named", singles, 0.90))
    rows.append(median_row("the same, outside the library", outside, 0.80))
    if any(map(math.isfinite, nameless)):  # a correction without a name, as a Gaussian process makes it
        rows.append(median_row("the same, corrected without a name", nameless, 0.90))
    rows.append(median_row("minutes of the median case", [s.seconds / 60.0 for s in scores], MINUTES, at_most=True))
    return rows


def row(target: Target, scores: Sequence[Score]) -> Row:
    of = [score for score in scores if target.of(score)]
    hits = sum(target.hit(score) for score in of)
    low, high = wilson(hits, len(of))
    return {
        "on sealed cases": target.text, "target": f"{'at most' if target.at_most else 'at least'} {target.bound:g}", "n": len(of),
        "figure": hits / len(of) if of else None, "95 % from": low if of else None, "95 % to": high if of else None,
        "met": met(hits / len(of) if of else math.nan, target.bound, target.at_most),
    }  # fmt: skip


def median_row(text: str, values: Sequence[float], bound: float, at_most: bool = False) -> Row:
    known = sorted(value for value in values if math.isfinite(value))
    figure = median(known) if known else math.nan
    return {
        "on sealed cases": text, "target": f"{'at most' if at_most else 'at least'} {bound:g}", "n": len(known),
        "figure": figure if known else None, "95 % from": _order(known, low=True), "95 % to": _order(known, low=False),
        "met": met(figure, bound, at_most),
    }  # fmt: skip


def met(figure: float, bound: float, at_most: bool) -> str:
    if not math.isfinite(figure):
        return "no case"
    return "met" if (figure <= bound if at_most else figure >= bound) else "missed"


def confusion(scores: Sequence[Score]) -> list[Row]:
    """Every case that was not answered as it should be."""
    wanted = dict.fromkeys(NULLS, ("nothing",)) | {"outside": ("refused", "set"), "twin": ("right", "set")}
    wrong = [score for score in scores if score.answer not in wanted.get(score.kind, ("right",))]
    return [
        {"case": s.case, "kind": s.kind, "λ": round(s.energy, 1), "hidden": ", ".join(s.truth) or "nothing", "verdict": s.verdict,
         "named": ", ".join(s.named) or "", "probability": round(s.probability, 3), "answer": s.answer}
        for s in wrong
    ]  # fmt: skip


def reliability(scores: Sequence[Score]) -> list[Row]:
    """Stated probability of single names against how often they are right."""
    rows = []
    for low, high in ((0.0, 0.5), (0.5, 0.9), (0.9, 0.97), (0.97, 0.99), (0.99, 1.0 + 1e-9)):
        of = [s for s in scores if _named(s) and low <= s.probability < high]
        hits = sum(map(_right, of))
        bounds = wilson(hits, len(of))
        rows.append({
            "stated probability": f"{low:g} to {min(high, 1.0):g}", "n": len(of),
            "mean stated": sum(s.probability for s in of) / len(of) if of else None,
            "right": hits / len(of) if of else None, "95 % from": bounds[0] if of else None, "95 % to": bounds[1] if of else None,
        })  # fmt: skip
    return rows


def parameter_errors(scores: Sequence[Score]) -> list[Row]:
    """Of cases with the right name: error as a share of the effect's largest parameter (in prior sigmas), and pulls by the stated sigma."""
    right = [s for s in scores if _right(s)]
    errors = [abs(value) for s in right for value in s.errors.values()]
    pulls = [abs(value) for s in right for value in s.pulls.values()]
    inside = sum(pull <= 2.0 for pull in pulls)
    return [{
        "parameters": len(errors), "median error": median(errors) if errors else None,
        "90 % below": sorted(errors)[math.ceil(0.9 * len(errors)) - 1] if errors else None,
        "within 2 stated sigma": inside / len(pulls) if pulls else None,
    }]  # fmt: skip


def _order(known: Sequence[float], low: bool) -> float | None:
    """95 % bound of a median by order statistics; none below six values."""
    n = len(known)
    if n < 6:
        return None
    below, k = 0.0, 0
    while below + math.comb(n, k) * 0.5**n <= 0.025:
        below += math.comb(n, k) * 0.5**n
        k += 1
    return known[k - 1] if low else known[n - k]
