"""Unit: an FMI 2.0 co-simulation slave whose whole state is one array.

All variables, hidden states included, lie in `memory`; saving the FMU state copies it, restoring copies it back, bit for
bit. Nothing here raises through the FMI boundary: pythonfmu's binary answers an exception with fmi2Fatal and a second one
kills the process. An error is logged in one line, kept in the String `message`, and answered with fmi2Discard at doStep.
"""

from collections.abc import Iterable, Mapping
from math import isfinite, nan
from typing import Any, ClassVar
from xml.etree.ElementTree import Element

import numpy as np
from pythonfmu.enums import Fmi2Status
from pythonfmu.fmi2slave import Fmi2Slave

from .bounds import Floats, first_outside
from .layout import Checked, Layout
from .records import Record, Start

PHASE, STALE, START_TIME = -3, -2, -1  # slots of the shell's own states
SETTING, STEPPING, FAILED = 0.0, 1.0, 2.0  # phases: before the end of initialisation, after it, after it failed
LONGEST = 500  # characters of a foreign exception's text; a compiler's can be pages


class UnitError(Exception):
    """What a unit raises when it cannot do a step or an initialisation; the message says what, with both values."""


def nanoseconds(time: float) -> int:
    """A time of the FMI call as the integer it was made from."""
    return round(time * 1e9)


class Saved:
    """A saved state: the memory, and which preparation of the unit belongs to it (None: read from bytes)."""

    __slots__ = ("memory", "prepared")

    def __init__(self, memory: Floats, prepared: object) -> None:
        self.memory, self.prepared = memory, prepared


