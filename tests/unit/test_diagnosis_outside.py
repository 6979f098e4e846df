"""A law outside the library beside what would be named: who gets the verdict. The regression and the landings are made up."""

from importlib import import_module
from types import SimpleNamespace
from typing import Any

import pytest

from orchestrator.diagnosis import diagnose
from orchestrator.diagnosis.diagnose import Diagnosis, Request
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis, parts_of
from orchestrator.diagnosis.outcome import Outcome
from orchestrator.diagnosis.verdict import Judged, probabilities

TERM = Hypothesis("torque", ())
find_term = import_module("orchestrator.diagnosis.terms.find_term")  # the package gives the function that name


def state_of(evidence: dict[str, float]) -> Any:
    """Fits that hold their evidence alone; restarted from the term's nuisances they stay where they are."""
    fits = {name: SimpleNamespace(log_evidence=value, chi2=100.0) for name, value in evidence.items()}
    search = SimpleNamespace(back_substituted=lambda fits, hypotheses, names, winner: fits)
    return SimpleNamespace(fits=fits, hypotheses=[Hypothesis(name, ()) for name in evidence if name != NULL.name], search=search)


def judged(state: Any, holdouts: Any) -> tuple[list[Judged], Any]:
    found = [Judged(name, fit.log_evidence, 0.5) for name, fit in state.fits.items()]
    return found, SimpleNamespace(probabilities=probabilities(found, 47))


@pytest.mark.parametrize(
    ("named", "term", "adequate", "gain", "overtaken", "share"),
    [
        ("damping", 21.0, True, 5.0, False, ""),  # a sixteenth
        ("damping", 22.0, True, 5.0, False, "15 %"),  # 2 ahead: a single effect has the better prior
        ("damping", 24.0, True, 5.0, True, ""),
        ("damping", 24.0, False, 5.0, False, ""),  # leaves more than noise
        ("damping", 24.0, True, -1.0, False, ""),  # worse on the held-out landing
        ("damping + slope", 18.0, True, 5.0, True, ""),  # 2 behind a pair
        ("damping + slope", 17.0, True, 5.0, False, "35 %"),
        ("damping", None, True, 5.0, False, ""),
    ],
)
def test_the_more_probable_of_both_is_said(
    monkeypatch: Any, named: str, term: float | None, adequate: bool, gain: float, overtaken: bool, share: str
) -> None:
    state = state_of({NULL.name: 0.0, named: 20.0})
    fit = SimpleNamespace(log_evidence=term, chi2=100.0)
    tried = dict.fromkeys(range(100))
    found = SimpleNamespace(name=TERM.name, fit=fit, hypothesis=TERM, adequate=adequate, log_evidence=term, regressed=tried)
    found.second, found.words = None, "a torque"
    monkeypatch.setattr(diagnose, "find_term", lambda *_: found if term is not None else None)
    monkeypatch.setattr(diagnose, "judged", judged)
    monkeypatch.setattr(diagnose, "to_outcome", lambda found, closure: {"words": found.name, "closure": closure})
    held_fits = {NULL.name: SimpleNamespace(chi2=300.0), TERM.name: SimpleNamespace(chi2=110.0)}
    monkeypatch.setattr(diagnose, "ask_holdouts", lambda *_: (held_fits, {TERM.name: (gain, 0.5)}))
    setup: Any = SimpleNamespace(hypotheses=[None] * 47)
    held: Any = SimpleNamespace(landings=SimpleNamespace(size=100))
    diagnosis = Diagnosis(Outcome("nothing_missing"), setup, held, state)
    crew: Any = None
    request = Request(scenario=diagnose.Path(), measured=())

    assert diagnose._overtaken_from_outside(request, diagnosis, crew, [named], None) == overtaken
    assert (diagnosis.found is found) == overtaken
    assert (TERM.name in state.fits) == overtaken
    assert sorted(len(parts_of(h.name)) for h in state.hypotheses) == sorted([len(parts_of(named)), *([1] if overtaken else [])])
    assert [share in warning for warning in diagnosis.outcome.warnings] == ([True] if share else [])
    if overtaken:
        assert diagnosis.outcome.term == {"words": TERM.name, "closure": pytest.approx(0.95)}


@pytest.mark.parametrize(
    ("evidence", "promised", "fitted", "asked"),
    [
        (30.0, 16.0, 16.0, True),
        (30.0, 14.0, 16.0, False),  # 15 behind: not fitted
        (30.0, 16.0, 14.0, False),
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
    monkeypatch.setattr(find_term, "regressed", lambda regression, *_: regressed.append(regression))
    setup: Any = SimpleNamespace(why_slow="", addresses=None)
    state.base, state.search.told = None, None
    crew: Any = None
    assert find_term.find_term(state, setup, crew, beat=evidence) is None
    assert bool(regressed) == asked
