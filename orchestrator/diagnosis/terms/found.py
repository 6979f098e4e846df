"""A term that was found: what it is in words, how sure it is, and its forms for the library and for diagnosis.json."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.effects.effect import ConnectionTable, Insert
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.found_term import FoundTerm, body_term_insert
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.outcome import Estimate
from orchestrator.diagnosis.terms.term import Energy, Term

OF_A_CLASS = 5.0  # of ln evidence: closer than that, the data cannot tell two forms apart


@dataclass(frozen=True)
class Rival:
    """Another form that the data cannot tell from the one found."""

    term: Term
    behind: float
    """ln evidence that it lacks; negative where it has more."""
    size: float
    """Its coefficient."""

    @property
    def words(self) -> str:
        return self.term.words(self.size)


@dataclass(frozen=True)
class Found:
    """The best of the generic terms with its own fit."""

    term: Term
    coefficient: Estimate
    log_evidence: float
    """Relative to nothing missing."""
    adequacy: float
    """p-value of what is left."""
    adequate: bool
    rivals: tuple[Rival, ...]
    """The rest of its class: forms within OF_A_CLASS of it."""
    stability: Mapping[str, float]
    """port, form: shares of bootstrap draws in which it came first again."""
    ports: Mapping[str, float]
    """ln evidence of each port, relative to the best."""
    hypothesis: Hypothesis
    fit: Fit
    regressed: Mapping[str, float] = field(default_factory=dict)
    """ln evidence of all terms, relative to nothing missing."""
    known_as: tuple[str, ...] = ()
    """Effects of the library in the class, or better than it: refused there, they are not offered as something new."""
    second: Found | None = None
    """Beside it, where one alone is not enough; the fit is then that of both."""

    @property
    def name(self) -> str:
        return self.hypothesis.name

    @property
    def both(self) -> tuple[Found, ...]:
        """It, and what stands beside it."""
        return (self,) if self.second is None else (self, self.second)

    @property
    def energy(self) -> Energy:
        return self.term.energy(self.coefficient.value)

    @property
    def words(self) -> str:
        return self.term.words(self.coefficient.value)

    @property
    def sentence(self) -> str:
        """For a reader."""
        c = self.coefficient
        count = len(self.rivals)
        others = "another form" if count == 1 else f"one of {count} other forms"
        also = f", or {others} that these data cannot tell from it" if count else ""
        beside = f"; beside it {self.second.words}" if self.second else ""
        return f"{self.words} ({self.term.formula}, c = {c.value:.3g} ± {c.sigma:.2g} {c.unit}){also}{beside}"


def as_term(found: Found, addresses: Addresses) -> FoundTerm:
    """As an entry of the library, with the unit that must be added for it."""
    term = found.term
    title, physics = term.dependence[:1].upper() + term.dependence[1:], f"{found.words[:1].upper()}{found.words[1:]}."
    estimate = Estimate(found.coefficient.value, found.coefficient.sigma, addresses.unit_of_measure(term.coefficient))
    words = (term.name, title, physics, term.formula)
    return FoundTerm(*words, term.port, found.energy, term.coefficient, estimate, dict(term.fixed), _insert(term, addresses))


def _insert(term: Term, addresses: Addresses) -> Insert | None:
    """The unit that the scenario lacks for it."""
    if term.port == "body":
        return body_term_insert(addresses)
    if term.port != "sensor" or addresses.units("sensor"):
        return None
    return Insert(unit="sensor", fmu="RateSensor", connections=[ConnectionTable(ports=["body.rates", "sensor.rates"])])


def to_outcome(found: Found, closure: float | None = None) -> dict[str, Any]:
    """`Outcome.term`."""
    term = found.term
    tree: dict[str, Any] = {
        "sentence": found.sentence,
        "name": term.name,
        "port": term.port,
        "unit": term.unit,
        "formula": term.formula,
        "words": found.words,
        "coefficient": {"value": found.coefficient.value, "sigma": found.coefficient.sigma, "unit": found.coefficient.unit},
        "energy": found.energy,
        "class": [f"{found.term.name}: {found.words}", *(f"{rival.term.name}: {rival.words}" for rival in found.rivals)],
        "stability": dict(found.stability),
        "adequate": found.adequate,
        "adequacy": found.adequacy,
        "log_evidence": found.log_evidence,
        "ports": dict(found.ports),
        "fixed": dict(term.fixed),
        "rivals": [{"name": it.term.name, "port": it.term.port, "fixed": dict(it.term.fixed), "behind": it.behind} for it in found.rivals],
    }
    if found.known_as:
        tree["known_as"] = list(found.known_as)
    if found.second is not None:
        tree["second"] = to_outcome(found.second)
    return tree if closure is None else tree | {"closure": closure}
