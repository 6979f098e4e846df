"""The pictures of a run directory."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from orchestrator.master.result import RunResult
from orchestrator.results import plot_landing, plot_run, plot_style, plot_terrain
from orchestrator.results.channels import Array, Channels
from orchestrator.results.energy import EnergyAccount
from orchestrator.results.schema import ResultsTable
from orchestrator.terrain.ground import ground_of


def draw(
    title: str,
    result: RunResult,
    channels: Channels,
    table: ResultsTable,
    account: EnergyAccount | None,
    summary: dict[str, Any],
    folder: Path,
) -> None:
    """Every figure there is data for; a curve needs two rows."""
    contacts = summary.get("contact_times_s", {})
    figures: dict[str, Figure | None] = {}
    if len(result.times) > 1:
        if table.resolved_kind == "touchdown":
            figures["motion"] = plot_landing.motion(title, channels, table, contacts)
            figures["pads"] = plot_landing.pads(title, channels, table, contacts)
            ground = ground_of(result.unit_records)
            figures["terrain"] = None if ground is None else plot_terrain.terrain(title, channels, table, contacts, ground)
            figures["struts"] = plot_landing.struts(title, channels, table, contacts)
        figures["report"] = plot_run.reported(title, channels, table)
        figures["energy"] = plot_run.energy(title, result.times, account, contacts) if account else None
    if result.log:
        figures["intervals"] = plot_run.intervals(title, *_attempts(result), contacts)
    folder.mkdir(exist_ok=True)
    for name, figure in figures.items():
        if figure is not None:
            plot_style.save(figure, folder / f"{name}.png")


def _attempts(result: RunResult) -> tuple[Array, Array, Array]:
    """Ends (s), lengths (s) and acceptance (1 or 0) of the attempted intervals."""
    rows = np.array([(row.time + row.interval, row.interval, row.accepted) for row in result.log], dtype=np.float64)
    return rows[:, 0], rows[:, 1], rows[:, 2]
