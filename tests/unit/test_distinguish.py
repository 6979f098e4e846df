"""What data could tell apart, on a vehicle that is three straight lines: every cosine can be worked out on paper."""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.distinguish import distinction, fly
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.landing import ATTITUDE, Course
from orchestrator.diagnosis.likeness import Flown, cosines, groups, just_shows, signature
from orchestrator.diagnosis.more_sensors import Equipped, Sensor, equipped
from orchestrator.diagnosis.observation import Observation, Reading, Track
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.report import Distinction

TIMES = np.linspace(0.05, 1.0, 20)
SIGMA = 0.01
PITCH, ROLL = ATTITUDE[1:]
LOAD = Sensor("load", ("leg1.primary.load",), 1.0, "N", 50.0)
DEPTH = Sensor("depth at rest", ("soil1.penetration",), 0.002, "m")


class Lines:
    """Pitch takes up offset + (first + second) t, roll third t; the second alone shows in the strut's load; late does nothing alone."""

    varies = False

    def land(
        self, values: Mapping[str, float], grid: Any, columns: Sequence[str], final: Sequence[str], beside: object = None
    ) -> Course:
        v = {"offset": 0.0, "first": 0.0, "second": 0.0, "third": 0.0, "late": 0.0, **values}
        known = {
            PITCH: v["offset"] + (v["first"] + v["second"]) * grid,
            ROLL: v["third"] * np.maximum(grid - v["late"], 0.0),
            "leg1.primary.load": 1e3 * v["second"] * grid,
        }
        return Course(grid, {name: known[name] for name in columns}, dict.fromkeys(final, v["first"]))

    def close(self) -> None: ...


def effect(*slots: str, sigma: float = 1.0, positive: bool = False, starts: tuple[tuple[float, ...], ...] = ()) -> Hypothesis:
    coordinates = tuple(Coordinate(name, ((name, 1.0),), sigma, positive=positive) for name in slots)
    return Hypothesis(slots[0], coordinates, starts or ((sigma,) * len(slots),))


def table(*hypotheses: Hypothesis, sensors: tuple[Sensor, ...] = ()) -> Distinction:
    tracks = [Track("attitude", name, name, TIMES, np.zeros(len(TIMES)), SIGMA, 0.0) for name in (PITCH, ROLL)]
    landings = Landings([Observation(tracks, [])], [{}], [1.2])
    offset = Coordinate("offset", (("offset", 1.0),), 10.0, step=0.01)
    setup: Any = SimpleNamespace(
        nuisances=[offset], tolerances=[], hypotheses=list(hypotheses), names=["a"], addresses=SimpleNamespace(where="a")
    )
    with_all = equipped(landings, sensors)
    jacobian, flown = fly(setup, with_all, Crew(Lines), 0)
    return distinction(jacobian, flown, hypotheses, {}, with_all)


def test_lambda_is_what_the_nuisance_leaves_of_the_signature() -> None:
    (seen,) = table(effect("first")).effects
    left = TIMES - TIMES.mean()  # a free offset takes the mean
    assert seen.lambda_ == pytest.approx(float(left @ left) / SIGMA**2, rel=1e-3)


def test_the_smallest_value_that_shows_has_lambda_25() -> None:
    (seen,) = table(effect("third", sigma=2.0)).effects
    assert seen.detectable == pytest.approx(5.0 * SIGMA / float(np.linalg.norm(TIMES)), rel=1e-6)
    assert seen.parameter == "third"


def test_effects_with_the_same_trace_are_one_group_and_another_stands_alone() -> None:
    found = table(effect("first"), effect("second"), effect("third"))
    assert found.groups == [["first", "second"]]
    assert found.cosine[0, 1] == pytest.approx(1.0)
    assert found.cosine[0, 2] == pytest.approx(0.0, abs=1e-9)


