"""The verdict in words: one sentence, how far it goes, what to do next."""

from __future__ import annotations

from math import isfinite

from orchestrator.diagnosis.hypothesis import NULL, parts_of
from orchestrator.diagnosis.outcome import NamedEffect, Outcome
from orchestrator.diagnosis.report.numbers import chance, number, percent, shown_unit, spelt, with_sigma

LABELS = {
    "nothing_missing": "nothing missing",
    "effect": "one effect",
    "effects": "several effects",
    "cannot_tell": "cannot tell",
    "none_of_my_effects": "not in the library",
    "numerics": "numerics",
    "data_fault": "data fault",
}
LEAST_GAIN = 0.005
"""Closures smaller than this are not worth a sentence."""


def verdict_sentence(outcome: Outcome) -> str:
    """The verdict in one or two sentences; `Outcome.sentence` where it is filled already."""
    if outcome.sentence:
        return outcome.sentence
    write = {"effect": _missing, "effects": _missing, "cannot_tell": _cannot_tell, "none_of_my_effects": _outside, "data_fault": _fault}
    if outcome.verdict in write:
        return write[outcome.verdict](outcome)
    if outcome.verdict == "numerics":
        return "The numerics are not fine enough to judge."
    return "Nothing is missing that these data could show."


def caution(outcome: Outcome) -> str:
    """How far the verdict goes."""
    if outcome.verdict in ("effect", "effects"):
        found = "; ".join(_found(effect) for effect in outcome.effects) or "this effect"
        return f"The readings are consistent with {found}. A law that is not in the library and acts alike would look the same."
    instead = listed([inside(title_of(outcome, name)) for name in parts_of(outcome.term.get("instead_of") or NULL.name)])
    if outcome.verdict == "none_of_my_effects" and instead:
        return f"The readings are consistent with {instead}, too. A law that is not in the library is more probable."
    pairs = ", and no pair of them," if any(len(parts_of(c.name)) > 1 for c in outcome.candidates) else ""
    return {
        "nothing_missing": "The readings are consistent with the scenario as it stands. What a landing does not excite cannot show in it.",
        "cannot_tell": "The readings are consistent with each of these effects. Choosing one would be a guess, so none is added.",
        "none_of_my_effects": f"No effect of the library{pairs} is consistent with the readings.",
        "numerics": "The simulation moves with its own interval and tolerance by more than a fifth of the data's sigma.",
        "data_fault": "The readings contradict themselves. No effect is looked for before they are in order.",
    }[outcome.verdict]


def next_step(outcome: Outcome) -> str:
    """What to do now, a sentence before the command (or alone)."""
    another = "or" if outcome.holdout else "give another landing as --holdout, or"
    law = "that term" if outcome.term else "the law that you suspect"
    own = f"Write {law} as an effect into a folder of your own, and search again:"
    return {
        "effect": "Run the revised scenario:",
        "effects": "Run the revised scenario:",
        "nothing_missing": "Nothing to change. To see what a landing like this could show at all:",
        "cannot_tell": f"Measure what would decide, {another} ask which sensor would help:",
        "none_of_my_effects": "Run the scenario with that term (in found/ it is an effect):" if outcome.revised_scenario else own,
        "numerics": "Make the interval and the tolerance of the scenario smaller, then diagnose again:",
        "data_fault": "Mark or repair the faulty samples, then diagnose again:",
    }[outcome.verdict]


def command(outcome: Outcome) -> str:
    """What to type."""
    scenario = _quoted(outcome.scenario or "SCENARIO")
    data = "".join(f" --measured {_quoted(folder)}" for folder in outcome.measured) or " --measured DIR"
    if outcome.revised_scenario and outcome.verdict != "numerics":
        return f"orchestrator run {_quoted(outcome.revised_scenario)}"
    if outcome.verdict in ("nothing_missing", "cannot_tell"):
        return f"orchestrator distinguish {scenario}{data}"
    held = "".join(f" --holdout {_quoted(folder)}" for folder in outcome.holdout)
    own = " --effects FOLDER" if outcome.verdict == "none_of_my_effects" else ""
    return f"orchestrator diagnose {scenario}{data}{held}{own}"


def by_whom(outcome: Outcome) -> str:
    """Behind a closed gap: whose it is, where that is not added to the scenario."""
    added = outcome.effects or (outcome.verdict == "none_of_my_effects" and outcome.term)
    return "" if added else " by the best candidate, which is not added"


def title_of(outcome: Outcome, name: str) -> str:
    """What an effect is called in words; its name where nobody says."""
    found = [effect.title for effect in outcome.effects if effect.name == name]
    found += [c.title for c in outcome.candidates if c.name == name and c.title]
    found += [outcome.titles[name]] if name in outcome.titles else []
    return next(iter(found), name.replace("_", " ")) or name


