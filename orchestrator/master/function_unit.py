"""A unit made of two Python functions: for tests of the master and for quick experiments, without an FMU."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from typing import Any

from orchestrator.master.slave import Binding, Interface, Status, Value, Variable, stem

Record = dict[str, Any]
Advance = Callable[[Record, Record, float, float], Record | None]
"""(state, inputs, time, interval) -> outputs, having changed the state; None refuses the step."""
Observe = Callable[[Record, Record], Record]
"""(state, inputs) -> outputs at the start."""


class FunctionUnit:
    """Inputs and outputs are scalars by name; parameters are entries of the state."""

    def __init__(
        self,
        name: str,
        inputs: Mapping[str, float],
        state: Mapping[str, Any],
        observe: Observe,
        advance: Advance,
        rollback: bool = True,
        interpolates: bool = False,
    ) -> None:
        self.name = name
        self._inputs, self._start = dict(inputs), dict(state)
        self._observe, self._advance = observe, advance
        outputs = observe(copy.deepcopy(self._start), dict(inputs))
        variables = [Variable(i, causality="input", start=str(v)) for i, v in inputs.items()]
        variables += [Variable(o, causality="output") for o in outputs]
        variables += [Variable(p, causality="parameter", start=str(v)) for p, v in state.items() if isinstance(v, (int, float))]
        self.interface = Interface(
            model_name=name,
            variables={v.name: v for v in sorted(variables, key=lambda v: stem(v.name))},
            capabilities={"canGetAndSetFMUstate": rollback, "canInterpolateInputs": interpolates},
        )
        self.steps = 0
        self.seconds = 0.0
        self.reached: float | None = None
        self.messages: list[str] = []

    def bind(self, binding: Binding) -> None:
        self._binding = binding
        self._names = [*binding.inputs, *(f"der({name})" for name in binding.rates)]

    def set_up(self, start: float, stop: float, values: Mapping[str, Value]) -> None:
        self._u: Record = dict(self._inputs)
        self._state = copy.deepcopy(self._start)
        for name, value in values.items():
            (self._u if name in self._inputs else self._state)[name] = value

    def exchange(self) -> None:
        self._take()
        self._give(self._observe(self._state, self._u))

    def begin(self) -> None:
        self.exchange()

    def step(self, time: float, interval: float) -> Status:
        self.steps += 1
        self._take()
        outputs = self._advance(self._state, self._u, time, interval)
        if outputs is None:
            return Status.DISCARD
        self._give(outputs)
        return Status.OK

    def observe(self) -> None:
        pass

    def save(self) -> None:
        self._saved = copy.deepcopy(self._state)

    def restore(self) -> None:
        self._state = copy.deepcopy(self._saved)

    def close(self) -> None:
        pass

    def _take(self) -> None:
        self._u.update(zip(self._names, self._binding.u.tolist(), strict=True))

    def _give(self, outputs: Record) -> None:
        for place, name in enumerate(self._binding.outputs):
            self._binding.y[place] = outputs[name]
