"""A law outside the library beside what would be named: who gets the verdict. The regression and the landings are made up."""

from importlib import import_module
from types import SimpleNamespace
from typing import Any

import pytest

from orchestrator.diagnosis import diagnose, stages
from orchestrator.diagnosis.diagnose import Diagnosis, Request
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis, parts_of
from orchestrator.diagnosis.outcome import Estimate, Outcome

TERM = Hypothesis("torque", ())
find_term = import_module("orchestrator.diagnosis.terms.find_term")  # the package gives the function that name


def state_of(evidence: dict[str, float]) -> Any:
    """Fits that hold their evidence alone; restarted from the term's nuisances they stay where they are."""
    fits = {name: SimpleNamespace(log_evidence=value, chi2=100.0) for name, value in evidence.items()}
    search = SimpleNamespace(back_substituted=lambda fits, hypotheses, names, winner: fits)
    return SimpleNamespace(fits=fits, hypotheses=[Hypothesis(name, ()) for name in evidence if name != NULL.name], search=search)


@pytest.mark.parametrize(
    ("named", "term", "adequate", "gains", "verdict"),
    [
        ("damping", 18.0, True, {"damping": 5.0}, "effect"),  # 5.7 behind: not asked
        ("damping", 21.0, True, {"damping": 5.0, "torque": 5.0}, "effect"),  # a sixteenth
        ("damping", 21.0, True, {"damping": 5.0, "torque": 10.5}, "none_of_my_effects"),
        ("damping", 22.0, True, {"damping": 5.0, "torque": 5.0}, "cannot_tell"),  # 15 %: a single effect has the better prior
        ("damping", 22.0, True, {"damping": 5.0, "torque": 9.5}, "none_of_my_effects"),  # the held-out landing decides
        ("damping", 22.0, True, {"damping": 9.0, "torque": 5.0}, "effect"),
        ("damping", 26.5, True, {"damping": 5.0, "torque": 5.0}, "none_of_my_effects"),
        ("damping", 29.0, True, {"torque": 5.0}, "none_of_my_effects"),
        ("damping", 26.5, False, {"damping": 5.0}, "effect"),  # leaves more than noise
        ("damping", 26.5, True, {"damping": 5.0, "torque": -1.0}, "effect"),  # worse on the held-out landing
        ("damping + slope", 20.5, True, {"damping + slope": 5.0, "torque": 5.0}, "none_of_my_effects"),  # a pair: poorer prior
        ("damping + slope", 17.0, True, {"damping + slope": 5.0, "torque": 5.0}, "cannot_tell"),
        ("damping", None, True, {"damping": 5.0}, "effect"),
    ],
)
def test_a_law_outside_is_one_answer_more(
    monkeypatch: Any, named: str, term: float | None, adequate: bool, gains: dict[str, float], verdict: str
) -> None:
    state = state_of({NULL.name: 0.0, named: 20.0})
    fit = SimpleNamespace(log_evidence=term, chi2=100.0)
    found: Any = SimpleNamespace(name=TERM.name, fit=fit, hypothesis=TERM, adequate=adequate, log_evidence=term, second=None)
    found.regressed, found.words, found.adequacy = dict.fromkeys(range(100)), "a torque", 0.5
    monkeypatch.setattr(diagnose, "find_term", lambda *_: found if term is not None else None)
    monkeypatch.setattr(stages, "adequacy", lambda *_: SimpleNamespace(p=0.5))
    monkeypatch.setattr(stages, "_singles", lambda *_: 47)
    monkeypatch.setattr(diagnose, "to_outcome", lambda found, closure=None: {"words": found.name, "closure": closure})
    held_fits = {NULL.name: SimpleNamespace(chi2=300.0), TERM.name: SimpleNamespace(chi2=110.0)}
    asked: set[str] = set()

    def ask(state: Any, held: Any, crew: Any, seed: int, names: list[str], told: Any) -> Any:
        asked.update(names)
        return held_fits, {name: (gains[name], 0.5) for name in names}

    monkeypatch.setattr(diagnose, "ask_holdouts", ask)
    setup: Any = SimpleNamespace(landings=None)
    held: Any = SimpleNamespace(landings=SimpleNamespace(size=100))
    state.setup = setup
    diagnosis = Diagnosis(Outcome("nothing_missing"), setup, held, state)
    crew: Any = SimpleNamespace(flown=100)
    request = Request(scenario=diagnose.Path(), measured=())

    law = diagnose._law_outside(request, diagnosis, crew, [named], None)
    _, judgement = diagnose._judged(request, diagnosis, crew, law, None)
    alone, beside = verdict == "none_of_my_effects", verdict == "cannot_tell"
    assert judgement.verdict == ("effects" if verdict == "effect" and len(parts_of(named)) > 1 else verdict)
    assert judgement.answers == ((named, TERM.name) if beside else (TERM.name,) if alone else ())
    assert asked == set(gains)
    assert (diagnosis.found is found) == alone
    assert (TERM.name in state.fits) == (TERM in state.hypotheses) == (alone or beside)
    closure = pytest.approx(0.95) if alone else None
    more = {"instead_of": named} if alone else {}
    assert diagnosis.outcome.term == ({"words": TERM.name, "closure": closure} | more if alone or beside else {})
    assert (TERM.name in diagnosis.outcome.titles) == (alone or beside)


@pytest.mark.parametrize(
    ("evidence", "promised", "fitted", "asked"),
    [
        (30.0, 16.0, 16.0, True),
        (30.0, 14.0, 16.0, False),  # 15 behind: not fitted
        (30.0, 16.0, 14.0, False),
        (9.0, 3.0, 3.0, True),
        (9.0, 0.9, 3.0, False),  # no better than nothing missing
        (9.0, 3.0, 0.9, False),
        (200.0, 155.0, 155.0, True),  # a quarter behind
        (200.0, 145.0, 155.0, False),
    ],
)
def test_terms_are_regressed_beside_a_name_only_where_one_could_take_over(
    monkeypatch: Any, evidence: float, promised: float, fitted: float, asked: bool
) -> None:
    state = state_of({NULL.name: 0.0, "damping": evidence})
    term = SimpleNamespace(equals="")
    monkeypatch.setattr(find_term, "dictionary", dict)
    monkeypatch.setattr(find_term, "in_scenario", lambda *_: {TERM.name: (term, TERM)})
    monkeypatch.setattr(find_term, "offers", lambda search, fit, rivals: {h.name: (promised, None) for h in rivals})
    ends = SimpleNamespace(log_evidence=fitted)
    monkeypatch.setattr(find_term, "begun_there", lambda search, fit, rivals, _: {h.name: ends for h in rivals})
    regressed: list[Any] = []
    monkeypatch.setattr(find_term, "regressed", lambda regression, *_: regressed.append(dict(regression.fits)))
    setup: Any = SimpleNamespace(why_slow="", addresses=None)
    state.base, state.search.told = None, None
    crew: Any = None
    assert find_term.find_term(state, setup, crew, beat=evidence) is None
    assert regressed == ([{TERM.name: ends}] if asked else [])


def test_parameters_of_a_pair_that_are_called_alike_keep_both_their_numbers() -> None:
    one, two, three = (Estimate(value, 0.1, "1") for value in (1.0, 2.0, 3.0))
    both = [("friction_-Z", "friction", one), ("friction_+Y", "friction", two), ("friction_+Y", "rate", three)]
    assert diagnose._by_name(both) == {"friction_-Z.friction": one, "friction_+Y.friction": two, "rate": three}
