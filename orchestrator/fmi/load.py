"""The FMU of an interface, instantiated: in this process, or in one of its own."""

from __future__ import annotations

from typing import Literal, overload

from orchestrator.errors import UnitError
from orchestrator.fmi.isolated import IsolatedUnit
from orchestrator.fmi.slave2 import Fmi2Unit
from orchestrator.fmi.slave3 import Fmi3Unit
from orchestrator.fmi.unit import FmuUnit
from orchestrator.interruption import unbroken
from orchestrator.master.slave import Interface


@overload
def load(name: str, interface: Interface, isolate: Literal[False] = ...) -> FmuUnit: ...
@overload
def load(name: str, interface: Interface, isolate: bool) -> FmuUnit | IsolatedUnit: ...


def load(name: str, interface: Interface, isolate: bool = False) -> FmuUnit | IsolatedUnit:
    """By its version of FMI."""
    if interface.path is None:
        raise UnitError(f"{interface.model_name}: is not an FMU; give a unit that runs it")
    if isolate:
        return IsolatedUnit(name, interface)
    kind = Fmi3Unit if interface.fmi_version.startswith("3.") else Fmi2Unit
    with unbroken():
        return kind(name, interface.path, interface)
