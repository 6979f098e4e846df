"""An FMU behind the master's protocol, whatever its version of FMI: preallocated arrays, one set and one get per type and step.

fmpy loads the library and declares the C functions; the calls below go to those functions directly, because a wrapper that logs
and checks every call costs more than the call.
"""

from __future__ import annotations

import ctypes
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from time import perf_counter
from typing import Any, ClassVar

from orchestrator.errors import StepError, UnitError
from orchestrator.fmi.arrays import Access, Block, Call, Entry, fill, in_place, pointer
from orchestrator.fmi.description import model_identifier, read_interface
from orchestrator.fmi.messages import MessageLog
from orchestrator.fmi.types import FmiType, types_of
from orchestrator.fmi.unpack import unpack
from orchestrator.master.slave import Binding, Interface, Kind, Status, Value, Variable, Vector

GOOD, DISCARD = int(Status.WARNING), int(Status.DISCARD)


class FmuUnit(ABC):
    """One instance of an FMU. After the status Error or Fatal it is never touched again."""

    prefix: ClassVar[str]
    """Of the C functions."""
    state: ClassVar[str]
    """"FMUstate", as this version of FMI spells it."""
    counted: ClassVar[bool]
    """Whether gets and sets are told the number of values."""

    called: ClassVar[str] = ""
    """The unit that was last called, whichever it was, and for what; a doStep is not noted here, the master's watchdog knows of it."""

    def __init__(self, name: str, path: Path, interface: Interface | None = None) -> None:
        self.name = name
        self.interface = interface or read_interface(path)
        self.steps = 0
        self.seconds = 0.0
        self.reached: float | None = None
        self._log = MessageLog(name)
        self._dead = self._used = self._begun = False
        self._slot = ctypes.c_void_p(None)
        self._types = types_of(self.interface.fmi_version)
        self._given: Mapping[str, Value] = {}
        self._sending: list[Block] = []
        try:
            names = {
                "instanceName": name,
                "guid": self.interface.guid,
                "modelIdentifier": model_identifier(path),
                "unzipDirectory": str(unpack(path, self.interface.sha256)),
            }
            self._fmu: Any = self._instantiated(names)
        except UnitError:
            raise
        except Exception as error:
            raise UnitError(f"{name} ({path.name}): cannot be instantiated ({self._log.last() or error}); check its dependencies") from None
        self._dll: Any = self._fmu.dll
        self._component = ctypes.c_void_p(self._fmu.component)

    @abstractmethod
    def _instantiated(self, names: dict[str, str]) -> Any:
        """fmpy's FMU, instantiated."""

    @abstractmethod
    def _enter_initialization(self, start: float, stop: float) -> None: ...

    @abstractmethod
    def _advance(self, time: float, interval: float) -> int:
        """doStep; its status, GOOD or less or DISCARD. Sets `reached` after a DISCARD."""

    def _rate_calls(self, rates: Sequence[Variable], vector: Vector, offset: int) -> list[Call]:
        """Calls that set input derivatives."""
        return []

    @property
    def messages(self) -> list[str]:
        return self._log.messages

    @property
    def said(self) -> int:
        """How many messages there were, those no longer kept among them."""
        return self._log.taken

    def said_since(self, count: int) -> list[str]:
        """The messages kept of those after so many."""
        new = self._log.taken - count
        return self._log.messages[-new:] if new > 0 else []

    @property
    def complaint(self) -> str:
        """What the unit logged as an error since its last start; an initialisation may fail in no other way (decision 2)."""
        return self._log.complaint

    def bind(self, binding: Binding) -> None:
        inputs, outputs = (list(enumerate(self._variables(names))) for names in (binding.inputs, binding.outputs))
        first = [*outputs[: binding.coupled], *(e for e in outputs[binding.coupled :] if e[1].kind is not Kind.REAL)]
        later = [e for e in outputs[binding.coupled :] if e[1].kind is Kind.REAL]
        self._binding = binding                      # keeps the memory alive
        self._send_calls, self._sending = self._moves("Set", inputs, binding.u)
        self._get_calls, self._fetching = self._moves("Get", first, binding.y)
        self._observe_calls, self._observing = self._moves("Get", later, binding.y)
        self._send_calls += self._rate_calls(self._variables(binding.rates), binding.u, len(inputs))
        self._start_blocks()

    def set_up(self, start: float, stop: float, values: Mapping[str, Value]) -> None:
        self._note("it was initialised")
        self._free_slot()
        if self._used:
            self._check("reset", self._function("Reset")(self._component))
        self._used = True
        self._log.forget()
        self._given = dict(values)
        self._start_blocks()
        self._make(self._start_calls(values))
        self._enter_initialization(start, stop)

    def change(self, values: Mapping[str, Value]) -> None:
        """Other start values during initialisation; of an array all that differ from the model description's."""
        self._make(self._start_calls(values))

    def exchange(self) -> None:
        self._note("it was initialised")
        self._send()
        self._fetch()
        self._observe()

    def begin(self) -> None:
        self._note("it was initialised")
        self._send()
        self._check("exitInitializationMode", self._function("ExitInitializationMode")(self._component))
        self._begun = True
        self._fetch()
        self._observe()

    def step(self, time: float, interval: float) -> Status:
        entered = perf_counter()
        self.steps += 1
        self._send()
        status = self._advance(time, interval)
        if status != DISCARD:
            self._fetch()
        self.seconds += perf_counter() - entered
        return Status.DISCARD if status == DISCARD else Status.OK

    def observe(self) -> None:
        entered = perf_counter()
        self._note("its outputs were read")
        self._observe()
        self.seconds += perf_counter() - entered

    def save(self) -> None:
        entered = perf_counter()
        self._note("its state was saved")
        # Freed first: passing the old slot for reuse is allowed, but runtimes exist that leak it.
        self._free_slot()
        self._check(f"get{self.state}", self._function(f"Get{self.state}")(self._component, ctypes.byref(self._slot)))
        self.seconds += perf_counter() - entered

    def restore(self) -> None:
        entered = perf_counter()
        self._note("its state was restored")
        self._check(f"set{self.state}", self._function(f"Set{self.state}")(self._component, self._slot))
        self.seconds += perf_counter() - entered

    def serialised_state(self) -> bytes:
        """The kept state as bytes, where the unit can serialise."""
        self._note("its state was serialised")
        size, what = ctypes.c_size_t(0), f"Serialized{self.state}Size"
        self._check(what, self._function(what)(self._component, self._slot, ctypes.byref(size)))
        buffer = ctypes.create_string_buffer(size.value)
        what = f"Serialize{self.state}"
        self._check(what, self._function(what)(self._component, self._slot, self._bytes(buffer), size.value))
        return buffer.raw

    def adopt_state(self, data: bytes) -> None:
        """Put serialised bytes into the slot; `restore` then goes there."""
        self._note("its state was deserialised")
        self._free_slot()
        what = f"{self.deserialize}{self.state}"
        buffer = ctypes.create_string_buffer(data, len(data))
        self._check(what, self._function(what)(self._component, self._bytes(buffer), len(data), ctypes.byref(self._slot)))

    deserialize: ClassVar[str]

    @staticmethod
    @abstractmethod
    def _bytes(buffer: Any) -> Any:
        """As this version's functions take bytes."""

    def close(self) -> None:
        """Free the instance. Left open, a Python runtime inside a unit may crash when the interpreter ends."""
        if not self._dead:
            self._free_slot()
            if self._begun:
                self._function("Terminate")(self._component)
            self._function("FreeInstance")(self._component)
            self._dead = True

    def _free_slot(self) -> None:
        if self._slot:
            self._check(f"free{self.state}", self._function(f"Free{self.state}")(self._component, ctypes.byref(self._slot)))
            self._slot = ctypes.c_void_p(None)

    def _note(self, what: str) -> None:
        FmuUnit.called = f"{self.name}: crashed while {what}"

    def _variables(self, names: Sequence[str]) -> list[Variable]:
        return [self.interface.variables[name] for name in names]

    def _function(self, what: str) -> Any:
        return getattr(self._dll, self.prefix + what)

    def _access(self, verb: str, fmi_type: FmiType) -> Access:
        what = verb + fmi_type.calls
        return Access(self.name, what[0].lower() + what[1:], self._function(what), self._component, self.counted)

    def _moves(self, verb: str, entries: Sequence[Entry], vector: Vector) -> tuple[list[Call], list[Block]]:
        """What moves these variables to or from the vector: calls in place, and blocks."""
        groups: dict[str, list[Entry]] = {}
        for place, variable in entries:
            groups.setdefault(self._types[variable.type].calls, []).append((place, variable))
        calls: list[Call] = []
        blocks: list[Block] = []
        for group in groups.values():
            fmi_type = self._types[group[0][1].type]
            access = self._access(verb, fmi_type)
            if in_place(group, fmi_type):
                calls.append(access.call([v for _, v in group], pointer(vector, group[0][0]), len(group)))
            else:
                arrays = {variable.reference: self._arrays[self._key(variable)] for _, variable in group}
                blocks.append(Block(access, fmi_type, group, arrays, vector))
        return calls, blocks

    @cached_property
    def _arrays(self) -> dict[tuple[str, int], list[Variable]]:
        """(get and set functions, reference) -> the elements it stands for, in order: FMI 2.0 numbers each type for itself."""
        found: dict[tuple[str, int], dict[int, Variable]] = {}
        for variable in self.interface.variables.values():
            found.setdefault(self._key(variable), {}).setdefault(variable.element, variable)
        return {key: [elements[at] for at in sorted(elements)] for key, elements in found.items()}

    def _key(self, variable: Variable) -> tuple[str, int]:
        return self._types[variable.type].calls, variable.reference

    def _by_first_name(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """The values under the names that stand in `_arrays`: of aliases the first."""
        given = {}
        for name, value in values.items():
            own = self.interface.variables[name]
            first = next(it for it in self._arrays[self._key(own)] if it.element == own.element)
            given[first.name] = value
        return given

    def _start_blocks(self) -> None:
        for block in self._sending:
            block.start(self._by_first_name(self._given))

    def _start_calls(self, values: Mapping[str, Value]) -> list[Call]:
        """One call for each variable or whole array that is given a start value."""
        calls: list[Call] = []
        given = self._by_first_name(values)
        for key, variable in {self._key(v): v for v in self._variables(list(values))}.items():
            fmi_type, elements = self._types[variable.type], self._arrays[key]
            array = (fmi_type.c_type * len(elements))()
            fill(array, elements, fmi_type, given)
            call = self._access("Set", fmi_type).call([variable], array, len(elements))
            shown = ", ".join(f"{e.name} = {given[e.name]}" for e in elements if e.name in given)
            calls.append(call._replace(what=f"set {shown}"))
        return calls

    def _send(self) -> None:
        self._make(self._send_calls)
        for block in self._sending:
            block.load()
            self._make((block.call,))

    def _fetch(self) -> None:
        self._make(self._get_calls)
        for block in self._fetching:
            self._make((block.call,))
            block.unload()

    def _observe(self) -> None:
        self._make(self._observe_calls)
        for block in self._observing:
            self._make((block.call,))
            block.unload()

    def _make(self, calls: Sequence[Call]) -> None:
        for what, function, arguments in calls:
            status = function(*arguments)
            if status > GOOD:
                self._check(what, status)

    def _check(self, what: str, status: int) -> None:
        if status > GOOD:
            self._dead = self._dead or status >= Status.ERROR
            said = self._log.last() or "it gave no message"
            raise StepError(f"{self.name}: {what} returned {Status(status).name.capitalize()}: {said}")