def inside(title: str) -> str:
    """A title in the middle of a sentence: Soil damping -> soil damping, RCS pulse stays."""
    return title[:1].lower() + title[1:] if title[1:2].islower() or title[1:2] == " " else title


def listed(items: list[str], last: str = "and") -> str:
    """a, b and c."""
    return items[0] if len(items) == 1 else f"{', '.join(items[:-1])} {last} {items[-1]}" if items else ""


def _missing(outcome: Outcome) -> str:
    names = listed([inside(effect.title or effect.name) for effect in outcome.effects]) or "an effect without a name"
    sure = min((e.probability for e in outcome.effects if isfinite(e.probability)), default=float("nan"))
    first = f"Missing: {names}, {chance(sure).replace('>', 'more than')}." if isfinite(sure) else f"Missing: {names}."
    closure, gap = outcome.gap.closure, outcome.gap
    if not isfinite(closure) or closure < LEAST_GAIN:
        return first
    held = isfinite(gap.holdout_after) or bool(outcome.holdout)
    where = "a landing it was not fitted to" if held else "the landing it was fitted to"
    return f"{first} Closes {percent(closure)} of the gap on {where}."


def _cannot_tell(outcome: Outcome) -> str:
    common, names = [inside(title_of(outcome, name)) for name in in_every_pair(outcome)], undecided(outcome)
    sure = f"Missing: {listed(common)}, and one effect more. " if common else ""
    told = "its candidates apart" if not names else f"whether it is {names[0]}"
    if len(names) > 1:
        told = f"{names[0]} from {listed(names[1:], 'or')}"
    return f"{sure}These data cannot tell {told}{_to_measure(outcome)}."


def _to_measure(outcome: Outcome) -> str:
    if not outcome.cannot_tell.measure:
        return ""
    first = outcome.cannot_tell.measure[0]
    size = in_unit_of(first.channel, first.sigma)
    return f": measure {first.channel}{f' to within {size}' if size else ''}"


def in_every_pair(outcome: Outcome) -> list[str]:
    """Effects in every answer that is left; none where an answer is no pair."""
    answers = [parts_of(answer) for answer in outcome.cannot_tell.answers]
    if any(len(parts) != 2 for parts in answers):
        return []
    return [name for name in outcome.cannot_tell.names if answers and all(name in parts for parts in answers)]


def undecided(outcome: Outcome) -> list[str]:
    """What the data cannot tell apart, in the middle of a sentence: the answers, less what is in all of them."""
    common = in_every_pair(outcome)
    answers = [parts_of(answer) for answer in outcome.cannot_tell.answers] or [(name,) for name in outcome.cannot_tell.names]
    return [" with ".join(inside(title_of(outcome, name)) for name in parts if name not in common) for parts in answers]


def in_unit_of(channel: str, sigma: float) -> str:
    """A sigma in SI with its unit, in the unit that is shown of the channel's kind; empty where it is not known."""
    if not isfinite(sigma):
        return ""
    unit, factor = shown_unit(unit_of(channel))
    return f"{number(factor * sigma, 2)} {spelt(unit)}".rstrip()


def unit_of(channel: str) -> str:
    """SI unit of a channel by what the data format calls it; "1" where the name does not say."""
    kind = channel.removeprefix("peak.").partition(".")[0]
    kinds = {"rates": "rad/s", "attitude": "rad", "stroke": "m", "penetration": "m", "skid": "m", "contact_time": "s"}
    return kinds.get(kind, "1")


def _outside(outcome: Outcome) -> str:
    what = outcome.term.get("sentence") or outcome.term.get("name") or outcome.term.get("port")
    return f"Something is missing that is not in the library{f': {what}' if what else ''}."


def _fault(outcome: Outcome) -> str:
    if not outcome.faults:
        return "The data are at fault."
    more = f" ({len(outcome.faults) - 1} more)" if len(outcome.faults) > 1 else ""
    first = outcome.faults[0]
    return f"The data are at fault: {first.get('channel', '')} {first.get('what', '')}".rstrip() + f"{more}."


def _found(effect: NamedEffect) -> str:
    numbers = [f"{name.replace('_', ' ')} {with_sigma(e.value, e.sigma)} {spelt(e.unit)}".rstrip() for name, e in effect.parameters.items()]
    title = inside(effect.title or effect.name)
    return f"{title} ({listed(numbers)})" if numbers else title


def _quoted(path: str) -> str:
    return f"'{path}'" if " " in path else path
