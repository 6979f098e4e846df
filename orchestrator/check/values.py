"""What `--set parameter=value` gives a single unit."""

from __future__ import annotations

from collections.abc import Sequence

from orchestrator.errors import UserError
from orchestrator.master.slave import Interface, Value
from orchestrator.scenario.expand import toml_value
from orchestrator.scenario.parameters import start_values


def given_values(interface: Interface, unit: str, overrides: Sequence[str]) -> dict[str, Value]:
    """Start values by variable, each checked against what the unit declares."""
    given = {}
    for override in overrides:
        name, equals, value = override.partition("=")
        if not equals:
            raise UserError(f"--set {override}: expects parameter=value, e.g. --set mass=7000")
        given[name.strip()] = toml_value(value)
    return start_values(unit, interface, given)
