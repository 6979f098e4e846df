"""`orchestrator sensitivity`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.table import Table

if TYPE_CHECKING:
    from orchestrator.campaign.sensitivity import Indices


def sensitivity(
    folder: Annotated[Path, typer.Argument(help='Folder of a campaign with design = "saltelli", finished or not.')],
    output: Annotated[list[str] | None, typer.Option(help="An output, a column of its rows (default: margins and strokes).")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No tables.")] = False,
) -> None:
    """Say which inputs drive an output: Sobol indices with their bands, as a table, a picture and data."""
    from orchestrator.campaign.campaign import Campaign
    from orchestrator.campaign.plot_sensitivity import draw
    from orchestrator.campaign.sensitivity import sensitivity as analyse
    from orchestrator.campaign.sensitivity import write
    from orchestrator.results.plot_style import save

    plan = Campaign.read(folder)
    found = analyse(plan, folder, output or ())
    written = write(found, folder)
    save(draw(plan.table.title or plan.where, found), folder / "sensitivity.png")
    if not quiet:
        for indices in found:
            typer.echo(f"\n{_title(indices)}")
            Console().print(_table(indices))
    typer.echo(f"data: {written}; picture: {folder / 'sensitivity.png'}")


def _title(indices: Indices) -> str:
    left_out = f", {indices.left_out} left out" if indices.left_out else ""
    return f"{indices.output}: {indices.mean:.4g} ± {indices.deviation:.2g} ({indices.samples} base samples{left_out})"


def _table(indices: Indices) -> Table:
    table = Table(box=None, header_style="bold", pad_edge=False, padding=(0, 2, 0, 0))
    for heading in ("input", "first order", "total"):
        table.add_column(heading, justify="left" if heading == "input" else "right")
    for i in indices.ranked:
        first = f"{indices.first[i]:.2f} ± {indices.first_band[i]:.2f}"
        table.add_row(indices.inputs[i], first, f"{indices.total[i]:.2f} ± {indices.total_band[i]:.2f}")
    return table
