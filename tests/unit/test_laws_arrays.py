"""The small dense solver and the packing of records into arrays, on which the implicit laws stand."""

import numpy as np
import pytest
from lander.laws.blocks import matrix, put_matrix, put_quaternion, put_vector, quaternion, vector
from lander.laws.linear import put, solve_many


@pytest.mark.parametrize(("size", "columns"), [(1, 1), (3, 2), (6, 7)])
def test_the_solver_agrees_with_numpy(size: int, columns: int) -> None:
    """Random systems; 1e-10 is their condition's share of the last digit."""
    random = np.random.default_rng(size)
    a, b = random.normal(size=(size, size)), random.normal(size=(size, columns))
    x = b.copy()
    assert solve_many(a.copy(), x)
    np.testing.assert_allclose(x, np.linalg.solve(a, b), rtol=1e-10, atol=1e-12)


def test_the_solver_pivots_and_tells_a_singular_system() -> None:
    x = np.array([[2.0], [3.0]])
    assert solve_many(np.array([[0.0, 1.0], [1.0, 0.0]]), x)
    assert x.ravel().tolist() == [3.0, 2.0]
    assert not solve_many(np.array([[1.0, 2.0], [2.0, 4.0]]), np.array([[1.0], [1.0]]))


def test_blocks_are_added_where_they_belong() -> None:
    a = np.ones((6, 6))
    put(a, 3, 0, ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)))
    assert a[3:, :3].ravel().tolist() == [2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]
    assert a[:3].sum() + a[3:, 3:].sum() == 27.0


def test_records_come_back_from_arrays_as_they_went_in() -> None:
    a = np.zeros(20)
    rows = ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0))
    put_vector(a, 0, (1.0, 2.0, 3.0))
    put_quaternion(a, 3, (0.5, -0.5, 0.5, -0.5))
    put_matrix(a, 8, rows)
    assert vector(a, 0) == (1.0, 2.0, 3.0)
    assert quaternion(a, 3) == (0.5, -0.5, 0.5, -0.5)
    assert matrix(a, 8) == rows
    assert a[7] == a[17:].sum() == 0.0
