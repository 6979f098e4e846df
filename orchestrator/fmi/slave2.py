"""FMI 2.0 co-simulation: what its calls have of their own."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import Any, ClassVar

from fmpy.fmi2 import FMU2Slave

from orchestrator.fmi.arrays import Call, pointer, references
from orchestrator.fmi.messages import fmi2_callbacks
from orchestrator.fmi.unit import DISCARD, GOOD, FmuUnit
from orchestrator.master.slave import Variable, Vector

_LAST_SUCCESSFUL_TIME = 2


class Fmi2Unit(FmuUnit):
    """One instance of an FMU of FMI 2.0."""

    prefix: ClassVar[str] = "fmi2"
    state: ClassVar[str] = "FMUstate"
    deserialize: ClassVar[str] = "DeSerialize"
    counted: ClassVar[bool] = False

    def _instantiated(self, names: dict[str, str]) -> Any:
        self._callbacks = fmi2_callbacks(self._log)
        fmu: Any = FMU2Slave(**names)
        fmu.instantiate(callbacks=self._callbacks, loggingOn=True)
        return fmu

    @staticmethod
    def _bytes(buffer: Any) -> Any:
        return buffer

    def _rate_calls(self, rates: Sequence[Variable], vector: Vector, offset: int) -> list[Call]:
        if not rates:
            return []
        orders = (ctypes.c_int * len(rates))(*[1] * len(rates))
        derivatives = (self._component, references(rates), len(rates), orders, pointer(vector, offset))
        return [Call("setRealInputDerivatives", self._dll.fmi2SetRealInputDerivatives, derivatives)]

    def _enter_initialization(self, start: float, stop: float) -> None:
        self._check("setupExperiment", self._dll.fmi2SetupExperiment(self._component, 0, 0.0, start, 1, stop))
        self._check("enterInitializationMode", self._dll.fmi2EnterInitializationMode(self._component))

    def _advance(self, time: float, interval: float) -> int:
        # The last argument promises that the master will not go back before this point: it may.
        status: int = self._dll.fmi2DoStep(self._component, time, interval, 0)
        if status == DISCARD:
            self.reached = self._last_successful_time()
        elif status > GOOD:
            self._check("doStep", status)
        return status

    def _last_successful_time(self) -> float | None:
        """After a Discard: how far the unit came, where it can tell."""
        time = ctypes.c_double(math.nan)
        status = self._dll.fmi2GetRealStatus(self._component, _LAST_SUCCESSFUL_TIME, ctypes.byref(time))
        return time.value if status <= GOOD and math.isfinite(time.value) else None
