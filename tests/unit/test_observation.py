"""From a landing's course to a white residual."""

import numpy as np
import pytest

from orchestrator.diagnosis.landing import Course
from orchestrator.diagnosis.observation import EDGE, Observation, Reading

COURSE = Course(np.array([0.0, 1.0]), {}, {"skid": 0.2})


def missed(low: float, high: float) -> float:
    one = Observation([], [Reading("skid.+Y", "skid", np.nan, 1.0, low, high, True)])
    return float(one.residual(one.predicted(COURSE, {}))[0])


def test_an_interval_counts_outside_its_ends_only() -> None:
    assert missed(0.1, 0.3) == 0.0
    assert missed(0.0, 0.1) == pytest.approx(-0.1 / (EDGE * 0.1))
    assert missed(0.3, 0.5) == pytest.approx(0.1 / (EDGE * 0.2))


def test_an_interval_open_to_one_side_counts_too() -> None:
    assert missed(-np.inf, 0.1) == pytest.approx(-0.1 / (EDGE * 0.1))
    assert missed(0.3, np.inf) == pytest.approx(0.1 / (EDGE * 0.3))
    assert missed(0.1, np.inf) == 0.0
