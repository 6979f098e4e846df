"""The engine's tail-off against closed forms and quadrature, and GuidanceControl on top of it."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from lander.laws.tailoff import fitted_slope, impulse, mean_thrust, thrust, thrust_points
from lander.units.guidance_control import GuidanceControl
from lander.units.rate_sensor import RateSensor

NONE = np.zeros(8)
DECAY = thrust_points(1000.0, 0.5, NONE, NONE, 0)
CUT_OFF = thrust_points(1000.0, 0.0, NONE, NONE, 0)
TABLE = thrust_points(0.0, 0.0, np.array([0.1, 0.2, 0.6, 0, 0, 0, 0, 0.0]), np.array([5e3, 8e3, 2e3, 0, 0, 0, 0, 0.0]), 3)


def test_linear_decay_is_a_line_to_zero_and_zero_after_it() -> None:
    assert [thrust(t, DECAY) for t in (0.0, 0.125, 0.5, 9.0)] == [1000.0, 750.0, 0.0, 0.0]
    assert impulse(0.5, DECAY) == pytest.approx(250.0, rel=1e-15)
    assert impulse(9.0, DECAY) == pytest.approx(250.0, rel=1e-15)


def test_a_decay_of_no_length_is_a_cut_off() -> None:
    assert thrust(0.0, CUT_OFF) == 0.0
    assert impulse(1.0, CUT_OFF) == 0.0
    assert fitted_slope(0.0, 1.0, CUT_OFF) == 0.0


def test_the_table_is_held_before_it_linear_in_it_and_zero_after_it() -> None:
    assert [thrust(t, TABLE) for t in (0.0, 0.1, 0.15, 0.4, 0.6)] == pytest.approx([5e3, 5e3, 6.5e3, 5e3, 0.0], rel=1e-14)
    assert impulse(0.6, TABLE) == pytest.approx(0.1 * 5e3 + 0.1 * 6.5e3 + 0.4 * 5e3, rel=1e-14)


@pytest.mark.parametrize("corners", [DECAY, TABLE])
@pytest.mark.parametrize("tau", [0.0, 0.05, 0.15, 0.45, 0.58])
@pytest.mark.parametrize("step", [1e-3, 0.07, 1.0])
def test_mean_and_slope_against_quadrature(corners: Any, tau: float, step: float) -> None:
    """Midpoint rule with n points of a piecewise linear law with jumps below 1e4 N: error below 1e4/n."""
    n = 40_000
    s = (np.arange(n) + 0.5) / n * step
    values = np.array([thrust(tau + t, corners) for t in s])
    assert mean_thrust(tau, step, corners) == pytest.approx(values.mean(), abs=1e4 / n)
    slope = 12.0 / step**2 * np.mean((s - step / 2) * values)
    assert fitted_slope(tau, step, corners) == pytest.approx(slope, abs=6e4 / n / step)


def test_within_one_piece_the_slope_is_the_laws_own() -> None:
    assert fitted_slope(0.1, 0.2, DECAY) == pytest.approx(-2000.0, rel=1e-9)


def guidance(**parameters: float) -> GuidanceControl:
    """A unit ready to step."""
    one = GuidanceControl(instance_name="guidance")
    one.setup_experiment(0.0, None, None)
    one.enter_initialization_mode()
    for name, value in parameters.items():
        one[name] = value
    one.exit_initialization_mode()
    assert one.message == ""
    return one


def test_thrust_begins_to_decay_at_the_first_contact_and_not_at_the_second() -> None:
    one = guidance(thrust_start=1000.0, decay_time=0.5, thrust_before_contact=1200.0)
    assert one.value("engine.thrust") == 1200.0
    assert one.do_step(0.0, 0.1)
    assert one["engine.force_mean"].tolist() == [1200.0, 0.0, 0.0]
    one["contact3"] = 1.0
    assert one.do_step(0.1, 0.1)
    assert one["engine.force"][0] == pytest.approx(800.0, rel=1e-14)
    assert one["engine.force_mean"][0] == pytest.approx(900.0, rel=1e-14)
    assert one["engine.force_slope"][0] == pytest.approx(-2000.0, rel=1e-9)
    one["contact3"], one["contact1"] = 0.0, 1.0
    assert one.do_step(0.2, 0.2)
    assert one.value("engine.thrust") == pytest.approx(400.0, rel=1e-14)
    assert one.do_step(0.4, 0.2)
    assert one.value("engine.on") == 0.0
    assert one["engine.force_mean"][0] == pytest.approx(0.5 * 400.0 * 0.2 / 0.2, rel=1e-13)


def test_impulse_does_not_depend_on_the_steps() -> None:
    rng, totals = np.random.default_rng(7), []
    for steps in (1, 3, 40):
        one = guidance(thrust_start=1000.0, decay_time=0.35)
        one["contact1"] = 1.0
        times = np.concatenate([[0.0], np.sort(rng.uniform(0.0, 1.0, steps - 1)), [1.0]])
        total = 0.0
        for t, end in pairwise(times):
            assert one.do_step(float(t), float(end - t))
            total += (end - t) * one["engine.force_mean"][0]
        totals.append(total)
    assert totals == pytest.approx([175.0] * 3, rel=1e-12)


def test_the_torque_of_a_line_of_thrust_beside_the_origin() -> None:
    one = GuidanceControl(instance_name="guidance")
    one.enter_initialization_mode()
    one["thrust_before_contact"], one["thrust_offset"] = 100.0, (0.1, 0.2)
    one.exit_initialization_mode()
    assert one["engine.torque"].tolist() == pytest.approx(np.cross([0.0, 0.1, 0.2], [100.0, 0.0, 0.0]).tolist())


def test_a_table_that_does_not_rise_is_named() -> None:
    one = GuidanceControl(instance_name="guidance")
    one["table_points"], one["table_time"][:3] = 3.0, (0.0, 0.2, 0.2)
    one.exit_initialization_mode()
    assert one.message == "table_time[3] is 0.2 s, expects more than table_time[2], 0.2 s"


def test_the_next_corner_is_announced_from_first_contact_on() -> None:
    one = guidance(thrust_start=1000.0, decay_time=0.5)
    assert one.value("next_event_time") == -1.0
    assert one.do_step(0.0, 0.1)
    assert one.value("next_event_time") == -1.0
    one["contact1"] = 1.0
    assert one.do_step(0.1, 0.2)
    assert one.value("next_event_time") == pytest.approx(0.6, abs=1e-12)
    assert one.do_step(0.3, 0.3)
    assert one.value("next_event_time") == -1.0


def test_every_corner_of_a_table_is_announced() -> None:
    one = GuidanceControl(instance_name="guidance")
    one["table_points"], one["table_time"][:3], one["table_thrust"][:3] = 3.0, (0.1, 0.2, 0.6), (5e3, 8e3, 2e3)
    one.exit_initialization_mode()
    one["contact4"], seen, now = 1.0, [], 0.0
    assert one.do_step(now, 0.05)
    now = 0.05
    while one.value("next_event_time") >= 0.0:
        seen.append(one.value("next_event_time"))
        assert one.do_step(now, seen[-1] - now)
        now = seen[-1]
    assert seen == pytest.approx([0.1, 0.2, 0.6], abs=1e-12)


def test_the_next_sample_is_announced() -> None:
    one = RateSensor(instance_name="sensor")
    one.setup_experiment(1.0, None, None)
    one["sample_interval"] = 0.025
    one.exit_initialization_mode()
    assert one.value("next_event_time") == pytest.approx(1.025, abs=1e-12)
    assert one.do_step(1.0, 0.025)
    assert one.value("next_event_time") == pytest.approx(1.05, abs=1e-12)
    assert one.do_step(1.025, 0.06)
    assert one.value("next_event_time") == pytest.approx(1.1, abs=1e-12)
