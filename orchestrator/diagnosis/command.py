"""`orchestrator diagnose` and `orchestrator distinguish`."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from orchestrator.errors import EXIT_INTERRUPTED, UserError
from orchestrator.output_folder import can_take_results
from orchestrator.scenario.locate import find_scenario

MeasuredFolders = Annotated[list[Path], typer.Option("--measured", help="Folder of measured data (landing.toml); may be repeated.")]


def diagnose(
    scenario: Annotated[str, typer.Argument(help="A scenario file, or the bare name of one in scenarios/.")],
    measured: MeasuredFolders,
    holdout: Annotated[list[Path] | None, typer.Option(help="Landings kept out of the fit, to judge it by; may be repeated.")] = None,
    effects: Annotated[list[Path] | None, typer.Option(help="Folder of effects of your own, beside the library; may be repeated.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder for the report (default: results/SCENARIO-diagnosis).")] = None,
    budget: Annotated[int, typer.Option(help="Landings after which no pairs and no laws outside are tried.")] = 20000,
    seed: Annotated[int, typer.Option(min=0, help="Of the random draws from the priors that fits start from.")] = 0,
    workers: Annotated[int, typer.Option(min=0, help="Processes; 0: one a core.")] = 0,
    overrides: Annotated[list[str] | None, typer.Option("--set", help="unit.parameter=value; may be repeated.")] = None,
    verdict_only: Annotated[
        bool, typer.Option("--verdict-only", help="diagnosis.json alone: no proof by co-simulation, no report.")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="No progress, no summary.")] = False,
) -> None:
    """Find where simulation and measured data disagree, name the missing effect, add it, and show the gap shrink.

    Interrupted with Ctrl-C it goes on from where it was when called again with the same --out.
    """
    from os import cpu_count

    from orchestrator.diagnosis.diagnose import Request
    from orchestrator.diagnosis.diagnose import diagnose as search
    from orchestrator.diagnosis.outcome import EXIT
    from orchestrator.diagnosis.present import clear_earlier, present
    from orchestrator.diagnosis.report import terminal_summary
    from orchestrator.diagnosis.revision import REVISED

    path = find_scenario(scenario)
    folder = out or Path("results") / f"{path.stem}-diagnosis"
    request = Request(path, measured, holdout or (), effects or (), folder, seed, workers or cpu_count() or 1, overrides or (), budget)
    if path.resolve().parent == folder.resolve() and (path.name == REVISED or path.match("landing_*.toml")):
        raise UserError(f"{path}: would be written over by its own diagnosis; give another --out")
    can_take_results(folder)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs inherit that it is ignored
    try:
        with _stages(quiet) as told:
            diagnosis = search(request, told)
            if verdict_only:
                clear_earlier(request)
                diagnosis.outcome.write(folder)
            else:
                told("proof by co-simulation", "", 0.0)
                present(request, diagnosis)
    except KeyboardInterrupt:
        typer.echo(f"interrupted: {folder}: what has been flown is kept; the same command goes on from there", err=True)
        raise typer.Exit(EXIT_INTERRUPTED) from None
    if not quiet:
        Console().print(terminal_summary(diagnosis.outcome, folder, report=not verdict_only))
    if diagnosis.outcome.verdict in EXIT:
        raise typer.Exit(EXIT[diagnosis.outcome.verdict])


def distinguish(
    scenario: Annotated[str, typer.Argument(help="A scenario file, or the bare name of one in scenarios/.")],
    measured: MeasuredFolders,
    effects: Annotated[list[Path] | None, typer.Option(help="Folder of effects of your own, beside the library; may be repeated.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder for the report (default: results/SCENARIO-distinguish).")] = None,
    workers: Annotated[int, typer.Option(min=0, help="Processes; 0: one a core.")] = 0,
    seed: Annotated[int, typer.Option(min=0, help="0: at the means of the priors; another: at a draw from them.")] = 0,
    overrides: Annotated[list[str] | None, typer.Option("--set", help="unit.parameter=value; may be repeated.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No progress, no summary.")] = False,
) -> None:
    """Before any diagnosis: which effects data like these could tell apart at all, and which more sensor would help."""
    from os import cpu_count

    from orchestrator.diagnosis.diagnose import Request
    from orchestrator.diagnosis.distinguish import distinguish as compare
    from orchestrator.diagnosis.report import terminal_distinguish, write_distinction

    path = find_scenario(scenario)
    folder = out or Path("results") / f"{path.stem}-distinguish"
    request = Request(path, measured, (), effects or (), folder, seed, workers or cpu_count() or 1, overrides or ())
    can_take_results(folder)
    with _stages(quiet) as told:
        table, skipped = compare(request, told)
        write_distinction(folder, table)
    for name, why in skipped.items():
        typer.echo(f"warning: effect {name} is left out: {why}", err=True)
    if not quiet:
        Console().print(terminal_distinguish(table, folder))


@contextmanager
def _stages(quiet: bool) -> Iterator[Any]:
    """A bar a stage on a terminal (stderr), nothing in a pipe."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield lambda stage, best, share: None
        return
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    with Progress(
        TextColumn("{task.description:34}"),
        BarColumn(),
        TextColumn("{task.fields[best]}"),
        TimeElapsedColumn(),
        console=console,
        transient=True,
    ) as bar:
        task = bar.add_task("reading", total=1.0, best="")

        def told(stage: str, best: str, share: float) -> None:
            shown = bar.tasks[task].fields["best"] if not best else f"best so far: {best}"
            bar.update(task, description=stage, completed=share, best=shown)

        yield told
