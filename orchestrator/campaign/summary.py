"""What a person reads after a campaign."""

from __future__ import annotations

import pyarrow as pa
import pyarrow.compute as pc
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from orchestrator.campaign.campaign import Campaign, Cost
from orchestrator.campaign.data_set import INDEX, VERDICT
from orchestrator.campaign.outputs import NOT_FLOWN

SHOWN = 16
"""Outputs; the file has all."""


def terminal_summary(plan: Campaign, rows: pa.Table, cost: Cost) -> RenderableType:
    """How they ended, how the outputs are spread, what it cost."""
    parts: list[RenderableType] = [Text(plan.table.title or plan.where, style="bold"), Text(_outcomes(rows))]
    outputs = [name for name in rows.column_names if name not in (*plan.inputs.column_names, *VERDICT)]
    spread = [name for name in outputs if _is_spread(rows[name])]
    if spread:
        parts.append(_spread(rows, spread[:SHOWN]))
    if len(spread) > SHOWN:
        parts.append(Text(f"and {len(spread) - SHOWN} more outputs in the file", style="dim"))
    failed = rows.filter(pc.equal(rows["outcome"], NOT_FLOWN))
    if failed.num_rows:
        first = failed.slice(0, 1).to_pylist()[0]
        parts.append(Text(f"{failed.num_rows} not flown; the first: landing {first[INDEX]}: {first['error']}", style="red"))
    untrusted = rows.num_rows - failed.num_rows - sum(filter(None, rows["trusted"].to_pylist()))
    if untrusted:
        parts.append(Text(f"{untrusted} flown and not trusted: see `error` in their rows", style="yellow"))
    if cost.landings:
        rate = f"{60.0 * cost.landings / cost.seconds:.0f} a minute, {cost.lost:.1%} of the workers' time outside landings"
        parts.append(Text(f"{cost.landings} landings in {cost.seconds:.1f} s, {rate}"))
    return Group(*parts)


def _outcomes(rows: pa.Table) -> str:
    counts = rows.group_by("outcome").aggregate([("outcome", "count")]).to_pylist()
    ranked = sorted(counts, key=lambda row: -int(row["outcome_count"]))
    return f"{rows.num_rows} landings: " + ", ".join(f"{row['outcome_count']} {row['outcome']}" for row in ranked)


def _is_spread(column: pa.ChunkedArray) -> bool:
    if not pa.types.is_floating(column.type):
        return False
    ends = pc.min_max(column).as_py()
    return ends["min"] is not None and ends["min"] != ends["max"]


def _spread(rows: pa.Table, names: list[str]) -> Table:
    table = Table(box=None, header_style="bold", pad_edge=False, padding=(0, 2, 0, 0))
    for heading in ("output", "least", "5 %", "median", "95 %", "greatest"):
        table.add_column(heading, justify="left" if heading == "output" else "right")
    for name in names:
        values = pc.quantile(rows[name], q=[0.0, 0.05, 0.5, 0.95, 1.0]).to_pylist()
        table.add_row(name, *(f"{value:.4g}" for value in values))
    return table
