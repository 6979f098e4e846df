"""A system on the terminal, before anything runs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.table import Table
from rich.text import Text

from orchestrator.master.slave import Interface
from orchestrator.scenario.parameters import settable_stems

if TYPE_CHECKING:
    from orchestrator.blueprint import Blueprint


def overview(blueprint: Blueprint) -> Iterator[Table | Text]:
    """Title, units, connections, parameters."""
    table = blueprint.scenario.table
    yield Text(f"{table.title or blueprint.scenario.where}: {table.start_time:g} to {table.stop_time:g} s", style="bold")
    yield _units(blueprint)
    yield _connections(blueprint)
    yield _parameters(blueprint)


def _units(blueprint: Blueprint) -> Table:
    table = Table("unit", "FMU", "claims (tried when run)", "ports", title="Units, in the order of stepping", title_justify="left")
    for name, interface in blueprint.interfaces.items():
        table.add_row(Text(name), Text(interface.model_name), Text(", ".join(_claims(interface))), Text(", ".join(interface.ports)))
    return table


def _claims(interface: Interface) -> list[str]:
    """What the master can make use of."""
    told = {"rollback": "canGetAndSetFMUstate", "serialised state": "canSerializeFMUstate", "interpolation": "canInterpolateInputs"}
    claims = [what for what, capability in told.items() if interface.claims(capability)]
    if interface.capabilities.get("canHandleVariableCommunicationStepSize", True):
        claims.append("variable step")
    return claims + (["slopes"] if any(v.name.partition("[")[0].endswith("_slope") for v in interface.of("input")) else [])


def _connections(blueprint: Blueprint) -> Table:
    table = Table("from", "", "to", "values", "altered by", "scheme", title="Connections", title_justify="left")
    for connection, made in zip(blueprint.scenario.connections, blueprint.made, strict=True):
        arrow = "<->" if connection.both_ways else "->"
        altered = ", ".join(connection.alteration.as_run())
        scheme = connection.scheme or "by the master"
        table.add_row(Text(connection.first), arrow, Text(connection.second), str(made), altered, scheme)
    return table


def _parameters(blueprint: Blueprint) -> Table:
    table = Table("parameter", "value", "unit", "", "meaning", title="Parameters (* set by the scenario)", title_justify="left")
    for place, (name, interface) in enumerate(blueprint.interfaces.items()):
        values = blueprint.values[place]
        for stem in settable_stems(interface):
            elements = interface.vectors[stem]
            given = any(v.name in values for v in elements)
            if elements[0].causality == "input" and not given:
                continue
            shown = ", ".join(str(values.get(v.name, v.start)) for v in elements)
            first = elements[0]
            table.add_row(Text(f"{name}.{stem}"), Text(shown), Text(first.unit), "*" if given else "", Text(first.description))
    return table
