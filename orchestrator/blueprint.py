"""A scenario checked against the units it names, before any binary is loaded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from orchestrator.errors import SspError
from orchestrator.fmi.description import read_interface
from orchestrator.master.converter import Derived
from orchestrator.master.slave import Interface, Value
from orchestrator.master.system import Link, PortPair
from orchestrator.master.until import Bound
from orchestrator.results.schema import read as read_results_table
from orchestrator.scenario.early_end import bounds_of
from orchestrator.scenario.expand import Scenario, expand
from orchestrator.scenario.locate import find_fmu, fmu_folder
from orchestrator.scenario.parameters import start_values
from orchestrator.scenario.read import SSP, Tree, check_table, merge, read_table
from orchestrator.scenario.record import DISCRETE, matching_outputs
from orchestrator.scenario.wiring import Wiring
from orchestrator.terrain.hand_over import terrain_values


@dataclass
class Blueprint:
    """A checked system, before any binary is loaded."""

    scenario: Scenario
    path: Path | None
    interfaces: dict[str, Interface]
    links: list[Link]
    pairs: list[PortPair]
    values: list[dict[str, Value]]
    recorded: list[list[str]]
    zero: list[list[str]] = field(default_factory=list)
    """Outputs of the start condition, per unit."""
    located: list[list[str]] = field(default_factory=list)
    """Outputs whose changes are located, per unit."""
    derived: list[list[Derived]] = field(default_factory=list)
    """Outputs worked out for connections in another unit of measure, frame or sign, per unit."""
    made: list[int] = field(default_factory=list)
    """How many links each connection came to."""
    bounds: list[Bound] = field(default_factory=list)
    """Conditions of an early end."""
    sha256: str | None = None
    """Of the scenario's file."""


def read_scenario(path: Path, overrides: Sequence[str] = (), changes: Tree | None = None, variant: str = "") -> Scenario:
    """The scenario said out in full; `changes` are merged over the file (e.g. {"stop_time": 2.0}); `variant` of an .ssp."""
    tree = merge(read_table(path, variant), changes or {})
    where = f"{path.name}#{variant}" if variant else path.name
    if path.suffix == SSP and "stop_time" not in tree:
        raise SspError(f"{where}: does not say how long to run; give --stop-time SECONDS")
    return expand(check_table(tree, where), where, overrides)


def draw_up(scenario: Scenario, path: Path | None = None) -> Blueprint:
    """Every check that needs only the units' descriptions."""
    read_results_table(scenario.table.results, f"{scenario.where}: results")
    folder = fmu_folder(scenario.table.fmus, path)
    read: dict[Path, Interface] = {}
    interfaces: dict[str, Interface] = {}
    for unit in scenario.units:
        fmu = find_fmu(unit.fmu, folder, f"{scenario.where}: units.{unit.name}")
        interfaces[unit.name] = read[fmu] = read.get(fmu) or read_interface(fmu)
    ground = terrain_values(scenario.table.terrain, interfaces, scenario.where)
    values = [
        ground.get(u.name, {}) | start_values(f"{scenario.where}: {u.name}", interfaces[u.name], u.parameters) for u in scenario.units
    ]
    wiring = Wiring(interfaces, scenario.where, scenario.table.master.slopes)
    for connection in scenario.connections:
        wiring.connect(connection)
    recorded = matching_outputs(scenario.record, interfaces, f"{scenario.where}: record.variables") if scenario.record else []
    zero = matching_outputs(scenario.zero, interfaces, f"{scenario.where}: start.zero") if scenario.zero else []
    locate = scenario.table.master.locate
    located = matching_outputs(locate, interfaces, f"{scenario.where}: master.locate", DISCRETE) if locate else []
    bounds = bounds_of(scenario.table.until, interfaces, f"{scenario.where}: until")
    if bounds and not recorded:
        recorded = [[] for _ in interfaces]
    for bound in bounds:
        if bound.output not in recorded[bound.unit]:
            recorded[bound.unit].append(bound.output)
    return Blueprint(
        scenario, path, interfaces, wiring.links, wiring.pairs, values, recorded, zero, located, wiring.derived, wiring.made, bounds,
        _digest(path),
    )  # fmt: skip


def _digest(path: Path | None) -> str | None:
    """None where there is no file, or no longer."""
    try:
        return None if path is None else sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None
