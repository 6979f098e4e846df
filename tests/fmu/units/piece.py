"""A unit on a test stand: its ports by name, its motion over time. The stand knows the port contract and nothing else of the unit."""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from orchestrator.check.driven import Driven
from orchestrator.master.slave import Status

Array = NDArray[np.float64]
Inputs = Mapping[str, object]
Course = Callable[[float], Inputs]


class Piece(Driven):
    """Start it, run it, look at it."""

    def has(self, *names: str) -> bool:
        """Whether it has all of these variables or vectors."""
        return all(name in self.slave.interface.vectors or name in self.slave.interface.variables for name in names)

    def put(self, inputs: Inputs) -> None:
        """Set inputs, scalars and vectors; one that the unit does not take is left out."""
        for name, value in inputs.items():
            if not self.has(name):
                continue
            if isinstance(value, (tuple, list, np.ndarray)):
                self.set_vector(name, np.asarray(value, dtype=float))
            else:
                self[name] = float(value)      # type: ignore[arg-type]

    def ready(self, inputs: Inputs, **parameters: float) -> None:
        """A new start with these inputs, and with those of the parameters that it has."""
        known = {name: value for name, value in parameters.items() if self.has(name)}
        self.prepare(10.0, known)
        self.put(inputs)
        self.begin()

    def run(self, course: Course, stop: float, step: float, start: float = 0.0) -> dict[str, Array]:
        """The outputs after each step, by name of variable; inputs from the course at the start of each step."""
        rows = []
        for n in range(round((stop - start) / step)):
            time = start + n * step
            self.put(course(time))
            status = self.step(time, step)
            assert status is not Status.DISCARD, f"step of {step} s refused at t = {time:.6g} s: {self.last_word}"
            assert not self.not_finite(), f"at t = {time + step:.6g} s {self.not_finite()}"
            rows.append(self.y.copy())
        return {variable.name: column for variable, column in zip(self.outputs, np.array(rows).T, strict=True)}


def of(columns: Mapping[str, Array], name: str) -> Array:
    """A vector's elements over time, a column each; a scalar is a single one."""
    return np.array([column for key, column in columns.items() if key.partition("[")[0] == name]).T


def turned(q: Array, v: Array) -> Array:
    """v of the turned frame in the frame it is turned against: R(q) v, q = (w, x, y, z)."""
    w, u = q[0], np.asarray(q[1:])
    return np.asarray(v + 2.0 * np.cross(u, np.cross(u, v) + w * np.asarray(v)))
