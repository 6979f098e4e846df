"""An FMI 2.0 co-simulation unit behind the master's protocol: preallocated arrays, one set and one get per type and step.

fmpy loads the library and declares the C functions; the calls below go to those functions directly, because a wrapper that logs
and checks every call costs more than the call.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from fmpy.fmi2 import FMU2Slave

from orchestrator.errors import StepError, UnitError
from orchestrator.fmi.description import model_identifier, read_interface
from orchestrator.fmi.messages import MessageLog
from orchestrator.fmi.unpack import unpack
from orchestrator.master.slave import Binding, Interface, Kind, Status, Value, Variable

_DOUBLES = ctypes.POINTER(ctypes.c_double)


class Fmi2Unit:
    """One instance of an FMU. After the status Fatal (or Error) it is never touched again."""

    def __init__(self, name: str, path: Path, interface: Interface | None = None) -> None:
        self.name = name
        self.interface = interface or read_interface(path)
        self.steps = 0
        self.seconds = 0.0
        self._log = MessageLog(name)
        self._dead = False
        self._slot = ctypes.c_void_p(None)
        folder = unpack(path, self.interface.sha256)
        try:
            self._fmu: Any = FMU2Slave(
                instanceName=name, guid=self.interface.guid, modelIdentifier=model_identifier(path), unzipDirectory=str(folder)
            )
            self._fmu.instantiate(callbacks=self._log.callbacks, loggingOn=True)
        except Exception as error:
            raise UnitError(f"{name} ({path.name}): cannot be instantiated ({self._log.last() or error}); check its dependencies") from None
        self._dll: Any = self._fmu.dll
        self._component = ctypes.c_void_p(self._fmu.component)
        self._used = False

    @property
    def messages(self) -> list[str]:
        return self._log.messages

    def bind(self, binding: Binding) -> None:
        """Lay C arrays over the master's vectors, so that nothing is copied on the way."""
        variables = self.interface.variables
        inputs = [variables[name] for name in binding.inputs]
        outputs = [variables[name] for name in binding.outputs]
        real_in = [v for v in inputs if v.kind is Kind.REAL]
        real_out = [v for v in outputs if v.kind is Kind.REAL]
        self._binding = binding                      # keeps the memory alive
        self._set_real = (_references(real_in), len(real_in), _pointer(binding.u, 0))
        self._get_coupled = (_references(real_out[: binding.coupled]), binding.coupled, _pointer(binding.y, 0))
        recorded = real_out[binding.coupled :]
        self._get_recorded = (_references(recorded), len(recorded), _pointer(binding.y, binding.coupled))
        rates = [variables[name] for name in binding.rates]
        orders = (ctypes.c_int * len(rates))(*[1] * len(rates))
        self._set_rates = (_references(rates), len(rates), orders, _pointer(binding.u, len(inputs)))
        self._in_blocks = [b for b in (_Discrete(inputs, kind) for kind in (Kind.INTEGER, Kind.BOOLEAN)) if b.count]
        self._out_blocks = [b for b in (_Discrete(outputs, kind) for kind in (Kind.INTEGER, Kind.BOOLEAN)) if b.count]

    def set_up(self, start: float, stop: float, values: Mapping[str, Value]) -> None:
        self._free_slot()
        if self._used:
            self._check("reset", self._dll.fmi2Reset(self._component))
        self._used = True
        self._set_values(values)
        self._check("setupExperiment", self._dll.fmi2SetupExperiment(self._component, 0, 0.0, start, 1, stop))
        self._check("enterInitializationMode", self._dll.fmi2EnterInitializationMode(self._component))

    def exchange(self) -> None:
        self._send()
        self._fetch(self._get_coupled)
        self._fetch(self._get_recorded)
        self._fetch_discrete()

    def begin(self) -> None:
        self._send()
        self._check("exitInitializationMode", self._dll.fmi2ExitInitializationMode(self._component))
        self._fetch(self._get_coupled)
        self._fetch(self._get_recorded)
        self._fetch_discrete()

    def step(self, time: float, interval: float) -> Status:
        entered = perf_counter()
        self.steps += 1
        self._send()
        if self._set_rates[1]:
            self._check("setRealInputDerivatives", self._dll.fmi2SetRealInputDerivatives(self._component, *self._set_rates))
        status = self._dll.fmi2DoStep(self._component, time, interval, 0)
        if status == Status.DISCARD:
            self.seconds += perf_counter() - entered
            return Status.DISCARD
        self._check("doStep", status)
        self._fetch(self._get_coupled)
        if self._out_blocks:
            self._fetch_discrete()
        self.seconds += perf_counter() - entered
        return Status.OK

    def observe(self) -> None:
        if self._get_recorded[1]:
            self._fetch(self._get_recorded)

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
        self._check(
            "deSerializeFMUstate",
            self._dll.fmi2DeSerializeFMUstate(self._component, data, len(data), ctypes.byref(self._slot)),
        )

    def close(self) -> None:
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
        if self._set_real[1]:
            self._check("setReal", self._dll.fmi2SetReal(self._component, *self._set_real))
        for block in self._in_blocks:
            block.take(self._binding.u)
            send = self._dll.fmi2SetInteger if block.kind is Kind.INTEGER else self._dll.fmi2SetBoolean
            self._check(f"set{block.kind}", send(self._component, block.references, block.count, block.values))

    def _fetch(self, what: tuple[Any, int, Any]) -> None:
        if what[1]:
            self._check("getReal", self._dll.fmi2GetReal(self._component, *what))

    def _fetch_discrete(self) -> None:
        for block in self._out_blocks:
            fetch = self._dll.fmi2GetInteger if block.kind is Kind.INTEGER else self._dll.fmi2GetBoolean
            self._check(f"get{block.kind}", fetch(self._component, block.references, block.count, block.values))
            block.give(self._binding.y)

    def _set_values(self, values: Mapping[str, Value]) -> None:
        """Start values, one call each: this happens once."""
        for name, value in values.items():
            variable = self.interface.variables[name]
            reference = (ctypes.c_uint * 1)(variable.reference)
            call, data = _single(self._dll, variable, value)
            self._check(f"set {name} = {value}", call(self._component, reference, 1, data))

    def _check(self, what: str, status: int) -> None:
        if status > Status.WARNING:
            self._dead = self._dead or status >= Status.ERROR
            said = self._log.last() or "it gave no message"
            raise StepError(f"{self.name}: {what} returned {Status(status).name.capitalize()}: {said}")


