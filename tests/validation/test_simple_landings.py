"""Cases with an answer on paper: Figures 8 and 11 through the built units, and a landing that must be symmetric."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from conftest import Landing

Run = Callable[..., Landing]

PAPER = 7e-4  # the paper's own agreement with eq. 4
LEGS = ("+Z", "+Y", "-Z", "-Y")


def stroke_error(run: Landing) -> float:
    """Stroke over eq. 4's, less 1."""
    return float(run.summary["report"]["stroke"]["relative_difference"])


@pytest.mark.parametrize(("width", "zeta"), [(1e-3, 0), (5e-4, 0), (5e-4, 1), (2.5e-4, 1)])
def test_the_honeycomb_stops_where_equation_4_says_closer_than_the_paper(landing: Run, width: float, zeta: int) -> None:
    settings = (f"leg.transition_width={width}", f"leg.damping_ratio={zeta}", "leg.longest_substep=2e-5")
    assert abs(stroke_error(landing("honeycomb_drop", *settings))) < PAPER


def test_the_damped_honeycomb_at_one_millimetre_loses_what_the_early_rise_of_the_load_takes(landing: Run) -> None:
    """The load of stage 2 comes half a transition early, (F2 - F1) s/2 of work. Undamped, the virgin core's soft start gives nearly the
    same back; damped, the force is at F1 almost at once, and 0.10 % of the stroke stays missing: the width s, not an error of solving.

    Tolerance: 0.005 points of a per cent between the work so reckoned, at 1 m/s over the first s, and the run.
    """
    first, second, s = 20017.0, 42358.0, 1e-3
    m, g, mu, tilt = 7063.5, 1.63, 0.23, math.radians(20.0)
    d = np.linspace(0.0, s, 10001)
    w_L = 0.5 * (1.0 - np.tanh(6.0 / s * (s - d - 0.5 * s)))
    damped = first + 2.0 * math.sqrt(second / s * m) * 1.0
    given = np.trapezoid(first - np.minimum(first, w_L * damped), d)
    resistance = second + mu * m * g * math.sin(tilt) - m * g * math.cos(tilt)
    expected = -(0.5 * s * (second - first) - given) / resistance / 0.283757
    error = stroke_error(landing("honeycomb_drop", "leg.longest_substep=2e-5"))
    assert error == pytest.approx(expected, abs=5e-5)
    assert error == pytest.approx(-1.0e-3, abs=5e-5)


def test_a_footpad_set_down_rests_at_the_depth_of_equation_10(landing: Run) -> None:
    """Tolerance: 0.01 % of eq. 10 at rest, taken when the sink rate first falls to the residual rate; afterwards creep below 0.1 mm/s."""
    run = landing("footpad_drop")
    times, depth, rate = run.series("time"), run.series("soil.penetration"), -run.series("body.body.velocity[1]")
    resting = (times > 0.5) & (rate <= 1e-4)
    expected = run.summary["report"]["depth"]["expected"]
    assert depth[resting][0] == pytest.approx(expected, rel=1e-4)
    assert depth[-1] == pytest.approx(expected, rel=1e-4)
    assert run.series("soil.normal_force")[-1] == pytest.approx(7063.5 * 1.63, rel=1e-4)
    assert 0.0 <= rate[-1] < 1e-4
    assert (rate[resting] < 1.001e-4).all()


def spread(values: list[float]) -> float:
    """Largest over least, less 1."""
    return max(values) / min(values) - 1.0


def test_all_legs_do_the_same_on_level_ground(landing: Run) -> None:
    """Nothing tells the legs apart but rounding, which the published soil law amplifies as far as the step control lets it.

    Tolerance: 1e-3 at a step tolerance of 1e-6 m (found: 2e-5; 1e-11 with the rate-independent law). At the scenario's 1e-5 m the
    secondaries differ by up to 5e-3: there 0.1 mm is asked.
    """
    tight = landing("flat_symmetric", tolerance=1e-6).summary
    assert tight["stable"] is True
    assert spread(list(tight["penetration_m"].values())) < 1e-3
    assert spread(list(tight["skid_m"].values())) < 1e-3
    for strut in ("primary", "right", "left"):
        assert spread([tight["strokes_m"][f"{leg}.{strut}"] for leg in LEGS]) < 1e-3, strut
    assert all(abs(angle) < 1e-3 for angle in tight["final_attitude_deg"].values())


def test_the_flat_scenario_as_it_is_keeps_its_legs_together_within_a_tenth_of_a_millimetre(landing: Run) -> None:
    summary = landing("flat_symmetric").summary
    lengths = [list(summary["penetration_m"].values()), list(summary["skid_m"].values())]
    lengths += [[summary["strokes_m"][f"{leg}.{strut}"] for leg in LEGS] for strut in ("primary", "right", "left")]
    assert all(max(values) - min(values) < 1e-4 for values in lengths)
    times = list(summary["contact_times_s"].values())
    assert max(times) - min(times) < 1e-9
