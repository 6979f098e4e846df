"""The paper's Fig. 8: a cylinder brought to rest by the primary strut, against eq. 4, by the laws and an integrator of scipy's.

Relative error of the stroke against eq. 4's 0.28376 m, in per cent (μ_B 0.23, v_b 0.01 m/s):

| s, mm  | ζ = 1, w_L normalised | ζ = 1, eq. 3 to the letter | ζ = 0, normalised | ζ = 0, to the letter |
|--------|---------|---------|---------|---------|
| 8      | -0.672  | -0.672  | -0.103  | +0.067  |
| 4      | -0.359  | -0.359  | -0.052  | +0.119  |
| 2      | -0.191  | -0.191  | -0.026  | +0.145  |
| 1      | -0.101  | -0.101  | -0.013  | +0.158  |
| 0.5    | -0.053  | -0.053  | -0.006  | +0.165  |
| 0.25   | -0.028  | -0.028  | -0.003  | +0.168  |
| 0.1    | -0.012  | -0.012  | -0.001  | +0.170  |

The paper's 0.07 % with and without damping is kept from s = 0.5 mm down; at Table 3's 1 mm only without damping.
"""

from math import cos, radians, sin

import pytest
from apollo_samples import GRAVITY, MASS, PRIMARY_LOADS, core
from lander.laws.honeycomb import DATUM_WEIGHT, bearing_friction, core_force
from scipy.integrate import solve_ivp

TILT, MU, BOUNDARY = radians(20.0), 0.23, 0.254
DRIVE, WALL = MASS * GRAVITY * cos(TILT), MASS * GRAVITY * sin(TILT)
BETTER_THAN_PAPER = 7e-4
TABLE = {
    (8e-3, 1.0): -0.672,
    (2e-3, 1.0): -0.191,
    (1e-3, 1.0): -0.101,
    (5e-4, 1.0): -0.053,
    (2.5e-4, 1.0): -0.028,
    (8e-3, 0.0): -0.103,
    (2e-3, 0.0): -0.026,
    (1e-3, 0.0): -0.013,
    (5e-4, 0.0): -0.006,
    (2.5e-4, 0.0): -0.003,
}


def energy_stroke() -> float:
    """d_1 + d_2 of eq. 4: m g cos θ (d_1 + d_2) + ½ m v² = F_1 d_1 + F_2 d_2 + μ_B m g sin θ (d_1 + d_2)."""
    first, second = PRIMARY_LOADS
    rest = 0.5 * MASS * 1.0**2 + (DRIVE - first - MU * WALL) * BOUNDARY
    return BOUNDARY + rest / (second + MU * WALL - DRIVE)


def stroke(s: float, zeta: float, datum_weight: float = DATUM_WEIGHT) -> float:
    """Stroke at which the cylinder first stops, m: Radau, steps kept below the width, which is where the load changes."""
    strut = core(PRIMARY_LOADS, BOUNDARY, 0.812, s, zeta)._replace(datum_weight=datum_weight)

    def motion(t: float, y: list[float]) -> list[float]:
        friction = bearing_friction(MU, WALL, y[1], 1e-2).force
        return [y[1], (DRIVE - core_force(strut, y[0], y[1], s).force - friction) / MASS]

    def stops(t: float, y: list[float]) -> float:
        return y[1]

    stops.terminal, stops.direction = True, -1.0
    run = solve_ivp(motion, (0.0, 2.0), [0.0, 1.0], method="Radau", rtol=1e-8, atol=1e-11, events=stops, max_step=0.7 * s)
    return float(run.y_events[0][0][0])


def test_equation_4_gives_the_stroke_of_the_specification() -> None:
    """Verifies: the reference itself.
    Setup: eq. 4 by hand; physics.md says 0.2838 m.
    Tolerance: its last digit.
    """
    assert energy_stroke() == pytest.approx(0.2838, abs=5e-5)


@pytest.mark.parametrize(("s", "zeta"), TABLE)
def test_the_error_falls_with_the_width_as_tabled(s: float, zeta: float) -> None:
    """Verifies: stages, latching, saturation, friction and memory together, and that s alone is what limits the agreement with eq. 4.
    Setup: Fig. 8; crushing does not turn back before the stop, so that the memory is max(s, d), which the law takes by itself.
    Tolerance: half the table's last digit and the integrator's: 0.002 points of a per cent.
    """
    assert 100.0 * (stroke(s, zeta) / energy_stroke() - 1.0) == pytest.approx(TABLE[s, zeta], abs=2e-3)


@pytest.mark.parametrize("zeta", [0.0, 1.0])
def test_half_a_millimetre_is_better_than_the_paper_with_and_without_damping(zeta: float) -> None:
    """Verifies: acceptance, 0.07 % of eq. 4 with and without damping.
    Setup: Fig. 8 with s = 0.5 mm.
    Tolerance: the paper's own 0.07 %.
    """
    assert stroke(5e-4, zeta) == pytest.approx(energy_stroke(), rel=BETTER_THAN_PAPER)


def test_equation_3_to_the_letter_would_miss_the_papers_figure() -> None:
    """Verifies: why w_L is divided by its value at the datum: undamped, the printed weight crushes at 0.9975 of Table 3's load.
    Setup: Fig. 8, ζ = 0, weight not normalised, s = 1 mm: the load deficit lengthens the stroke by 0.17 %.
    Tolerance: 0.002 points; and beyond the paper's 0.07 %.
    """
    error = 100.0 * (stroke(1e-3, 0.0, 1.0) / energy_stroke() - 1.0)
    assert error == pytest.approx(0.158, abs=2e-3)
    assert error > 100.0 * BETTER_THAN_PAPER
