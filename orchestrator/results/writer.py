"""The run directory: data first, then what follows from it, then pictures, so that a failure late loses little."""

import json
import shutil
from pathlib import Path
from typing import Any

from orchestrator.errors import ScenarioError
from orchestrator.master.result import RunResult
from orchestrator.results import comparison, cost, history, provenance, references
from orchestrator.results.channels import Channels
from orchestrator.results.energy import EnergyAccount, account_of
from orchestrator.results.failure import failure
from orchestrator.results.generic import generic, report
from orchestrator.results.schema import ResultsTable, read
from orchestrator.results.touchdown import touchdown


def write(result: RunResult, out: Path, figures: bool = True) -> dict[str, Any]:
    """Write everything the run has, complete or not, into `out` and return what summary.json holds."""
    out.mkdir(parents=True, exist_ok=True)
    (out / "summary.json").unlink(missing_ok=True)  # first away, last written: it is never beside another run's rows
    history.write_csv(result, out / "history.csv")
    history.write_parquet(result, out / "history.parquet")
    history.write_solver_log(result.log, out / "solver_log.csv")
    provenance.write_scenario(result, out / "scenario.toml")
    provenance.write_inputs(result, out / "inputs.json")
    table, complaint = _table(result)
    channels = Channels(result.times, result.columns)
    account = account_of(channels, table)
    published = _published(result, table, out)
    summary = summarise(result, channels, table, account, published)
    summary["notes"] += complaint
    summary["directory"] = str(out)
    (out / "summary.json").write_text(json.dumps(summary, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")
    if summary["comparison"] is not None:
        text = comparison.markdown(_title(result), summary, summary["comparison"], published)
        (out / "comparison.md").write_text(text, encoding="utf-8")
    if figures:
        from orchestrator.results.figures import draw  # with matplotlib: half the time of a short run

        draw(_title(result), result, channels, table, account, summary, out / "figures")
    else:
        for old in (out / "figures").glob("*.png"):  # of an earlier run: they show other data
            old.unlink()
    return summary


def summarise(
    result: RunResult, channels: Channels, table: ResultsTable, account: EnergyAccount | None, published: references.References
) -> dict[str, Any]:
    """summary.json, without touching a file. Values in the unit their key ends with; None where a channel is missing."""
    summary: dict[str, Any] = {
        "title": _title(result),
        "kind": table.resolved_kind,
        "complete": result.complete,
        "trusted": result.trusted,
        "interrupted": result.interrupted,
        "message": result.message,
        "warnings": list(result.warnings),
        "notes": [*_reference_notes(table, published), *_clock_notes(table)],
    }
    landing = table.resolved_kind == "touchdown"
    summary |= touchdown(channels, table) if landing else generic(channels, result.units)
    if landing:
        summary["failure"] = failure(channels, table, result.parameters)
    summary["energy"] = None if account is None else account.summary()
    summary["ledger"] = cost.ledger(result.ledger, None if account is None else account.initial)
    summary["master"] = cost.master(result)
    summary["report"] = report(channels, table)
    compared = landing and bool(published.strokes or published.sections)
    summary["comparison"] = comparison.compare(summary, published, table.compare, table.measured) if compared else None
    summary["missing"] = list(channels.missing)
    return summary


def _title(result: RunResult) -> str:
    return result.title or result.name


def _table(result: RunResult) -> tuple[ResultsTable, list[str]]:
    """The `[results]` table; one that cannot be read costs the run nothing but its special summary."""
    try:
        return read(result.results), []
    except ScenarioError as error:
        return ResultsTable(), [str(error)]


def _reference_notes(table: ResultsTable, published: references.References) -> list[str]:
    """A reference file or a column that is not there costs the comparison, not the run."""
    known = sorted({*published.strokes, *published.sections})
    where = f"{table.references or '[paper]'} has {', '.join(known) or 'nothing'}"
    if published.fault:
        return [published.fault]
    return [f"[results]: nothing is published under {name!r}; {where}" for name in published.unknown([table.compare, table.measured])]


def _clock_notes(table: ResultsTable) -> list[str]:
    """What a reader must know before laying measured data over the run."""
    return [f"the clock of {series} reads {offset:+.4g} s: take that off its times" for series, offset in table.clock_offsets.items()]


def _published(result: RunResult, table: ResultsTable, out: Path) -> references.References:
    """The reference file beside or above the scenario, copied into the run directory; else the scenario's own `[paper]` table."""
    path = references.find(table.references, references.folders_of(result.scenario_path))
    if path is None:
        return references.parse(result.paper)
    if path.resolve() != (out / path.name).resolve():
        shutil.copyfile(path, out / path.name)
    return references.load(path)
