"""What a connection does to the numbers it carries, as one linear map: units of measure, frame, scale and offset.

    target = scale · frame · (source in the target's unit of measure) + offset
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.errors import WiringError
from orchestrator.master.slave import Variable
from orchestrator.scenario.model import Numbers, Rows

Matrix = NDArray[np.float64]
_FACTOR, _OFFSET = 8, 9
"""Where they stand in Variable.dimension."""
_SAME = 1e-6
"""Relative difference of two factors below which units of one name are one unit."""
_TURNED = "a vector of 3, a matrix of 9 by rows, or a quaternion of 4"


@dataclass(frozen=True)
class Alteration:
    """As the scenario asks for it; None: as it is."""

    frame: tuple[tuple[float, ...], ...] | None = None
    scale: tuple[float, ...] | None = None
    offset: tuple[float, ...] | None = None

    @classmethod
    def of(cls, frame: Rows | None, scale: Numbers | None, offset: Numbers | None) -> Alteration:
        """From a scenario's keys."""
        return cls(None if frame is None else tuple(tuple(row) for row in frame), _tuple(scale), _tuple(offset))

    def as_run(self) -> dict[str, Any]:
        """As a scenario's keys."""
        keys = {"frame": self.frame and [list(row) for row in self.frame], "scale": self.scale, "offset": self.offset}
        return {key: list(value) if isinstance(value, tuple) else value for key, value in keys.items() if value is not None}

    @property
    def nothing(self) -> bool:
        return self.frame is None and self.scale is None and self.offset is None

    @property
    def mirrors(self) -> bool:
        return self.frame is not None and float(np.linalg.det(np.array(self.frame))) < 0.0

    def back(self) -> Alteration:
        """The way back, of a frame alone."""
        return self if self.frame is None else Alteration(tuple(zip(*self.frame, strict=True)))


AS_IT_IS = Alteration()


@dataclass(frozen=True)
class LinearMap:
    weights: Matrix
    """Rows: target's elements."""
    offset: NDArray[np.float64]

    @property
    def identical(self) -> bool:
        return bool(np.array_equal(self.weights, np.eye(len(self.offset))) and not self.offset.any())


def unit_conversion(one: Variable, other: Variable) -> tuple[float, float] | None:
    """(factor, offset) from one variable's unit of measure to the other's; None where they measure different things.

    By base-unit exponents where both define them, else by name. An undeclared unit fits anything.
    """
    if not one.unit or not other.unit:
        return 1.0, 0.0
    if one.dimension is None or other.dimension is None:
        return (1.0, 0.0) if one.unit == other.unit else None
    if one.dimension[:_FACTOR] != other.dimension[:_FACTOR]:
        return None
    factor = one.dimension[_FACTOR] / other.dimension[_FACTOR]
    offset = (one.dimension[_OFFSET] - other.dimension[_OFFSET]) / other.dimension[_FACTOR]
    if one.unit == other.unit and abs(factor - 1.0) < _SAME and abs(offset) < _SAME:
        return 1.0, 0.0
    return factor, offset


def linear_map(given: Sequence[Variable], taken: Sequence[Variable], asked: Alteration, label: str) -> LinearMap:
    """The whole of it, or a WiringError."""
    frame = np.eye(len(given)) if asked.frame is None else turning(asked, given, label)
    if len(given) != len(taken):
        raise WiringError(f"{label}: sends {len(given)} elements, expects {len(taken)}; connect vectors of one length")
    scale = _for_each(asked.scale, 1.0, len(taken), "scale", label)
    weights, offsets = frame.copy(), np.zeros(len(taken))
    for row, column in zip(*np.nonzero(frame), strict=True):
        found = unit_conversion(given[column], taken[row])
        if found is None:
            sends, expects = given[column].unit, taken[row].unit
            raise WiringError(f"{label}: sends {sends}, expects {expects}; connect variables that measure the same, or correct the unit")
        weights[row, column] *= found[0]
        offsets[row] += frame[row, column] * found[1]
    added = _for_each(asked.offset, 0.0, len(taken), "offset", label)
    return LinearMap(scale[:, None] * weights, scale * offsets + added)


def turning(asked: Alteration, given: Sequence[Variable], label: str) -> Matrix:
    """The frame's matrix as it acts on this many elements."""
    matrix = np.array(asked.frame, dtype=np.float64)
    if len(given) == 3:
        return matrix
    if len(given) == 9:
        return np.asarray(np.kron(matrix, matrix), dtype=np.float64)
    if len(given) == 4 and given[0].name.partition("[")[0].endswith("quaternion"):
        if asked.mirrors:
            raise WiringError(f"{label}: frame mirrors (its determinant is -1), which no quaternion can; give a rotation")
        return _quaternion_product(matrix)
    raise WiringError(f"{label}: frame turns {_TURNED}, this has {len(given)} elements; connect it by itself, with scale where needed")


def _quaternion_product(matrix: Matrix) -> Matrix:
    """q' = r q for quaternions (w, x, y, z), r the rotation's: an attitude given towards the other frame."""
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(matrix).as_quat()
    return np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])


def _tuple(numbers: Numbers | None) -> tuple[float, ...] | None:
    return None if numbers is None else tuple(numbers) if isinstance(numbers, list) else (numbers,)


def _for_each(values: tuple[float, ...] | None, default: float, count: int, what: str, label: str) -> NDArray[np.float64]:
    if values is None:
        return np.full(count, default)
    if len(values) not in (1, count):
        raise WiringError(f"{label}: {what} has {len(values)} numbers, expects 1 or {count}; give one for all or one for each element")
    return np.array(values * (count // len(values)), dtype=np.float64)