class Unit(Fmi2Slave):  # type: ignore[misc]  # pythonfmu is not typed
    """A unit declares `description` and `variables`, and defines `initialise` and `advance`."""

    description: ClassVar[str] = ""
    variables: ClassVar[tuple[Record, ...]] = ()
    kind: ClassVar[str] = ""  # of port contract; the unit's own name without
    required: ClassVar[tuple[str, ...]] = ()  # what a unit in its place must take or give, or the vehicle cannot land with it
    initially: ClassVar[tuple[str, ...]] = ()  # inputs that initial values of outputs depend on, unless an output says otherwise
    experiment: ClassVar[tuple[float, float, float]] = (0.0, 1.0, 1e-3)  # start, stop, step of the default experiment
    reference_parameters: ClassVar[tuple[tuple[str, Start], ...]] = ()  # what the reference experiment changes
    layout: ClassVar[Layout] = Layout(())

    def __init_subclass__(cls) -> None:
        cls.layout = Layout(cls.variables)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.memory: Floats = self.layout.template.copy()
        self.before: Floats = self.memory.copy()
        self.views: dict[str, Floats] = {}
        self.texts: dict[int, str] = {}  # String parameters by slot: constants of the instance, not in its state
        self.message = ""
        self.prepared: object = None
        self.stepping = False

    # What a unit defines.

    def prepare(self) -> None:
        """Make what is kept outside the memory from the parameters alone; called again when other parameters are restored."""

    def check(self) -> Iterable[str]:
        """What is wrong with the parameters beyond their declared bounds, a line each: what, both values, the rule."""
        return ()

    def initialise(self) -> None:
        """Set states and outputs from parameters and inputs; states and outputs are at their start values before."""

    def advance(self, time: float, step: float) -> None:
        """Take the state from time to time + step and fill the outputs; raise UnitError where that is impossible."""

    @classmethod
    def stimulus(cls, time: float) -> Mapping[str, Start]:
        """The inputs of the reference experiment over the interval that begins at a time; always the same names."""
        return {}

    # What a unit uses.

    def __getitem__(self, name: str) -> Floats:
        """A view of the variable's place in the memory; a scalar's view has length one."""
        view = self.views.get(name)
        if view is None:
            view = self.views[name] = self.memory[self.layout.slices[name]]
        return view

    def __setitem__(self, name: str, values: Any) -> None:
        self[name][...] = values

    def value(self, name: str) -> float:
        """A scalar variable as a Python float."""
        return float(self[name][0])

    def text(self, name: str) -> str:
        """A String parameter."""
        return self.texts.get(self.layout.slices[name].start, "")

    def span(self, first: str, last: str) -> Floats:
        """A view of all that was declared from the first to the last of two variables, companions of the last not included."""
        return self.memory[self.layout.slices[first].start : self.layout.slices[last].stop]

    @property
    def start_time(self) -> float:
        """The start of the experiment in seconds."""
        return float(self.memory[START_TIME])

    # What FMI calls: life cycle.

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        self.memory[START_TIME] = start_time
        self.memory[STALE] = 1.0

    def enter_initialization_mode(self) -> None:
        self.memory[STALE] = 1.0

    def exit_initialization_mode(self) -> None:
        complaint = self.settle()
        self.stepping = complaint is None
        self.memory[PHASE] = FAILED if complaint else STEPPING
        self.message = ""
        if complaint:
            self.report(complaint, Fmi2Status.error)

    def settle(self) -> str | None:
        """Compute the initial states and outputs; on error leave them at their start values and give the complaint."""
        layout, memory = self.layout, self.memory
        memory[layout.computed] = layout.template[layout.computed]
        memory[STALE] = 0.0
        try:
            complaint = self.outside(layout.parameters) or self.outside(layout.inputs) or layout.no_rotation(memory)
            if complaint is None:
                self.prepared = None
                self.prepare()
                self.prepared = object()
                complaint = "; ".join(self.check()) or None
            if complaint is None:
                self.initialise()
                complaint = self.outside(layout.results)
        except Exception as error:
            complaint = f"initialisation: {reason(error)}"
        if complaint:
            memory[layout.computed] = layout.template[layout.computed]
        return complaint

    def do_step(self, current_time: float, step_size: float) -> bool:
        layout, memory = self.layout, self.memory
        if not self.stepping:
            return self.report(self.message or "doStep before a successful initialisation", Fmi2Status.discard)
        self.before[:] = memory
        inputs, results = layout.inputs, layout.results
        try:
            if first_outside(memory, inputs.slots, inputs.low, inputs.high) >= 0:
                raise UnitError(self.outside(inputs))
            if twisted := layout.no_rotation(memory):
                raise UnitError(twisted)
            if not (step_size > 0.0 and isfinite(current_time + step_size)):
                raise UnitError(f"the step is {step_size!r} s from {current_time!r} s, expects more than 0 s")
            self.advance(current_time, step_size)
            if first_outside(memory, results.slots, results.low, results.high) >= 0:
                raise UnitError(self.outside(results))
        except Exception as error:
            memory[:] = self.before
            return self.report(f"at {current_time!r} s: {reason(error)}", Fmi2Status.discard)
        return True

    def outside(self, checked: Checked) -> str | None:
        """A complaint about the first value that leaves its bounds."""
        slot = first_outside(self.memory, checked.slots, checked.low, checked.high)
        return None if slot < 0 else self.layout.complaint(self.memory, slot)

    def report(self, message: str, status: Fmi2Status) -> bool:
        """Log one line with who says it; always False."""
        self.message = message
        self.log(f"{type(self).__name__} {self.instance_name}: {message}", status)
        return False

    # What FMI calls: values. A list of value references is turned into an index once and remembered.

    def get_real(self, vrs: list[int]) -> list[float]:
        if not self.stepping and self.memory[STALE]:
            self.settle()
        try:
            values: list[float] = self.memory[self.layout.access(vrs)[0]].tolist()
        except IndexError as error:
            self.report(f"{error} to get", Fmi2Status.error)
            return [nan] * len(vrs)
        return values

    def get_integer(self, vrs: list[int]) -> list[int]:
        return [int(value) if isfinite(value) else 0 for value in self.get_real(vrs)]

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        return [value != 0.0 for value in self.get_real(vrs)]

    def get_string(self, vrs: list[int]) -> list[str]:
        return [self.texts.get(vr, "") if self.layout.is_text(vr) else self.message for vr in vrs]

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        try:
            where, inputs = self.layout.access(vrs)
        except IndexError as error:
            self.report(f"{error} to set", Fmi2Status.error)
            return
        if self.stepping and not inputs:
            fixed = next(s.name for s in (self.layout.scalars[vr] for vr in vrs) if s.record.causality != "input")
            self.report(f"{fixed} is no input, and is fixed after initialisation: none of this call's values is taken", Fmi2Status.warning)
            return
        self.memory[where] = values
        if not self.stepping:
            self.memory[STALE] = 1.0

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        self.set_real(vrs, [float(value) for value in values])

    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        self.set_real(vrs, [1.0 if value else 0.0 for value in values])

    def set_string(self, vrs: list[int], values: list[str]) -> None:
        if not vrs:
            return
        if not all(self.layout.is_text(vr) for vr in vrs):
            self.report("message is written by the unit alone", Fmi2Status.warning)
        elif self.stepping:
            name = self.layout.scalars[vrs[0]].name
            self.report(f"{name} is fixed after initialisation: none of this call's values is taken", Fmi2Status.warning)
        else:
            self.texts.update(zip(vrs, values, strict=True))
            self.memory[STALE] = 1.0

    # What FMI calls: states.

    def _get_fmu_state(self) -> Saved:
        return Saved(self.memory.copy(), self.prepared)

    def _set_fmu_state(self, state: Saved) -> None:
        if state.memory.size != self.memory.size:
            self.stepping = False
            self.memory[PHASE] = FAILED
            self.report(f"the state restored has {state.memory.size} numbers, expects {self.memory.size}", Fmi2Status.error)
            return
        self.memory[:] = state.memory
        self.stepping = bool(self.memory[PHASE] == STEPPING)
        if self.stepping and (state.prepared is None or state.prepared is not self.prepared):
            self.prepare_again(state)

    def prepare_again(self, state: Saved) -> None:
        """Prepare for the parameters of a restored state; on error no step is done from it."""
        self.prepared = None
        try:
            self.prepare()
        except Exception as error:
            self.stepping = False
            self.report(f"the state restored: {reason(error)}", Fmi2Status.error)
            return
        self.prepared = state.prepared = state.prepared or object()

    @staticmethod
    def _fmu_state_to_bytes(state: Saved) -> bytes:
        return state.memory.tobytes()

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> Saved:
        return Saved(np.frombuffer(state[: len(state) // 8 * 8]).copy(), None)

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        from .description import model_description

        return model_description(type(self), str(self.guid))


def reason(error: Exception) -> str:
    """One line for a log: a UnitError's own words, or a foreign exception with its type."""
    text = " ".join(str(error).split())
    text = text if len(text) <= LONGEST else f"{text[: LONGEST // 2]} ... {text[-LONGEST // 2 :]}"
    return text if isinstance(error, UnitError) else f"{type(error).__name__}: {text}"
