"""The paper's Fig. 11: 7,063.5 kg on one pad set down on Adams-like soil without damping, against eq. 10 and at rest.

Found: 0.33268830 m when the sink rate first falls to the residual rate, eq. 10's within 1e-8; creep afterwards 0.0467 mm/s.
"""

import numpy as np
import pytest
from apollo_samples import GRAVITY, MASS
from lander.laws.footpad import DATUM, DEPTH, Footpad, PadMotion, start_memory
from lander.laws.soil import PUBLISHED, RATE_INDEPENDENT, UNLATCHED, Soil, normal_force, predicted_depth
from lander.laws.soil_stepping import InterfaceModel, PadStart, Shift, step_soil
from lander.laws.surface import inclined_plane
from lander.laws.vectors import ZERO, Vector, identity, rotation
from scipy.integrate import OdeSolution, solve_ivp

SOIL = Soil(PUBLISHED, 150000.0, 1.5, 0.0, 0.1, 1e-4, 1e-4, 0.36, 1454.0, 1e-3)
EXPECTED = predicted_depth(MASS, GRAVITY, 150000.0, 1.5)
WEIGHT = MASS * GRAVITY


def radau(start: list[float], datum: float, until: float, to_rest: bool) -> OdeSolution:
    """Sink of the mass by scipy, (δ, δ̇)."""

    def motion(t: float, y: np.ndarray) -> list[float]:
        return [y[1], GRAVITY - normal_force(SOIL, y[0], y[1], datum).force / MASS]

    def jacobian(t: float, y: np.ndarray) -> list[list[float]]:
        law = normal_force(SOIL, y[0], y[1], datum)
        return [[0.0, 1.0], [-law.stiffness / MASS, -law.damping / MASS]]

    def rests(t: float, y: np.ndarray) -> float:
        return y[1] - SOIL.residual if t > 1e-2 else 1.0

    rests.terminal, rests.direction = to_rest, -1.0
    return solve_ivp(motion, (0.0, until), start, method="Radau", jac=jacobian, events=rests, rtol=1e-9, atol=1e-13)


def test_the_mass_comes_to_rest_at_equation_10() -> None:
    """Verifies: loading to 0.01 % of eq. 10, then F_n = m g and the designed creep, δ_MAX latched.
    Setup: Radau from rest on the surface to the residual rate; then six seconds with the datum latched there.
    Tolerance: 0.01 % is the acceptance; 1e-6 is what the residual rate itself costs, ½ m ṙ² being nothing. Creep below 0.1 mm/s;
    the rate at which w_b w_r K δ^p = m g is 0.047 mm/s, by hand. F_n = m g to 1e-6: the creep decelerates at 1e-9 m/s2.
    """
    sinking = radau([0.0, 0.0], UNLATCHED, 5.0, to_rest=True)
    depth = sinking.y[0, -1]
    assert depth == pytest.approx(EXPECTED, rel=1e-6)
    resting = radau([depth, sinking.y[1, -1]], depth, 6.0, to_rest=False)
    assert resting.y[1].max() < 1.0001e-4
    assert resting.y[1].min() > 0.0
    last = resting.y[:, -1]
    assert normal_force(SOIL, *last, depth).force == pytest.approx(WEIGHT, rel=1e-6)
    share = WEIGHT / (150000.0 * last[0] ** 1.5) / (0.5 * (1 + np.tanh(3.0)))
    assert last[1] == pytest.approx(0.5e-4 + 1e-4 / 6.0 * np.arctanh(2.0 * share - 1.0), rel=1e-4)
    assert last[1] < 1e-4


def on_one_pad(law: int, interval: float, count: int) -> list[tuple[float, float, float, float]]:
    """The same by `step_soil`: level pad, the mass as its interface model. Rows: depth, sink rate, F_n, datum."""
    soil = SOIL._replace(law=law, bearing=SOIL.bearing / 5, plowing=SOIL.plowing / 5)
    pad, surface = Footpad(0.47, 0.10), inclined_plane(0.0, 0.0)
    still = identity(0.0)
    model = InterfaceModel((-GRAVITY, 0.0, 0.0), identity(1.0 / MASS), still, still, ZERO, ZERO, ZERO, 0.0, ZERO)
    place: Vector = (0.10, 0.0, 0.0)
    attitude, velocity, rate = (1.0, 0.0, 0.0, 0.0), ZERO, ZERO
    memory = np.zeros((5, 8))
    start_memory(surface, pad, PadMotion(place, rotation(attitude), velocity, rate), memory)
    rows = []
    for _ in range(count):
        start = PadStart(place, attitude, velocity, rate)
        at, attitude, wrench, _, ok = step_soil(soil, surface, pad, model, start, Shift(ZERO, ZERO), memory, interval, 1e-3)
        assert ok
        place, velocity, rate = at.position, at.velocity, at.rate
        rows.append((memory[0, DEPTH], -velocity[0], wrench.force[0], memory[0, DATUM]))
    return rows


def test_the_units_integrator_finds_the_same_rest() -> None:
    """Verifies: `step_soil` with the residual-rate law through five points: rest depth, force, creep, latching.
    Setup: level pad, 3 s in intervals of 10 ms, substeps of 1 ms; compared with eq. 10 when the sink rate first falls to the residual rate.
    Tolerance: 0.01 % (acceptance) plus the creep of at most one interval, 1e-6 m; F_n = m g to 1e-4.
    """
    rows = on_one_pad(PUBLISHED, 0.01, 300)
    first = next(row for row in rows[5:] if row[1] <= 1e-4)
    assert first[0] == pytest.approx(EXPECTED, rel=1e-4)
    assert 0.0 < first[3] <= first[0]
    depth, rate, force, datum = rows[-1]
    assert force == pytest.approx(WEIGHT, rel=1e-4)
    assert 0.0 < rate < 1e-4
    assert datum == depth
    assert depth - first[0] < 2.2 * 1e-4


def test_the_rate_independent_law_rests_without_creep() -> None:
    """Verifies: our second law: same depth, then no motion but elastic swinging about m g on the band's spring.
    Setup: as above. The band gives back ½ K_n δ^p b at 2.5 times the weight: a hop of 1.25 b, which nothing damps but the integrator.
    Tolerance: 0.01 % for the datum; no growth by 1e-9 m in two seconds; no hop above 1.25 b by 1 %; mean force m g to 1 %.
    """
    rows = on_one_pad(RATE_INDEPENDENT, 0.01, 300)
    assert rows[-1][3] == pytest.approx(EXPECTED, rel=1e-4)
    assert rows[-1][3] - rows[100][3] < 1e-9
    assert all(0.0 <= datum - depth < 1.01 * 1.25e-4 for depth, _, _, datum in rows[100:])
    assert np.mean([force for _, _, force, _ in rows[150:]]) == pytest.approx(WEIGHT, rel=1e-2)
