"""`orchestrator check`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from orchestrator.output_folder import can_take_results

_WIDE = 160
"""Columns where the output is no terminal: a finding stays on few lines."""


def check(
    fmu: Annotated[Path, typer.Argument(help="The FMU to check.")],
    kind: Annotated[
        str | None,
        typer.Option("--as", help="Kind of unit it is to stand in for, as GearLeg or GuidanceControl; without it, guessed from its ports."),
    ] = None,
    overrides: Annotated[list[str] | None, typer.Option("--set", help="parameter=value to try it with; may be repeated.")] = None,
    only: Annotated[list[str] | None, typer.Option(help="Try this alone, as rollback or \"bad input\"; may be repeated.")] = None,
    json_file: Annotated[Path | None, typer.Option("--json", help="File to write the findings to as well.")] = None,
    timeout: Annotated[float, typer.Option(help="s without a sign of life after which it is taken to hang.")] = 120.0,
    quiet: Annotated[bool, typer.Option("--quiet", help="Only what failed, in one line.")] = False,
) -> None:
    """Hold an FMU against the port contract: what it states, and what it does when it is driven.

    Names, causality, units of measure and frames; feedthrough, determinism, step size, rollback, serialisation, bad input. Each trial
    runs in a process of its own, so that a unit that crashes or hangs is named and takes nothing down. Exit code 0: nothing failed
    (warnings may stand); 2: something failed.
    """
    from orchestrator.check.check import checked
    from orchestrator.check.report import as_json, complaint, table
    from orchestrator.check.values import given_values
    from orchestrator.errors import UnitError
    from orchestrator.fmi.description import read_interface

    if not fmu.is_file():
        raise UnitError(f"{fmu}: no such file; give the path of an FMU")
    if json_file is not None:
        can_take_results(json_file.parent, "--json")
    values = given_values(read_interface(fmu), fmu.stem, overrides or ())
    terminal = Console(stderr=True)
    with terminal.status("reading", spinner="dots") if terminal.is_terminal and not quiet else _Silence() as status:
        result = checked(fmu, kind, values, timeout, lambda what: status.update(f"{fmu.name}: {what}"), only or ())
    if json_file is not None:
        json_file.write_text(json.dumps(as_json(result), indent=1, ensure_ascii=False) + "\n", "utf-8")
    if not quiet:
        console = Console()
        Console(width=None if console.is_terminal else _WIDE).print(table(result))
    if result.failed:
        raise UnitError(complaint(result))


class _Silence:
    """In place of a spinner where nobody looks."""

    def __enter__(self) -> _Silence:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def update(self, _: str) -> None:
        pass
