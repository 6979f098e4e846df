"""The recorded columns and the solver log as files that other tools read."""

import csv
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from orchestrator.master.result import Attempt, RunResult


def write_csv(result: RunResult, path: Path) -> Path:
    """RFC 4180 with a header `time,unit.variable,...`: every digit of every double, Booleans as 0 and 1, time in s.

    FMPy's `read_csv`, spreadsheets and pandas read it. Units of measure are in the Parquet file.
    """
    table = np.column_stack([result.times, *result.columns.values()]) if result.columns else result.times[:, None]
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(["time", *result.columns])
        rows.writerows(np.asarray(table, dtype=np.float64).tolist())
    return path


def write_parquet(result: RunResult, path: Path) -> Path:
    """The same columns bit for bit, with `unit` and `description` in each column's metadata."""
    fields = [pa.field("time", pa.float64(), metadata={"unit": "s", "description": "simulated time"})]
    for name in result.columns:
        about = {"unit": result.units.get(name, ""), "description": result.descriptions.get(name, "")}
        fields.append(pa.field(name, pa.float64(), metadata=about))
    arrays = [pa.array(np.asarray(column, dtype=np.float64)) for column in (result.times, *result.columns.values())]
    schema = pa.schema(fields, metadata={"title": result.title, "complete": str(result.complete).lower()})
    pq.write_table(pa.Table.from_arrays(arrays, schema=schema), path)
    return path


def write_solver_log(log: list[Attempt], path: Path) -> Path:
    """One row an attempted interval: start and length in s, passes, error estimate in m, accepted (1 or 0), what limited it."""
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(Attempt._fields)
        rows.writerows([*row[:4], int(row.accepted), row.limit] for row in log)
    return path
