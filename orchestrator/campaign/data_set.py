"""Landings on disk: parts as they come, one file in the order of the index at the end.

A part is written whole under another name and then renamed, so a kill leaves whole parts only. Parts are merged now and then; a kill
between merging and deleting leaves a landing in two parts, the same in both, and reading takes one.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from orchestrator.campaign.landing import Landing
from orchestrator.errors import UserError

MERGED_AT = 200
"""Parts."""
INDEX = "index"
VERDICT = {"outcome": pa.string(), "trusted": pa.bool_(), "error": pa.string()}
COST = {"seconds": pa.float64(), "cpu_seconds": pa.float64(), "worker": pa.int64()}
"""Differs from one call to the next, and is kept apart at the end."""
TYPES = {"double": pa.float64(), "bool": pa.bool_(), "string": pa.string(), "int64": pa.int64()}


class DataSet:
    """`landings.parquet` in a folder, or the parts it will be made of."""

    def __init__(self, folder: Path, inputs: pa.Table, outputs: Mapping[str, str]) -> None:
        """inputs: a row a landing, `index` first; outputs: names and types."""
        self.folder, self.inputs, self.outputs = folder, inputs, dict(outputs)
        fields = [*inputs.schema, *(pa.field(name, type_) for name, type_ in (VERDICT | self._types() | COST).items())]
        self.schema = pa.schema(fields)
        self.parts = folder / "parts"
        self.whole = folder / "landings.parquet"

    def _types(self) -> dict[str, Any]:
        return {name: TYPES[kind] for name, kind in self.outputs.items()}

    def begin(self) -> set[int]:
        """Indices of the landings that are kept already."""
        if self.whole.is_file():
            return set(pq.read_table(self.whole, columns=[INDEX])[INDEX].to_pylist())
        self.parts.mkdir(parents=True, exist_ok=True)
        for unfinished in (*self.parts.glob("*.unfinished"), *(part for part in self.parts.glob("*.parquet") if not _is_whole(part))):
            unfinished.unlink()
        if len(list(self.parts.glob("*.parquet"))) > 1:
            self._merge()
        return {index for part in self._kept() for index in part[INDEX].to_pylist()}

    def add(self, landings: Iterable[tuple[int, Landing]]) -> None:
        """Written before it returns."""
        rows = [self._row(index, landing) for index, landing in landings]
        if rows:
            self._write(pa.Table.from_pylist(rows, self.schema), self.parts / f"{self._next():06d}.parquet")
        if len(list(self.parts.glob("*.parquet"))) >= MERGED_AT:
            self._merge()

    def finish(self) -> pa.Table:
        """All in the order of the index; what it cost goes into a file of its own."""
        if not self.whole.is_file():
            table = self._in_order()
            self._write(table.select([INDEX, *COST]), self.folder / "cost.parquet")
            self._write(table.drop_columns(list(COST)), self.whole)
            for part in self.parts.glob("*.parquet"):
                part.unlink()
            self.parts.rmdir()
        return pq.read_table(self.whole)

    def _row(self, index: int, landing: Landing) -> dict[str, Any]:
        given: dict[str, Any] = self.inputs.slice(index, 1).to_pylist()[0]
        found = {name: landing.outputs.get(name) for name in self.outputs}
        verdict = {"outcome": landing.outcome, "trusted": landing.trusted, "error": landing.error}
        return given | verdict | found | {"seconds": landing.seconds, "cpu_seconds": landing.cpu_seconds, "worker": landing.worker}

    def _kept(self) -> list[pa.Table]:
        return [pq.read_table(part, schema=self.schema) for part in sorted(self.parts.glob("*.parquet"))]

    def _next(self) -> int:
        return 1 + max((int(part.stem) for part in self.parts.glob("*.parquet")), default=0)

    def _merge(self) -> None:
        old = sorted(self.parts.glob("*.parquet"))
        self._write(self._in_order(), self.parts / f"{self._next():06d}.parquet")
        for part in old:
            part.unlink()

    def _in_order(self) -> pa.Table:
        return in_order(pa.concat_tables(self._kept() or [self.schema.empty_table()]))

    def _write(self, table: pa.Table, path: Path) -> None:
        unfinished = path.with_suffix(".unfinished")
        one = table.num_rows == 1                          # a dictionary of one value is not worth its making
        pq.write_table(table, unfinished, compression="zstd", use_dictionary=not one, write_statistics=not one)
        with unfinished.open("rb") as file:
            os.fsync(file.fileno())                        # a power cut must not leave the name without the content
        unfinished.replace(path)


def _is_whole(part: Path) -> bool:
    """Whether it can be read: a machine that went down may leave one that cannot; its landings are flown again."""
    try:
        pq.read_metadata(part)
    except (pa.ArrowInvalid, OSError):
        return False
    return True


def kept_landings(folder: Path) -> pa.Table:
    """What a campaign's folder has so far, in the order of the index, each once; whether finished or not."""
    whole = folder / "landings.parquet"
    parts = [pq.read_table(path) for path in ([whole] if whole.is_file() else sorted((folder / "parts").glob("*.parquet")))]
    if not parts:
        raise UserError(f"{folder}: has no landings yet; fly the campaign first: orchestrator campaign {folder}")
    return in_order(pa.concat_tables(parts))


def in_order(table: pa.Table) -> pa.Table:
    """By index, each once."""
    first = {index: row for row, index in reversed(list(enumerate(table[INDEX].to_pylist())))}
    return table.take([first[index] for index in sorted(first)]).combine_chunks()


def as_table(columns: Mapping[str, Sequence[Any]]) -> pa.Table:
    """Inputs with their index before them."""
    count = len(next(iter(columns.values())))
    return pa.table({INDEX: pa.array(range(count), pa.int64()), **{name: _array(column) for name, column in columns.items()}})


def _array(column: Sequence[Any]) -> pa.Array:
    numbers = all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in column)
    return pa.array([float(value) for value in column] if numbers and any(isinstance(v, float) for v in column) else column)


def type_of(value: object) -> str:
    """Of an output; one that nobody has measured in the base landing is taken for a number."""
    return "bool" if isinstance(value, bool) else "string" if isinstance(value, str) else "double"
