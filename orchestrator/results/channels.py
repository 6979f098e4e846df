"""Recorded columns by name, keeping a list of those that were asked for and are not there."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass
class Channels:
    """Columns of a history over `times` in s. Asking for a missing one gives None and puts its name into `missing`."""

    times: Array
    columns: Mapping[str, Array]
    missing: list[str] = field(default_factory=list)

    def series(self, name: str) -> Array | None:
        """The whole column, in the unit it was recorded in."""
        column = self.columns.get(name)
        if column is None or len(column) == 0:
            if name not in self.missing:
                self.missing.append(name)
            return None
        return np.asarray(column, dtype=np.float64)

    def final(self, name: str, scale: float = 1.0) -> float | None:
        """The last value times `scale`; None where there is none or it is not a number."""
        column = self.series(name)
        return None if column is None else finite(column[-1] * scale)

    def span(self, name: str, scale: float = 1.0) -> list[float | None]:
        """[least, greatest] value times `scale`."""
        column = self.series(name)
        if column is None or not np.isfinite(column).any():
            return [None, None]
        known = column[np.isfinite(column)] * scale
        return [float(known.min()), float(known.max())]

    def ending(self, suffix: str) -> list[str]:
        """Names of the columns that end so, as `.energy.kinetic`: one from each unit that has it."""
        return [name for name in self.columns if name.endswith(suffix)]

    def total(self, names: list[str]) -> Array:
        """Sum of columns of one unit of measurement; zeros over the run when none is named."""
        found = [column for name in names if (column := self.series(name)) is not None]
        return np.sum(found, axis=0) if found else np.zeros_like(self.times)


def finite(value: float) -> float | None:
    """A plain float for a JSON file, None in place of NaN and infinities, which JSON has no word for."""
    return float(value) if np.isfinite(value) else None
