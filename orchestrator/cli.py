"""The command line: `orchestrator run`, `resume`, `show`, `list`, `diagnose` and more. Exit codes stand in orchestrator.errors."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import current_thread, main_thread
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from typer.core import TyperGroup

from orchestrator.campaign.command import campaign
from orchestrator.campaign.sensitivity_command import sensitivity
from orchestrator.check.command import check
from orchestrator.diagnosis.command import diagnose, distinguish
from orchestrator.doghouse.command import doghouse
from orchestrator.errors import EXIT_INTERRUPTED, OrchestratorError, RunError
from orchestrator.host_environment import host_env
from orchestrator.output_folder import can_take_results
from orchestrator.scenario.locate import all_scenarios, find_scenario, scenario_folder
from orchestrator.scenario.read import read_table
from orchestrator.ssp.command import export

if TYPE_CHECKING:
    from orchestrator.master.result import RunResult
    from orchestrator.simulation import Simulation

ABOUT = "Steps the FMUs of a lunar lander's touchdown together and writes up what came of it."


class Commands(TyperGroup):
    """Ctrl-C that no command has answered reaches `main`; typer would end without a word."""

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            raise typer.Abort from None


app = typer.Typer(cls=Commands, add_completion=False, no_args_is_help=True, help=ABOUT)

ScenarioName = Annotated[str, typer.Argument(help="A scenario file, the bare name of one in scenarios/, or an .ssp.")]
Overrides = Annotated[list[str] | None, typer.Option("--set", help="unit.parameter=value; may be repeated; the unit may be a glob.")]
Variant = Annotated[str, typer.Option("--variant", help="Which system of an .ssp that holds several.")]
Figures = Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures, or write tables alone.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="No progress, no table.")]


@app.command()
def run(
    scenario: ScenarioName,
    out: Annotated[Path | None, typer.Option(help="Folder for the results (default: results/SCENARIO).")] = None,
    overrides: Overrides = None,
    stop_time: Annotated[float | None, typer.Option(help="s; instead of the scenario's.")] = None,
    tolerance: Annotated[float | None, typer.Option(help="m; error allowed per step, instead of the scenario's.")] = None,
    checkpoint_every: Annotated[float | None, typer.Option(help="s simulated between checkpoints, from which `resume` goes on.")] = None,
    variant: Variant = "",
    figures: Figures = True,
    quiet: Quiet = False,
) -> None:
    """Run a scenario and write its results."""
    from orchestrator.blueprint import draw_up, read_scenario  # slow to import, and only needed here
    from orchestrator.checkpoint.checkpoint import FOLDER
    from orchestrator.checkpoint.file import clear
    from orchestrator.checkpoint.schedule import Schedule
    from orchestrator.simulation import Simulation

    path = find_scenario(scenario)
    changes: dict[str, Any] = {} if stop_time is None else {"stop_time": stop_time}
    if tolerance is not None:
        changes["master"] = {"tolerance": tolerance}
    folder = out or Path("results") / (f"{path.stem}-{variant}" if variant else path.stem)
    schedule = None if checkpoint_every is None else Schedule.asked(folder, checkpoint_every)
    simulation = Simulation(draw_up(read_scenario(path, overrides or (), changes, variant), path))
    can_take_results(folder)
    if schedule is None:
        clear(folder / FOLDER)
    simulation.on_hang = _leaving(folder, figures, quiet)
    with _watched(simulation, quiet) as on_step:
        result = simulation.run(on_step, schedule)
    _report(result, folder, figures, quiet)


@app.command()
def resume(
    directory: Annotated[Path, typer.Argument(help="Folder of a run made with --checkpoint-every.")],
    stop_time: Annotated[float | None, typer.Option(help="s; instead of the run's.")] = None,
    figures: Figures = True,
    quiet: Quiet = False,
) -> None:
    """Go on from a run's newest checkpoint, to the files the uninterrupted run would have written."""
    from orchestrator.checkpoint.checkpoint import newest
    from orchestrator.checkpoint.schedule import Schedule
    from orchestrator.simulation import Simulation

    checkpoint = newest(directory, stop_time)
    for note in checkpoint.notes:
        _complain("warning", note)
    simulation = Simulation(checkpoint.blueprint)
    simulation.on_hang = _leaving(directory, figures, quiet)
    with _watched(simulation, quiet) as on_step:
        result = simulation.resume(checkpoint.snapshot, on_step, Schedule.continued(directory, checkpoint))
    _report(result, directory, figures, quiet)