class _Discrete:
    """Integer or Boolean variables of a vector, which FMI moves as C ints."""

    def __init__(self, variables: list[Variable], kind: Kind) -> None:
        self.kind = kind
        self.places = [place for place, v in enumerate(variables) if v.kind is kind]
        self.count = len(self.places)
        self.references = _references([variables[place] for place in self.places])
        self.values = (ctypes.c_int * self.count)()

    def take(self, u: np.ndarray[Any, Any]) -> None:
        for i, place in enumerate(self.places):
            self.values[i] = int(u[place])

    def give(self, y: np.ndarray[Any, Any]) -> None:
        for i, place in enumerate(self.places):
            y[place] = self.values[i]


def _references(variables: list[Variable]) -> Any:
    return (ctypes.c_uint * len(variables))(*[v.reference for v in variables])


def _pointer(vector: np.ndarray[Any, Any], offset: int) -> Any:
    return ctypes.cast(vector.ctypes.data + 8 * offset, _DOUBLES)


def _single(dll: Any, variable: Variable, value: Value) -> tuple[Any, Any]:
    if variable.kind is Kind.REAL:
        return dll.fmi2SetReal, (ctypes.c_double * 1)(float(value))
    if variable.kind is Kind.STRING:
        return dll.fmi2SetString, (ctypes.c_char_p * 1)(str(value).encode())
    call = dll.fmi2SetInteger if variable.kind is Kind.INTEGER else dll.fmi2SetBoolean
    return call, (ctypes.c_int * 1)(int(value))
