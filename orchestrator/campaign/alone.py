"""One landing of a campaign flown by itself: the same bits, and all the files of a run."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import Any

import pyarrow.compute as pc
import typer
from rich.console import Console

from orchestrator.campaign.campaign import Campaign
from orchestrator.campaign.data_set import COST, INDEX, kept_landings
from orchestrator.campaign.landing import blueprint
from orchestrator.campaign.outputs import flat, outcome
from orchestrator.errors import RunError, UserError
from orchestrator.simulation import Simulation, fault


def fly_alone(plan: Campaign, folder: Path, index: int, quiet: bool = False) -> None:
    """Written to FOLDER/landing-INDEX; an error when the row that is kept says otherwise."""
    from orchestrator import results

    if not 0 <= index < plan.inputs.num_rows:
        raise UserError(f"--only {index}: the campaign has landings 0 to {plan.inputs.num_rows - 1}; give one of them")
    its = plan.overrides(index)
    if not quiet:
        typer.echo(f"orchestrator run {folder / 'scenario.toml'} " + " ".join(f"--set {shlex.quote(one)}" for one in its))
    simulation = Simulation(blueprint(plan.base, its))
    result = simulation.run()
    simulation.close()
    summary = results.write(result, folder / f"landing-{index}")
    if not quiet:
        Console().print(results.terminal_table(summary))
    error = fault(result)
    if error is not None:
        raise error
    kept = kept_row(folder, index)
    if kept is None:
        return
    now = {"outcome": outcome(summary), **flat(summary)}
    other = [name for name, value in kept.items() if name in now and now[name] != value]
    if other:
        differs = f"{other[0]} is {now[other[0]]!r}, the campaign kept {kept[other[0]]!r}"
        raise RunError(f"{folder}: landing {index}: {differs}; FMUs or versions have changed, fly the campaign again")
    if not quiet:
        typer.echo(f"landing {index}: the same as the campaign's in all {sum(name in now for name in kept)} outputs, to the last bit")


def kept_row(folder: Path, index: int) -> dict[str, Any] | None:
    """What the campaign has of it, so far as it has got."""
    if not (folder / "campaign.json").is_file():
        return None
    rows = kept_landings(folder)
    row = rows.filter(pc.equal(rows[INDEX], index)).to_pylist()
    return {name: value for name, value in row[0].items() if name not in (INDEX, *COST)} if row else None
