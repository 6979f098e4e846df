"""`orchestrator export`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from orchestrator.errors import SspError
from orchestrator.scenario.locate import find_scenario


def export(
    scenario: Annotated[str, typer.Argument(help="A scenario file, or the bare name of one in scenarios/.")],
    ssp: Annotated[Path, typer.Option("--ssp", help="The file to write.")],
    variants: Annotated[
        list[str] | None,
        typer.Option("--variant", help="NAME=overlay.toml: a second system in the same file, the overlay laid over; may be repeated."),
    ] = None,
    outputs: Annotated[
        list[str] | None,
        typer.Option("--output", help='Outputs that other tools shall see though nothing takes them, "leg*.*.stroke"; may be repeated.'),
    ] = None,
    step: Annotated[
        float | None, typer.Option(help="s; fixed step that hosts are told to take; by itself the smallest interval.")
    ] = None,
    overrides: Annotated[list[str] | None, typer.Option("--set", help="unit.parameter=value; may be repeated.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="Say nothing.")] = False,
) -> None:
    """Write a scenario as an .ssp, the standard's file for a system of FMUs; `orchestrator run FILE.ssp` gives the same bits."""
    from orchestrator.ssp.export import export as write

    path = find_scenario(scenario)
    if ssp.suffix != ".ssp":
        raise SspError(f"--ssp {ssp}: expects a file that ends in .ssp; call it {ssp.stem}.ssp")
    if step is not None and not step > 0.0:
        raise SspError(f"--step {step:g}: is not positive, expects s; give 1e-4 or so")
    names = write(path, ssp, overrides or (), dict(_named(text) for text in variants or ()), outputs or (), step)
    if not quiet:
        typer.echo(f"{ssp}: {', '.join(names)}; {ssp.stat().st_size / 1e6:.1f} MB")


def _named(text: str) -> tuple[str, Path]:
    name, equals, overlay = text.partition("=")
    if not (name and equals and overlay):
        raise SspError(f"--variant {text}: expects NAME=overlay.toml")
    return name, find_scenario(overlay)
