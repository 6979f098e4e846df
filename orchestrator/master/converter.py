"""A unit whose outputs are also given in another unit of measure, frame or sign: for connections that ask for that.

The master knows such outputs as any others of the unit, with `_mean` and `_slope` beside them where the unit's own have these.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.errors import UnitError
from orchestrator.master.slave import Binding, Interface, Kind, Slave, Status, Value, Variable

Places = NDArray[np.intp]


@dataclass(frozen=True)
class Derived:
    """One output worked out from others of its unit: Σ weight·source + offset."""

    variable: Variable
    sources: tuple[str, ...]
    weights: tuple[float, ...]
    offset: float


class Converter:
    """The unit with the further outputs. Its own numbers stand in a vector of their own and are copied to the board."""

    def __init__(self, slave: Slave, derived: Sequence[Derived]) -> None:
        self._slave = slave
        self._derived = {it.variable.name: it for it in derived}
        self.interface: Interface = replace(
            slave.interface, variables={**slave.interface.variables, **{it.variable.name: it.variable for it in derived}}
        )

    @property
    def name(self) -> str:
        return self._slave.name

    @property
    def messages(self) -> list[str]:
        return self._slave.messages

    @property
    def complaint(self) -> str:
        return getattr(self._slave, "complaint", "")

    @property
    def reached(self) -> float | None:
        return self._slave.reached

    @reached.setter
    def reached(self, time: float | None) -> None:
        self._slave.reached = time

    @property
    def steps(self) -> int:
        return self._slave.steps

    @steps.setter
    def steps(self, count: int) -> None:
        self._slave.steps = count

    @property
    def seconds(self) -> float:
        return self._slave.seconds

    @seconds.setter
    def seconds(self, spent: float) -> None:
        self._slave.seconds = spent

    def bind(self, binding: Binding) -> None:
        variables = self.interface.variables
        own = [name for name in binding.outputs if name not in self._derived]
        wanted = [self._derived[name] for name in binding.outputs if name in self._derived]
        first = [name for name in binding.outputs[: binding.coupled] if name not in self._derived]
        sources = dict.fromkeys(source for it in wanted for source in it.sources)
        coupled = list(dict.fromkeys([*first, *(name for name in sources if variables[name].kind is Kind.REAL)]))
        later = [name for name in dict.fromkeys([*own, *sources]) if name not in set(coupled)]
        names = coupled + sorted(later, key=lambda name: variables[name].kind is not Kind.REAL)
        self._own = np.zeros(len(names))
        self._y = binding.y
        self._slave.bind(replace(binding, outputs=names, coupled=len(coupled), y=self._own))
        place, target = {name: at for at, name in enumerate(names)}, {name: at for at, name in enumerate(binding.outputs)}
        stepped = [name for name in own if name in set(coupled) or variables[name].kind is not Kind.REAL]
        self._stepped = _pairs(stepped, place, target)
        self._observed = _pairs([name for name in own if name not in set(stepped)], place, target)
        self._sources = np.array([place[name] for name in sources], dtype=np.intp)
        self._targets = np.array([target[it.variable.name] for it in wanted], dtype=np.intp)
        column = {name: at for at, name in enumerate(sources)}
        self._weights = np.zeros((len(wanted), len(sources)))
        for row, it in enumerate(wanted):
            for source, weight in zip(it.sources, it.weights, strict=True):
                self._weights[row, column[source]] += weight
        self._offsets = np.array([it.offset for it in wanted])

    def set_up(self, start: float, stop: float, values: Mapping[str, Value]) -> None:
        self._slave.set_up(start, stop, values)

    def exchange(self) -> None:
        self._slave.exchange()
        self._give()
        self._give_observed()

    def begin(self) -> None:
        self._slave.begin()
        self._give()
        self._give_observed()

    def step(self, time: float, interval: float) -> Status:
        status = self._slave.step(time, interval)
        if status is not Status.DISCARD:
            self._give()
        return status

    def observe(self) -> None:
        self._slave.observe()
        self._give_observed()

    def save(self) -> None:
        self._slave.save()

    def restore(self) -> None:
        self._slave.restore()

    def close(self) -> None:
        self._slave.close()

    def serialised_state(self) -> bytes:
        return bytes(self._serialising("serialised_state")())

    def adopt_state(self, data: bytes) -> None:
        self._serialising("adopt_state")(data)

    def _serialising(self, method: str) -> Any:
        found = getattr(self._slave, method, None)
        if found is None:
            raise UnitError(f"{self.name}: cannot serialise its state; leave checkpoints out")
        return found

    def _give(self) -> None:
        targets, places = self._stepped
        self._y[targets] = self._own[places]
        self._y[self._targets] = self._weights @ self._own[self._sources] + self._offsets

    def _give_observed(self) -> None:
        targets, places = self._observed
        self._y[targets] = self._own[places]


def _pairs(names: Sequence[str], place: Mapping[str, int], target: Mapping[str, int]) -> tuple[Places, Places]:
    return np.array([target[n] for n in names], dtype=np.intp), np.array([place[n] for n in names], dtype=np.intp)
