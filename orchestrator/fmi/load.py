"""The FMU of an interface, instantiated."""

from __future__ import annotations

from orchestrator.errors import UnitError
from orchestrator.fmi.slave2 import Fmi2Unit
from orchestrator.fmi.slave3 import Fmi3Unit
from orchestrator.fmi.unit import FmuUnit
from orchestrator.master.slave import Interface


def load(name: str, interface: Interface) -> FmuUnit:
    """By its version of FMI."""
    if interface.path is None:
        raise UnitError(f"{interface.model_name}: is not an FMU; give a unit that runs it")
    kind = Fmi3Unit if interface.fmi_version.startswith("3.") else Fmi2Unit
    return kind(name, interface.path, interface)
