"""Coordinates: how one number moves the twin's variables."""

from math import exp, inf

import numpy as np
import pytest

from orchestrator.diagnosis.coordinates import Coordinate, Operation, applied, clipped


@pytest.mark.parametrize(("operation", "value"), [("add", 10.0 + 2.0 * 0.6), ("scale", 10.0 * exp(2.0 * 0.6)), ("set", 2.0 * 0.6)])
def test_an_operation_moves_its_variable_by_the_scaled_number(operation: Operation, value: float) -> None:
    one = Coordinate("c", (("x", 2.0),), sigma=0.3, mean=0.3, operation=operation)
    assert applied({"x": 10.0}, [one], np.array([1.0]), 0)["x"] == pytest.approx(value)


def test_effects_act_on_top_of_nuisances_in_the_order_given() -> None:
    nuisance, effect = Coordinate("n", (("x", 1.0),), 1.0), Coordinate("e", (("x", 1.0),), 1.0, operation="scale")
    z = np.array([2.0, 1.0])
    assert applied({"x": 3.0}, [nuisance, effect], z, 0)["x"] == pytest.approx(5.0 * exp(1.0))
    assert applied({"x": 3.0}, [effect, nuisance], z[::-1], 0)["x"] == pytest.approx(3.0 * exp(1.0) + 2.0)


def test_one_number_moves_several_variables_each_by_its_factor() -> None:
    one = Coordinate("c", (("x", 1.0), ("y", -0.5)), 2.0)
    assert applied({"x": 1.0}, [one], np.array([3.0]), 0) == {"x": 7.0, "y": -3.0}


def test_a_coordinate_of_one_landing_leaves_the_others_alone() -> None:
    own = Coordinate("c", (("x", 1.0),), 1.0, landing=1)
    assert applied({"x": 0.0}, [own], np.array([1.0]), 0) == {}
    assert applied({"x": 0.0}, [own], np.array([1.0]), 1) == {"x": 1.0}


def test_what_is_fixed_goes_along_even_where_the_effect_is_null() -> None:
    one = Coordinate("c", (("x", 1.0),), 1.0, fixed=(("phase", 2.0),))
    assert applied({}, [one], np.array([0.0]), 0) == {"x": 0.0, "phase": 2.0}


def test_limits_hold_the_value_and_bound_its_scaled_number() -> None:
    one = Coordinate("c", (("x", 1.0),), 0.5, mean=1.0, low=0.0, high=2.0)
    assert one.bounds == (-2.0, 2.0)
    assert (one.value(-9.0), one.value(9.0)) == (0.0, 2.0)
    np.testing.assert_array_equal(clipped([one, one], np.array([-9.0, 1.0])), [-2.0, 1.0])


def test_a_half_normal_coordinate_starts_at_its_null() -> None:
    one = Coordinate("c", (("x", 1.0),), 0.5, positive=True)
    assert one.bounds == (0.0, inf)
    np.testing.assert_array_equal(clipped([one], np.array([-1.0])), [0.0])
