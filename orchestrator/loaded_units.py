"""Units that are loaded once and fly one run after another."""

from __future__ import annotations

from collections.abc import Callable

from orchestrator.blueprint import Blueprint
from orchestrator.fmi.isolated import IsolatedUnit
from orchestrator.fmi.load import load
from orchestrator.fmi.unit import FmuUnit
from orchestrator.master.result import RunResult
from orchestrator.master.slave import Interface
from orchestrator.simulation import Simulation


class LoadedUnits:
    """FMUs instantiated once and set up again for every run: loading costs more than a short landing."""

    def __init__(self) -> None:
        self._units: dict[str, tuple[Interface, FmuUnit | IsolatedUnit]] = {}

    def run(self, blueprint: Blueprint, on_hang: Callable[[RunResult], None] | None = None) -> RunResult:
        """As a scenario's run from fresh instances, to the bit. on_hang: as in Simulation."""
        try:
            units = blueprint.scenario.units
            simulation = Simulation(blueprint, [self._loaded(it.name, blueprint.interfaces[it.name], it.isolate) for it in units])
            simulation.on_hang = on_hang
            result = simulation.run()
        except BaseException:
            self.close()  # a unit that failed is not used again
            raise
        if not result.complete:
            self.close()
        return result

    def close(self) -> None:
        for _, unit in self._units.values():
            unit.close()
        self._units.clear()

    def _loaded(self, name: str, interface: Interface, isolate: bool) -> FmuUnit | IsolatedUnit:
        known = self._units.get(name)
        if known is not None and known[0].sha256 == interface.sha256:
            return known[1]
        if known is not None:
            known[1].close()
        unit = load(name, interface, isolate)
        self._units[name] = (interface, unit)
        return unit
