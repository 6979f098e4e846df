"""The dictionary of generic terms, port by port."""

from __future__ import annotations

from collections.abc import Sequence

from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.terms.body import body_terms, sensor_terms
from orchestrator.diagnosis.terms.soil import normal_terms, tangential_terms
from orchestrator.diagnosis.terms.strut import strut_terms
from orchestrator.diagnosis.terms.term import Term


def dictionary() -> tuple[Term, ...]:
    """Every term, each once."""
    return (*normal_terms(), *tangential_terms(), *strut_terms(), *body_terms(), *sensor_terms())


def in_scenario(terms: Sequence[Term], addresses: Addresses) -> dict[str, tuple[Term, Hypothesis]]:
    """By name, those that the scenario's twin can hold."""
    found = {term.name: (term, term.hypothesis(addresses)) for term in terms}
    return {name: (term, hypothesis) for name, (term, hypothesis) in found.items() if hypothesis is not None}
