"""Dense linear solve for the small systems of the implicit steps; the same operations compiled and in plain Python."""

import numpy as np
from numpy.typing import NDArray

from .compiled import jit
from .vectors import Matrix

Array = NDArray[np.float64]


@jit
def solve_many(a: Array, b: Array) -> bool:
    """Solve a x = b by elimination with partial pivoting; x replaces b, a is destroyed. False where a is singular.

    a: (n, n), b: (n, m)
    """
    n, m = b.shape
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(a[i, k]) > abs(a[pivot, k]):
                pivot = i
        if a[pivot, k] == 0.0:
            return False
        if pivot != k:
            for j in range(k, n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
            for j in range(m):
                b[k, j], b[pivot, j] = b[pivot, j], b[k, j]
        for i in range(k + 1, n):
            factor = a[i, k] / a[k, k]
            if factor != 0.0:
                for j in range(k + 1, n):
                    a[i, j] -= factor * a[k, j]
                for j in range(m):
                    b[i, j] -= factor * b[k, j]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            for c in range(m):
                b[k, c] -= a[k, j] * b[j, c]
        for c in range(m):
            b[k, c] /= a[k, k]
    return True


@jit
def put(a: Array, row: int, column: int, block: Matrix) -> None:
    """Add a 3x3 block to a at (row, column)."""
    for i in range(3):
        for j in range(3):
            a[row + i, column + j] += block[i][j]
