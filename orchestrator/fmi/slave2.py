"""An FMI 2.0 co-simulation unit behind the master's protocol: preallocated arrays, one set and one get per type and step.

fmpy loads the library and declares the C functions; the calls below go to those functions directly, because a wrapper that logs
and checks every call costs more than the call.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

from fmpy.fmi2 import FMU2Slave

from orchestrator.errors import StepError, UnitError
from orchestrator.fmi.arrays import Call, DiscreteBlock, pointer, real_call, references, single_value
from orchestrator.fmi.description import model_identifier, read_interface
from orchestrator.fmi.messages import MessageLog
from orchestrator.fmi.unpack import unpack
from orchestrator.master.slave import Binding, Interface, Kind, Status, Value

_LAST_SUCCESSFUL_TIME = 2
_GOOD, _DISCARD = int(Status.WARNING), int(Status.DISCARD)


class Fmi2Unit:
    """One instance of an FMU. After the status Error or Fatal it is never touched again."""

    def __init__(self, name: str, path: Path, interface: Interface | None = None) -> None:
        self.name = name
        self.interface = interface or read_interface(path)
        self.steps = 0
        self.seconds = 0.0
        self.reached: float | None = None
        self._log = MessageLog(name)
        self._dead = self._used = False
        self._slot = ctypes.c_void_p(None)
        try:
            self._fmu: Any = FMU2Slave(
                instanceName=name,
                guid=self.interface.guid,
                modelIdentifier=model_identifier(path),
                unzipDirectory=str(unpack(path, self.interface.sha256)),
            )
            self._fmu.instantiate(callbacks=self._log.callbacks, loggingOn=True)
        except UnitError:
            raise
        except Exception as error:
            raise UnitError(f"{name} ({path.name}): cannot be instantiated ({self._log.last() or error}); check its dependencies") from None
        self._dll: Any = self._fmu.dll
        self._component = ctypes.c_void_p(self._fmu.component)

    @property
    def messages(self) -> list[str]:
        return self._log.messages

    @property
    def complaint(self) -> str:
        """What the unit logged as an error since its last start; an initialisation may fail in no other way (decision 2)."""
        return self._log.complaint

    def bind(self, binding: Binding) -> None:
        dll, component = self._dll, self._component
        inputs, rates, outputs = (
            [self.interface.variables[name] for name in names] for names in (binding.inputs, binding.rates, binding.outputs)
        )
        real_in = [v for v in inputs if v.kind is Kind.REAL]
        real_out = [v for v in outputs if v.kind is Kind.REAL]
        coupled, recorded = real_out[: binding.coupled], real_out[binding.coupled :]
        self._binding = binding                      # keeps the memory alive
        self._send_real = real_call("setReal", dll.fmi2SetReal, component, real_in, binding.u, 0)
        self._get_coupled = real_call("getReal", dll.fmi2GetReal, component, coupled, binding.y, 0)
        self._get_recorded = real_call("getReal", dll.fmi2GetReal, component, recorded, binding.y, binding.coupled)
        if rates:
            orders = (ctypes.c_int * len(rates))(*[1] * len(rates))
            derivatives = (component, references(rates), len(rates), orders, pointer(binding.u, len(inputs)))
            self._send_real.append(Call("setRealInputDerivatives", dll.fmi2SetRealInputDerivatives, derivatives))
        kinds_in = ((Kind.INTEGER, dll.fmi2SetInteger), (Kind.BOOLEAN, dll.fmi2SetBoolean))
        kinds_out = ((Kind.INTEGER, dll.fmi2GetInteger), (Kind.BOOLEAN, dll.fmi2GetBoolean))
        self._in_blocks = _filled(DiscreteBlock(kind, call, component, inputs, binding.u) for kind, call in kinds_in)
        self._out_blocks = _filled(DiscreteBlock(kind, call, component, outputs, binding.y) for kind, call in kinds_out)

    def set_up(self, start: float, stop: float, values: Mapping[str, Value]) -> None:
        self._free_slot()
        if self._used:
            self._check("reset", self._dll.fmi2Reset(self._component))
        self._used = True
        self._log.forget()
        self._make([single_value(self._dll, self._component, self.interface.variables[name], value) for name, value in values.items()])
        self._check("setupExperiment", self._dll.fmi2SetupExperiment(self._component, 0, 0.0, start, 1, stop))
        self._check("enterInitializationMode", self._dll.fmi2EnterInitializationMode(self._component))

    def exchange(self) -> None:
        self._send()
        self._fetch()
        self._make(self._get_recorded)

    def begin(self) -> None:
        self._send()
        self._check("exitInitializationMode", self._dll.fmi2ExitInitializationMode(self._component))
        self._fetch()
        self._make(self._get_recorded)

    def step(self, time: float, interval: float) -> Status:
        entered = perf_counter()
        self.steps += 1
        self._send()
        # The last argument promises that the master will not go back before this point: it may.
        status = self._dll.fmi2DoStep(self._component, time, interval, 0)
        if status > _GOOD and status != _DISCARD:
            self._check("doStep", status)
        if status == _DISCARD:
            self.reached = self._last_successful_time()
        else:
            self._fetch()
        self.seconds += perf_counter() - entered
        return Status.DISCARD if status == _DISCARD else Status.OK

    def _last_successful_time(self) -> float | None:
        """After a Discard: how far the unit came, where it can tell."""
        time = ctypes.c_double(math.nan)
        status = self._dll.fmi2GetRealStatus(self._component, _LAST_SUCCESSFUL_TIME, ctypes.byref(time))
        return time.value if status <= _GOOD and math.isfinite(time.value) else None

    def observe(self) -> None:
        entered = perf_counter()
        self._make(self._get_recorded)
        self.seconds += perf_counter() - entered

    def save(self) -> None:
        entered = perf_counter()
        # Freed first: passing the old slot for reuse is allowed, but runtimes exist that leak it.
        self._free_slot()
        self._check("getFMUstate", self._dll.fmi2GetFMUstate(self._component, ctypes.byref(self._slot)))
        self.seconds += perf_counter() - entered

    def restore(self) -> None:
        entered = perf_counter()
        self._check("setFMUstate", self._dll.fmi2SetFMUstate(self._component, self._slot))
        self.seconds += perf_counter() - entered

    def serialised_state(self) -> bytes:
        """The kept state as bytes, where the unit can serialise."""
        size = ctypes.c_size_t(0)
        self._check("serializedFMUstateSize", self._dll.fmi2SerializedFMUstateSize(self._component, self._slot, ctypes.byref(size)))
        buffer = ctypes.create_string_buffer(size.value)
        self._check("serializeFMUstate", self._dll.fmi2SerializeFMUstate(self._component, self._slot, buffer, size.value))
        return buffer.raw

    def adopt_state(self, data: bytes) -> None:
        """Put serialised bytes into the slot; `restore` then goes there."""
        self._free_slot()
        status = self._dll.fmi2DeSerializeFMUstate(self._component, data, len(data), ctypes.byref(self._slot))
        self._check("deSerializeFMUstate", status)

    def close(self) -> None:
        """Free the instance. Left open, a Python runtime inside a unit may crash when the interpreter ends."""
        if not self._dead:
            self._free_slot()
            self._dll.fmi2Terminate(self._component)
            self._dll.fmi2FreeInstance(self._component)
            self._dead = True

    def _free_slot(self) -> None:
        if self._slot:
            self._check("freeFMUstate", self._dll.fmi2FreeFMUstate(self._component, ctypes.byref(self._slot)))
            self._slot = ctypes.c_void_p(None)

    def _send(self) -> None:
        self._make(self._send_real)
        for block in self._in_blocks:
            block.load()
            self._make((block.call,))

    def _fetch(self) -> None:
        self._make(self._get_coupled)
        for block in self._out_blocks:
            self._make((block.call,))
            block.unload()

    def _make(self, calls: Sequence[Call]) -> None:
        for what, function, arguments in calls:
            status = function(*arguments)
            if status > _GOOD:
                self._check(what, status)

    def _check(self, what: str, status: int) -> None:
        if status > _GOOD:
            self._dead = self._dead or status >= Status.ERROR
            said = self._log.last() or "it gave no message"
            raise StepError(f"{self.name}: {what} returned {Status(status).name.capitalize()}: {said}")


def _filled(blocks: Any) -> list[DiscreteBlock]:
    return [block for block in blocks if not block.empty]
