"""`orchestrator campaign`."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from orchestrator.errors import EXIT_INTERRUPTED
from orchestrator.output_folder import can_take_results
from orchestrator.scenario.locate import find_campaign


def campaign(
    campaign: Annotated[str, typer.Argument(help="A file, the bare name of one in scenarios/campaigns, or the folder of one begun.")],
    out: Annotated[Path | None, typer.Option(help="Folder for the landings (default: results/CAMPAIGN).")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a dask scheduler; without it, processes on this machine.")] = None,
    workers: Annotated[int, typer.Option(help="Processes on this machine; 0: one a core.")] = 0,
    only: Annotated[int | None, typer.Option(help="Fly this landing (index) alone, and compare it with the one that is kept.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No progress, no summary.")] = False,
) -> None:
    """Fly many landings of a scenario with scattered inputs, and keep what came of each as a row.

    Interrupted, or killed, it goes on from where it was when called again with the same --out.
    """
    from orchestrator.campaign.alone import fly_alone
    from orchestrator.campaign.campaign import Campaign
    from orchestrator.campaign.crew import Crew
    from orchestrator.campaign.summary import terminal_summary

    path = find_campaign(campaign)
    plan = Campaign.read(path)
    folder = out or (path if path.is_dir() else Path("results") / path.stem)
    if only is not None:
        fly_alone(plan, folder, only, quiet)
        return
    can_take_results(folder)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs inherit that it is ignored
    try:
        with Crew(workers, scheduler) as crew, _bar(plan.table.title or plan.where, quiet) as heard:
            rows, cost = plan.fly(folder, crew, heard)
    except KeyboardInterrupt:
        typer.echo(f"interrupted: {folder}: what has been flown is kept; the same command goes on from there", err=True)
        raise typer.Exit(EXIT_INTERRUPTED) from None
    if not quiet:
        Console().print(terminal_summary(plan, rows, cost))
        typer.echo(f"rows: {folder / 'landings.parquet'}; one alone: orchestrator campaign {folder} --only INDEX")


@contextmanager
def _bar(title: str, quiet: bool) -> Iterator[Any]:
    """A bar with the time left on a terminal (stderr), nothing in a pipe."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield None
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("landings{task.fields[failed]}"))
    with Progress(*columns, TimeElapsedColumn(), TextColumn("left:"), TimeRemainingColumn(), console=console, transient=True) as bar:
        task = bar.add_task(title, total=None, failed="")

        def heard(flown: int, of: int, failed: int) -> None:
            bar.update(task, completed=flown, total=of, failed=f", {failed} not flown" if failed else "")

        yield heard