def test_a_sensor_that_sees_one_of_two_twins_parts_them() -> None:
    found = table(effect("first"), effect("second"), sensors=(LOAD,))
    assert [(s.channel, s.splits) for s in found.sensors] == [("load", [["first", "second"]])]


def test_a_sensor_makes_visible_what_the_data_do_not_show() -> None:
    found = table(effect("second", sigma=0.003), sensors=(LOAD, DEPTH))
    assert found.unseen
    assert found.sensors[0].reveals == ["second"]
    assert found.sensors[1].reveals == []


def test_a_reading_at_rest_that_is_as_fine_already_is_no_new_sensor() -> None:
    landings = Landings([Observation([], [Reading("p", "soil1.penetration", 0.0, 0.001)])], [{}], [1.0])
    assert not equipped(landings, (DEPTH,)).rows


def test_rows_of_a_sensor_stand_behind_those_of_the_data() -> None:
    readings = [Reading("skid", "soil1.skid", 0.0, 0.01)]
    tracks = [Track("attitude", PITCH, PITCH, TIMES, np.zeros(len(TIMES)), SIGMA, 0.0)]
    found: Equipped = equipped(Landings([Observation(tracks, readings)], [{}], [1.0]), (LOAD, DEPTH))
    assert found.landings.size == len(found.measured) + sum(map(len, found.rows.values()))
    assert sorted(np.concatenate([found.measured, *found.rows.values()]).tolist()) == list(range(found.landings.size))
    assert len(found.rows[DEPTH]) == 1


def test_a_parameter_that_means_nothing_at_the_null_does_not_size_the_effect() -> None:
    hypothesis = Hypothesis("third", (effect("third").coordinates[0], effect("late").coordinates[0]), ((1.0, 0.5),))
    (seen,) = table(hypothesis).effects
    assert seen.parameter == "third"


def test_one_sided_effects_that_pull_opposite_ways_are_not_alike() -> None:
    jacobian = np.zeros((3, 1))
    column = np.array([10.0, 0.0, 0.0])
    pair = [Flown(str(s), s * column[:, None], s * column[:, None], np.ones((1, 1)), True) for s in (1.0, -1.0)]
    signed = cosines([signature(one, jacobian) for one in pair], jacobian)
    assert signed[0, 1] == 0.0


def test_a_landing_that_cannot_be_flown_at_a_start_leaves_the_slope_at_the_null() -> None:
    column = np.array([[10.0], [0.0]])
    found = signature(Flown("x", column, np.full((2, 1), np.nan), np.ones((1, 1))), np.zeros((2, 1)))
    assert found.energy == pytest.approx(100.0)


def test_effects_that_hardly_show_are_in_no_group() -> None:
    assert groups(["a", "b"], np.ones((2, 2)), [400.0, 1.0]) == []


def test_where_an_effect_just_shows_its_slopes_promise_lambda_25() -> None:
    slopes = np.array([[10.0, 0.0], [0.0, 40.0]])
    assert just_shows(slopes, np.zeros((2, 1)), True) == pytest.approx([0.0, 5.0 / 40.0])
    assert just_shows(0.0 * slopes, np.zeros((2, 1)), True) is None


def test_the_smallest_and_the_widest_signature_are_bounded() -> None:
    assert just_shows(np.array([[1e4]]), np.zeros((1, 1)), True) == pytest.approx([0.02])
    assert just_shows(np.array([[-1e-3]]), np.zeros((1, 1)), True) == pytest.approx([1.0])


def test_the_signature_is_that_of_the_size_which_just_shows() -> None:
    """Started at z = 1, where first + bent z has λ of thousands; at the null it is `first` alone."""
    slopes, near, far = np.array([[50.0], [0.0]]), np.array([5.0, 0.1]), np.array([50.0, 50.0])
    found = signature(Flown("x", slopes, np.column_stack([far, near]), np.array([[1.0], [0.1]])), np.zeros((2, 1)))
    assert found.visible == pytest.approx(near / 0.1)
    assert found.shows == pytest.approx(0.1, rel=1e-3)
