"""From fits to a verdict: probabilities of the hypotheses, who is adequate, and when to abstain.

Half of the prior belongs to nothing missing, the other half to the library in equal shares; all its pairs share a twentieth, all laws
outside it as much. The rules are those of docs/diagnosis.md: a name needs probability 0.9, an adequate residual, evidence 5 above nothing
missing, and a held-out landing that gains. What it gains counts as evidence, of who is HEARD and CLOSE.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, log

import numpy as np
from scipy.special import logsumexp

from orchestrator.diagnosis.hypothesis import NULL, parts_of
from orchestrator.diagnosis.outcome import Verdict

SURE = 0.9
BEATS = 5.0  # ln evidence above nothing missing
HEARD, CLOSE = 1.0, 5.0  # ln evidence over nothing missing, ln probability behind the best: of whom the held-out landings are asked
ADEQUATE = 0.01  # p-value of a residual
BY_CHANCE = 10.0  # ln evidence above nothing missing that noise may lend an effect; in seven nulls and decoys 1.9 at most
LOST = 1e-3  # p-value below which nothing missing is refused by itself
TOGETHER = 0.05  # prior of any two effects at once
OUTSIDE = 0.05  # as much for any one law that the library does not have


@dataclass(frozen=True)
class Judged:
    """What is known of one hypothesis."""

    name: str
    log_evidence: float
    adequacy: float
    holdout_gain: float | None = None
    holdout_adequacy: float | None = None
    laws: int = 0
    """Of a law outside the library: how many were tried. 0: nothing missing, or of the library."""

    @property
    def stands(self) -> bool:
        """Adequate here, and on the held-out landings better than nothing missing."""
        return self.adequacy >= ADEQUATE and (
            self.holdout_gain is None or (self.holdout_gain > 0.0 and (self.holdout_adequacy or 0.0) >= LOST)
        )


def probabilities(hypotheses: Sequence[Judged], singles: int) -> dict[str, float]:
    """Posterior of each; `singles` is the size of the library."""
    weights = [h.log_evidence + log(prior_of(h, singles)) for h in hypotheses]
    shifted = np.exp(np.array(weights) - max(weights))
    return {h.name: float(w) for h, w in zip(hypotheses, shifted / shifted.sum(), strict=True)}


def prior_of(one: Judged, singles: int) -> float:
    """Of nothing missing, of a law outside the library, of an effect, of one of all pairs, not only those that looked worth fitting."""
    if one.laws:
        return 0.5 * OUTSIDE / one.laws
    parts, pairs = len(parts_of(one.name)), max(singles * (singles - 1) // 2, 1)
    return 0.5 if parts == 0 else 0.5 * (1.0 - TOGETHER) / max(singles, 1) if parts == 1 else 0.5 * TOGETHER / pairs


def credible(hypotheses: Sequence[Judged], singles: int) -> tuple[str, ...]:
    """Effects and laws from the top until they hold SURE of what all have together; none where evidence does not ask for one.

    One alone must hold SURE of everything: what is left of a tenth may be nothing missing's.
    """
    found = probabilities(hypotheses, singles)
    evidence = {h.name: h.log_evidence for h in hypotheses}
    ranked = sorted((n for n in found if n != NULL.name), key=lambda n: -found[n])
    if not ranked or evidence[ranked[0]] - evidence[NULL.name] < BEATS or found[NULL.name] > 1.0 - SURE:
        return ()
    total = sum(found[n] for n in ranked)
    held = np.cumsum([found[n] / total for n in ranked])
    chosen = tuple(ranked[: int(np.searchsorted(held, SURE)) + 1])
    return chosen if len(chosen) > 1 or found[chosen[0]] >= SURE else ()


def contenders(hypotheses: Sequence[Judged], singles: int) -> tuple[str, ...]:
    """Whom the held-out landings are to be asked about, most probable first: the credible, and who is HEARD and CLOSE to the best."""
    found, named = probabilities(hypotheses, singles), credible(hypotheses, singles)
    evidence = {h.name: h.log_evidence for h in hypotheses}
    ranked = sorted((n for n in found if n != NULL.name), key=lambda n: -found[n])
    heard = [n for n in ranked if evidence[n] > evidence[NULL.name] + HEARD]
    return tuple(n for n in ranked if n in named or (n in heard and found[n] > found[heard[0]] * exp(-CLOSE)))


def informed(hypotheses: Sequence[Judged], singles: int) -> list[Judged]:
    """The hypotheses with what the held-out landings say of the contenders in their evidence; as they were where not all were asked.

    Evidence of one landing and then of another, with what the first taught as the prior, multiplies: Bayes' rule taken twice. Who was
    HEARD but not asked keeps its distance to those who were.
    """
    named, evidence = contenders(hypotheses, singles), {h.name: h.log_evidence for h in hypotheses}
    rivals = [h for h in hypotheses if h.name in named and h.adequacy >= ADEQUATE]
    gains = np.array([np.nan if one.holdout_gain is None else one.holdout_gain for one in rivals])
    if not rivals or np.isnan(gains).any():
        return list(hypotheses)
    before = np.array([one.log_evidence + log(prior_of(one, singles)) for one in rivals])
    gained = {one.name: gain for one, gain in zip(rivals, gains.tolist(), strict=True)}
    common = float(logsumexp(before + gains) - logsumexp(before))
    rest = {h.name: common if h.log_evidence > evidence[NULL.name] + HEARD else 0.0 for h in hypotheses}
    return [replace(h, log_evidence=h.log_evidence + gained.get(h.name, rest[h.name])) for h in hypotheses]


@dataclass(frozen=True)
class Judgement:
    """The verdict with the names it is about, most probable first."""

    verdict: Verdict
    names: tuple[str, ...]
    probabilities: Mapping[str, float]
    why: str = ""
    answers: tuple[str, ...] = ()
    """Hypotheses, pairs among them, between which the data cannot tell, most probable first; the names are those of their effects.
    With none_of_my_effects: the law outside the library that is more probable than any of it.
    """


def judge(hypotheses: Sequence[Judged], singles: int) -> Judgement:
    """hypotheses must hold nothing missing; a law outside the library that does not stand is left out."""
    hypotheses = [h for h in hypotheses if h.stands or not h.laws]
    known, both = {h.name: h for h in hypotheses}, informed(hypotheses, singles)
    found, null = probabilities(both, singles), known[NULL.name]
    of_both = credible(both, singles)
    named = of_both or credible(hypotheses, singles)
    if not named:
        if null.adequacy < LOST:
            return Judgement(
                "none_of_my_effects", (), found, "nothing missing is not adequate, and no effect of the library is better by enough"
            )
        return Judgement("nothing_missing", (), found)
    best = known[named[0]]
    standing = tuple(n for n in of_both if known[n].stands)
    if not standing:
        if null.adequacy >= LOST and best.adequacy >= ADEQUATE and best.log_evidence - null.log_evidence < BY_CHANCE:
            return Judgement("nothing_missing", (), found, f"{best.name} fits better, but not on the held-out landing")
        held = "" if best.holdout_gain is None else " or fails on the held-out landing"
        return Judgement(
            "none_of_my_effects",
            (),
            found,
            f"the best of the library, {best.name}, leaves more than noise{held}",
        )
    if len(named) == 1 or (len(standing) == 1 and found[standing[0]] >= SURE):
        if known[standing[0]].laws:
            return Judgement("none_of_my_effects", (), found, answers=standing)
        return Judgement("effects" if len(parts_of(standing[0])) == 2 else "effect", parts_of(standing[0]), found)
    names = tuple(dict.fromkeys(part for n in named for part in parts_of(n)))
    return Judgement("cannot_tell", names, found, answers=named)
