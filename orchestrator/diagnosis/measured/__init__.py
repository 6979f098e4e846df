"""Measured landings: read from a folder, checked, and searched for faults of the data themselves."""

from orchestrator.diagnosis.measured.faults import Fault, faults
from orchestrator.diagnosis.measured.landing import Measured, Prior, Scalar, Series
from orchestrator.diagnosis.measured.read import FILE, read_measured
from orchestrator.diagnosis.measured.write import write_measured

__all__ = ["FILE", "Fault", "Measured", "Prior", "Scalar", "Series", "faults", "read_measured", "write_measured"]
