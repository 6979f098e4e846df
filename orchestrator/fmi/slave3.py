"""FMI 3.0 co-simulation: what its calls have of their own.

Events are left to the unit (eventModeUsed = false), and intermediate updates are not asked for. A unit that can roll back may return
early: the master then takes the time it reached for everybody, as after a Discard. One that cannot is not allowed to.
"""

from __future__ import annotations

import ctypes
import math
from typing import Any, ClassVar

from fmpy.fmi3 import FMU3Slave

from orchestrator.errors import StepError
from orchestrator.fmi.unit import DISCARD, GOOD, FmuUnit

_BYTES = ctypes.POINTER(ctypes.c_uint8)
_TOLERANCE = 1e-9
"""s: an early return nearer to the end than this is none."""


class Fmi3Unit(FmuUnit):
    """One instance of an FMU of FMI 3.0."""

    prefix: ClassVar[str] = "fmi3"
    state: ClassVar[str] = "FMUState"
    deserialize: ClassVar[str] = "Deserialize"
    counted: ClassVar[bool] = True

    def _instantiated(self, names: dict[str, str]) -> Any:
        def keep(_environment: Any, status: int, _category: bytes, message: bytes) -> None:
            self._log.take(status, message)

        fmu: Any = FMU3Slave(**names)
        early = self.interface.claims("canGetAndSetFMUstate")
        fmu.instantiate(loggingOn=True, eventModeUsed=False, earlyReturnAllowed=early, logMessage=keep)
        flags = (ctypes.c_bool * 3)()
        self._event, self._end, self._early = (ctypes.c_bool.from_buffer(flags, at) for at in range(3))
        self._last = ctypes.c_double(math.nan)
        self._told = tuple(ctypes.byref(value) for value in (self._event, self._end, self._early, self._last))
        return fmu

    @staticmethod
    def _bytes(buffer: Any) -> Any:
        return ctypes.cast(buffer, _BYTES)

    def _enter_initialization(self, start: float, stop: float) -> None:
        status = self._dll.fmi3EnterInitializationMode(self._component, False, 0.0, start, True, stop)
        self._check("enterInitializationMode", status)

    def _advance(self, time: float, interval: float) -> int:
        self._early.value = self._end.value = False
        self._last.value = math.nan
        # The `False` is no promise that the master will not go back before this point: it may.
        status: int = self._dll.fmi3DoStep(self._component, time, interval, False, *self._told)
        if status > GOOD and status != DISCARD:
            self._check("doStep", status)
        if self._end.value:
            said = self._log.last() or "it gave no message"
            raise StepError(f"{self.name}: asks to end the run in the step from t = {time:.9g} s: {said}")
        if status == DISCARD or (self._early.value and self._last.value < time + interval - _TOLERANCE):
            self.reached = self._last.value if math.isfinite(self._last.value) else None
            return DISCARD
        return status
