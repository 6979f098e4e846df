"""Terms without a name: a dictionary of generic laws by port, regressed through the simulator where no effect of the library will do."""

from orchestrator.diagnosis.terms.dictionary import dictionary
from orchestrator.diagnosis.terms.find_term import find_term
from orchestrator.diagnosis.terms.found import Found, as_term, to_outcome
from orchestrator.diagnosis.terms.linear import port_evidence

__all__ = ["Found", "as_term", "dictionary", "find_term", "port_evidence", "to_outcome"]
