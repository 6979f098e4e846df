"""`orchestrator doghouse`."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console

from orchestrator.errors import EXIT_INTERRUPTED
from orchestrator.output_folder import can_take_results
from orchestrator.scenario.locate import find_scenario

if TYPE_CHECKING:
    from orchestrator.doghouse.flying import Heard


def doghouse(
    plan: Annotated[str, typer.Argument(help="A Doghouse's TOML file, or the bare name of one in scenarios/.")] = "doghouse",
    out: Annotated[Path | None, typer.Option(help="Folder for picture and data (default: results/PLAN).")] = None,
    workers: Annotated[int, typer.Option(help="Processes on this machine; 0: one a core.")] = 0,
    scheduler: Annotated[str | None, typer.Option(help="Address of a dask scheduler; without it, processes on this machine.")] = None,
    check: Annotated[bool, typer.Option(help="Fly both landings of every bracket again by the separate units.")] = True,
    quiet: Annotated[bool, typer.Option("--quiet", help="No progress, no tables.")] = False,
) -> None:
    """Find how fast the lander may touch down before it tips over or a strut runs out of stroke, and draw that over the certified envelope.

    Interrupted, or killed, it goes on from where it was when called again with the same --out.
    """
    from orchestrator.campaign.crew import Crew
    from orchestrator.doghouse.find import find
    from orchestrator.doghouse.model import read
    from orchestrator.doghouse.picture import draw
    from orchestrator.doghouse.report import terminal_report
    from orchestrator.doghouse.table import markdown

    path = find_scenario(plan)
    read_plan = read(path)
    folder = out or Path("results") / path.stem
    can_take_results(folder)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs inherit that it is ignored
    try:
        with Crew(workers, scheduler) as crew, _stages(quiet) as heard:
            outcome = find(read_plan, path, folder, crew, heard, check)
    except KeyboardInterrupt:
        typer.echo(f"interrupted: {folder}: what has been flown is kept; the same command goes on from there", err=True)
        raise typer.Exit(EXIT_INTERRUPTED) from None
    outcome.write(folder)
    (folder / "doghouse.md").write_text(markdown(outcome), encoding="utf-8")
    draw(outcome, folder / "doghouse.png")
    if not quiet:
        Console().print(terminal_report(outcome, folder))


@contextmanager
def _stages(quiet: bool) -> Iterator[Heard | None]:
    """The present stage and its landings on a terminal (stderr), nothing in a pipe."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield None
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description:50}"), BarColumn(), MofNCompleteColumn(), TextColumn("landings"), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("reading", total=None)
        yield lambda stage, done, of: bar.update(task, description=stage, completed=done, total=of)