def _report(result: RunResult, folder: Path, figures: bool, quiet: bool) -> None:
    """Write the results, tell of them, and end with the exit code they deserve."""
    from orchestrator import results
    from orchestrator.simulation import fault

    try:
        with _uninterrupted():
            summary = results.write(result, folder, figures)
    except OSError as failed:
        raise RunError(f"{folder}: the results cannot be written ({failed}); make room, or give another --out") from None
    if not quiet:
        Console().print(results.terminal_table(summary))
    for warning in result.warnings:
        _complain("warning", warning)
    if result.interrupted:
        _complain("interrupted", result.message)
        raise typer.Exit(EXIT_INTERRUPTED)
    error = fault(result)
    if error is not None:
        raise error


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """A Ctrl-C while files are written would leave some of this run beside some of an earlier one."""
    if current_thread() is not main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, lambda *_: _complain("interrupted", "the results are being written, which ends by itself"))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _leaving(folder: Path, figures: bool, quiet: bool) -> Callable[[RunResult], None]:
    """For a unit that hangs: report from the watchdog's thread and leave, since nobody else will come back to do it."""

    def leave(result: RunResult) -> None:
        try:
            _report(result, folder, figures, quiet)
        except OrchestratorError as error:
            _complain("error", str(error))
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(RunError.exit_code)

    return leave


@app.command()
def show(scenario: ScenarioName, overrides: Overrides = None, variant: Variant = "") -> None:
    """Show units, ports, connections and parameters without running anything."""
    from orchestrator.blueprint import draw_up, read_scenario
    from orchestrator.scenario.show import overview

    path = find_scenario(scenario)
    console = Console()
    for part in overview(draw_up(read_scenario(path, overrides or (), variant=variant), path)):
        console.print(part)


app.command()(check)
app.command(context_settings={"ignore_unknown_options": True})(host_env)
app.command()(diagnose)
app.command()(distinguish)
app.command()(export)
app.command()(campaign)
app.command()(doghouse)
app.command()(sensitivity)


@app.command("list")
def list_scenarios() -> None:
    """List the scenarios in scenarios/ with their titles."""
    folder = scenario_folder()
    if folder is None:
        _complain("list", "no folder `scenarios` here or above; change to the project's folder")
        raise typer.Exit(2)
    for path in all_scenarios():
        try:
            tree = read_table(path)
            title = str(tree.get("title", ""))
        except OrchestratorError as error:
            tree, title = {}, f"(cannot be read: {error})"
        if tree and "units" not in tree:      # data beside the scenarios
            continue
        typer.echo(f"{path.relative_to(folder).with_suffix('').as_posix():32} {title}")


def main() -> None:
    """Entry point: one line for what the user can mend, a traceback only for a bug.

    Leaves by os._exit, because a Python runtime embedded in a unit may crash while the interpreter is taken down, after correct results.
    """
    code = 0
    try:
        code = app(standalone_mode=False) or 0
    except OrchestratorError as error:
        _complain("error", str(error))
        code = error.exit_code
    except typer.Exit as leaving:
        code = leaving.exit_code
    except (KeyboardInterrupt, typer.Abort):
        _complain("interrupted", "nothing was computed")
        code = EXIT_INTERRUPTED
    except Exception as error:
        if not hasattr(error, "format_message"):      # click's errors about options know how to say it
            sys.excepthook(type(error), error, error.__traceback__)
            code = 1
        else:
            _complain("error", error.format_message())
            code = 2
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def _complain(kind: str, message: str) -> None:
    typer.echo(f"{kind}: {message}", err=True)


@contextmanager
def _watched(simulation: Simulation, quiet: bool) -> Iterator[Any]:
    blueprint = simulation.blueprint
    table = blueprint.scenario.table
    title = table.title or (blueprint.path.stem if blueprint.path else "scenario")
    with _interruptible(simulation), _progress(title, table.start_time, table.stop_time, quiet) as on_step:
        yield on_step


@contextmanager
def _interruptible(simulation: Simulation) -> Iterator[None]:
    """The first Ctrl-C ends the run after the present step: raised inside a unit, it would be that unit's fatal error."""

    def stop(*_: object) -> None:
        simulation.stop()
        signal.signal(signal.SIGINT, before)

    before = signal.signal(signal.SIGINT, stop)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _progress(title: str, start: float, stop: float, quiet: bool) -> Iterator[Any]:
    """A bar on a terminal (stderr), nothing in a pipe."""
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield None
        return
    from time import monotonic

    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    reached = TextColumn("{task.completed:.3f} of {task.total:.3f} s")
    with Progress(TextColumn("{task.description}"), BarColumn(), reached, TimeRemainingColumn(), console=console, transient=True) as bar:
        task = bar.add_task(title, total=stop - start)
        shown = 0.0

        def on_step(time: float) -> None:
            nonlocal shown
            if monotonic() - shown > 0.1:
                shown = monotonic()
                bar.update(task, completed=time - start)

        yield on_step

