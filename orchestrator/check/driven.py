"""A unit in the hands of a test: inputs and outputs by name, the course of a check, the outputs of a step as bits."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from orchestrator.check.course import Course, start_of, value_at
from orchestrator.errors import StepError
from orchestrator.master.slave import Binding, Kind, Slave, Status, Value, Vector

NUMBERS = (Kind.REAL, Kind.INTEGER, Kind.BOOLEAN)


class Driven:
    """Any unit that keeps the master's protocol."""

    def __init__(self, slave: Slave) -> None:
        self.slave, interface = slave, slave.interface
        inputs, outputs = (
            sorted((v for v in interface.of(causality) if v.kind in NUMBERS), key=lambda v: v.kind is not Kind.REAL)
            for causality in ("input", "output")
        )
        self.inputs, self.outputs = inputs, outputs
        self._input_at = {v.name: place for place, v in enumerate(inputs)}
        self._output_at = {v.name: place for place, v in enumerate(outputs)}
        self.u: Vector = np.zeros(len(inputs))
        self.y: Vector = np.zeros(len(outputs))
        reals = sum(v.kind is Kind.REAL for v in outputs)
        slave.bind(Binding([v.name for v in inputs], [], [v.name for v in outputs], reals, self.u, self.y))

    def __setitem__(self, name: str, value: float) -> None:
        self.u[self._input_at[name]] = value

    def __getitem__(self, name: str) -> float:
        """An output, or an input as it was set."""
        return float(self.y[self._output_at[name]] if name in self._output_at else self.u[self._input_at[name]])

    def vector(self, name: str) -> Vector:
        """The elements of an output."""
        return np.array([self[v.name] for v in self.slave.interface.vectors[name]])

    def set_vector(self, name: str, values: Vector | tuple[float, ...] | list[float]) -> None:
        for variable, value in zip(self.slave.interface.vectors[name], values, strict=True):
            self[variable.name] = float(value)

    def prepare(self, stop: float, values: Mapping[str, Value] | None = None) -> None:
        """Into initialisation mode, inputs at their start values."""
        self.u[:] = [start_of(v) for v in self.inputs]
        self.slave.set_up(0.0, stop, values or {})

    def begin(self) -> None:
        """Leave initialisation mode; StepError where the unit complained."""
        self.slave.begin()
        complaint = getattr(self.slave, "complaint", "")
        if complaint:
            raise StepError(f"{self.slave.name}: initialisation: {complaint}")

    def start(self, course: Course, values: Mapping[str, Value] | None = None) -> None:
        """Ready to step, inputs as the course has them at the start."""
        self.prepare(course.stop, values)
        self.follow(course, 0.0, course.step)
        self.begin()

    def follow(self, course: Course, time: float, interval: float) -> None:
        """Set the inputs for an interval; x_slope is x's slope over it, where the course does not say otherwise."""
        for place, variable in enumerate(self.inputs):
            stem, _, index = variable.name.partition("[")
            of = f"{stem.removesuffix('_slope')}{'[' if index else ''}{index}"
            if of != variable.name and of in self._input_at and variable.name not in course.knots:
                source = self.inputs[self._input_at[of]]
                self.u[place] = (value_at(course, source, time + interval) - value_at(course, source, time)) / interval
            else:
                self.u[place] = value_at(course, variable, time)

    def step(self, time: float, interval: float) -> Status:
        status = self.slave.step(time, interval)
        if status is not Status.DISCARD:
            self.slave.observe()
        return status

    def not_finite(self) -> str:
        """The first output that is no number, with its value."""
        places = np.flatnonzero(~np.isfinite(self.y))
        return f"{self.outputs[places[0]].name} is {self.y[places[0]]}" if places.size else ""

    @property
    def last_word(self) -> str:
        """What the unit logged last."""
        messages = self.slave.messages
        return messages[-1] if messages else "it gave no message"
