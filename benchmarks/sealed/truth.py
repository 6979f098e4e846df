"""The truth, flown otherwise than the search flies: the twin at a hundredth of its tolerance, or the units coupled."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.effects import Effect
from orchestrator.diagnosis.landing import ATTITUDE, RATES, SPIN, TELEMETRY, Course
from orchestrator.diagnosis.observation import of_units
from orchestrator.diagnosis.overlay import overlay
from orchestrator.diagnosis.recorded import column
from orchestrator.errors import OrchestratorError
from orchestrator.simulation import run_scenario
from sealed.vehicle import Vehicle

Array = NDArray[np.float64]
Path = Literal["twin", "units"]
TIGHT = {"tolerance": 1e-7, "longest_step": 5e-3}
COUPLED = {"tolerance": 1e-7, "max_interval": 2e-3}
GRID = 5e-3  # s between kept instants of the twin
STOP = 4.0  # s since first contact: at rest
STRUTS = ("primary", "left", "right")


def final_columns(vehicle: Vehicle) -> dict[str, str]:
    """Scalar of the data → the twin's output."""
    legs = list(enumerate(vehicle.addresses.legs, 1))
    found = {f"stroke.{leg}.{strut}": f"leg{i}.{strut}.stroke" for i, leg in legs for strut in STRUTS}
    return found | {f"{what}.{leg}": f"soil{i}.{what}" for what in ("penetration", "skid") for i, leg in legs}


def fly(vehicle: Vehicle, values: Mapping[str, float], effects: tuple[Effect, ...], path: Path) -> Course | None:
    """The landing with these values of the twin's variables (others as in the scenario)."""
    own = of_units(values)
    return _by_twin(vehicle, own) if path == "twin" else _by_units(vehicle, own, effects)


def _by_twin(vehicle: Vehicle, values: Mapping[str, float]) -> Course | None:
    lander = vehicle.lander(TIGHT)
    try:
        grid = np.linspace(0.0, STOP, round(STOP / GRID) + 1)
        return lander.land(values, grid, ATTITUDE, tuple(final_columns(vehicle).values()))
    finally:
        lander.close()


def _by_units(vehicle: Vehicle, values: Mapping[str, float], effects: tuple[Effect, ...]) -> Course | None:
    changed = {vehicle.address(name): value for name, value in values.items() if value != vehicle.base.get(name)}
    tree = overlay(vehicle.addresses, changed, [effect.insert for effect in effects if effect.insert])
    tree |= {"stop_time": STOP, "master": COUPLED, "record": {"interval": 2e-3}}
    try:
        result = run_scenario(vehicle.scenario, changes=tree)
    except OrchestratorError:
        return None
    if not result.complete:
        return None
    body = vehicle.addresses.results.body
    where = {name: f"{body}.{name}" for name in (*RATES, *ATTITUDE, *SPIN)}
    where |= {name: column(vehicle.addresses, name.replace("telemetry", "rates")) for name in TELEMETRY}
    columns = {name: np.asarray(result.columns[it], dtype=np.float64) for name, it in where.items()}
    final = {twin: float(result.columns[column(vehicle.addresses, name)][-1]) for name, twin in final_columns(vehicle).items()}
    return Course(np.asarray(result.times, dtype=np.float64), columns, final)
