"""Vectors, quaternions and matrices in and out of flat arrays: how a unit's memory becomes the laws' tuples."""

import numpy as np
from numpy.typing import NDArray

from .compiled import jit
from .vectors import Matrix, Quaternion, Vector

Array = NDArray[np.float64]


@jit
def vector(a: Array, i: int) -> Vector:
    """a[i:i+3]."""
    return (a[i], a[i + 1], a[i + 2])


@jit
def quaternion(a: Array, i: int) -> Quaternion:
    """a[i:i+4]."""
    return (a[i], a[i + 1], a[i + 2], a[i + 3])


@jit
def matrix(a: Array, i: int) -> Matrix:
    """a[i:i+9], by rows."""
    return (vector(a, i), vector(a, i + 3), vector(a, i + 6))


@jit
def put_vector(a: Array, i: int, x: Vector) -> None:
    """a[i:i+3] = x."""
    a[i], a[i + 1], a[i + 2] = x[0], x[1], x[2]


@jit
def put_quaternion(a: Array, i: int, q: Quaternion) -> None:
    """a[i:i+4] = q."""
    a[i], a[i + 1], a[i + 2], a[i + 3] = q[0], q[1], q[2], q[3]


@jit
def put_matrix(a: Array, i: int, m: Matrix) -> None:
    """a[i:i+9] = m, by rows."""
    put_vector(a, i, m[0])
    put_vector(a, i + 3, m[1])
    put_vector(a, i + 6, m[2])
