"""The regolith's law for one point: weights, latching, both laws, loading and unloading; its derivatives against finite differences."""

from math import cos, pi, tanh

import numpy as np
import pytest
from lander.laws.soil import (
    PUBLISHED,
    RATE_INDEPENDENT,
    UNLATCHED,
    Soil,
    damping_weight,
    latched,
    normal_force,
    predicted_depth,
    tangential_force,
)

PAPER = Soil(PUBLISHED, 30000.0, 1.5, 30000.0, 0.1, 1e-4, 1e-4, 0.36, 290.8, 1e-3)
OURS = PAPER._replace(law=RATE_INDEPENDENT)
FAST = 0.3  # m/s: w_r = 1 there


def test_loading_is_the_power_law_plus_damping() -> None:
    """Verifies: F_n = K_n δ^p + w_d C_n δ̇ while sinking into virgin soil, both laws.
    Setup: three depths, before and after δ_d; w_d by hand.
    Tolerance: 1e-12.
    """
    for depth in (0.02, 0.05, 0.15):
        weight = 0.5 * (1.0 - cos(pi * depth / 0.1)) if depth < 0.1 else 1.0
        expected = 30000.0 * depth**1.5 + weight * 30000.0 * FAST
        assert normal_force(PAPER, depth, FAST, UNLATCHED).force == pytest.approx(expected, rel=1e-12)
        assert normal_force(OURS, depth, FAST, UNLATCHED).force == pytest.approx(expected, rel=1e-12)


def test_the_damping_weight_rises_from_zero_to_one_at_its_depth() -> None:
    """Verifies: w_d of eq. 7 at 0, δ_d/2, δ_d and beyond; 1 where δ_d = 0 (the printed equation divides by zero there).
    Setup: closed form.
    Tolerance: 1e-15.
    """
    for depth, expected in ((0.0, 0.0), (0.05, 0.5), (0.1, 1.0), (0.2, 1.0)):
        assert damping_weight(PAPER, depth)[0] == pytest.approx(expected, abs=1e-15)
    assert damping_weight(PAPER._replace(ramp=0.0), 1e-9) == (1.0, 0.0)


def test_the_rate_weight_lets_the_force_die_with_the_sink_rate() -> None:
    """Verifies: w_r = ½ [1 + tanh(6/ṙ (δ̇ - ṙ/2))]: ½ at half the residual rate, 0.9975 at it, 0.0025 at rest, none rising.
    Setup: C_n = 0, unlatched; ratio to the spring K_n δ^p.
    Tolerance: 1e-12.
    """
    soil = PAPER._replace(damping=0.0)
    spring = 30000.0 * 0.05**1.5
    for rate, share in ((5e-5, 0.5), (1e-4, 0.5 * (1 + tanh(3.0))), (0.0, 0.5 * (1 - tanh(3.0))), (FAST, 1.0)):
        assert normal_force(soil, 0.05, rate, UNLATCHED).force == pytest.approx(share * spring, rel=1e-12)
    assert normal_force(soil, 0.05, -1e-3, UNLATCHED).force < 1e-20 * spring


def test_unloading_the_published_law_lets_go_over_the_rebound_band() -> None:
    """Verifies: w_b = ½ [1 - tanh(6/b ((δ_MAX - δ) - b/2))]: 0.9975 at and beyond the datum, ½ at b/2 above it, 0.0025 at b; 1 unlatched.
    Setup: datum 5 cm, sink rate held at 0.3 m/s so that w_r = 1 and only w_b tells; a sign flip in w_b turns these round.
    Tolerance: 1e-12.
    """
    soil = PAPER._replace(damping=0.0)

    def share(above: float, datum: float) -> float:
        depth = 0.05 - above
        return normal_force(soil, depth, FAST, datum).force / (30000.0 * depth**1.5)

    high, low = 0.5 * (1.0 + tanh(3.0)), 0.5 * (1.0 - tanh(3.0))
    assert high == pytest.approx(0.9975, abs=5e-5)
    found = [share(above, 0.05) for above in (-0.01, 0.0, 0.5e-4, 1e-4)]
    assert found == pytest.approx([high, high, 0.5, low], rel=1e-9)
    assert share(5e-4, 0.05) < 1e-12
    assert share(0.0, UNLATCHED) == pytest.approx(1.0, rel=1e-12)


def test_unloading_the_rate_independent_law_is_elastic_along_the_band() -> None:
    """Verifies: our second law: slope K_n δ_m^p/b from the datum up, nothing beyond b, no force from a rate upwards, no creep at rest.
    Setup: datum 5 cm; at rest, rising, sinking.
    Tolerance: 1e-9 (5 cm less fractions of 0.1 mm cancel to that).
    """
    spring = 30000.0 * 0.05**1.5
    for above, share in ((0.0, 1.0), (0.25e-4, 0.75), (0.9e-4, 0.1), (1.1e-4, 0.0)):
        assert normal_force(OURS, 0.05 - above, 0.0, 0.05).force == pytest.approx(share * spring, rel=1e-9, abs=1e-9)
        assert normal_force(OURS, 0.05 - above, -FAST, 0.05).force == pytest.approx(share * spring, rel=1e-9, abs=1e-9)
    assert normal_force(OURS, 0.05, FAST, 0.05).force == pytest.approx(spring + 0.5 * 30000.0 * FAST, rel=1e-12)
    assert normal_force(OURS, 0.06, 0.0, 0.05).force == pytest.approx(30000.0 * 0.06**1.5, rel=1e-12)
    assert normal_force(OURS, 0.05 - 0.5e-4, 0.0, 0.05).stiffness == pytest.approx(spring / 1e-4, rel=1e-9)


PRINTS = [(5e-5, 1.0, 1e-4), (0.03, 1.0, 0.05), (0.03, 1.5, 0.05), (0.05, 1.5, 0.1), (0.05, 1.0, 1e-4)]


@pytest.mark.parametrize(("depth", "exponent", "band"), PRINTS)
def test_a_print_gives_back_no_more_than_the_work_put_in(depth: float, exponent: float, band: float) -> None:
    """Verifies: law 2 is dissipative for prints shallower than its band, too; with b for them it gave back 1.4 to 1.9 times the work.
    Setup: pressed in and let out slowly, C_n = 0; work in K_n δ_m^(p+1)/(p + 1), work out by the trapezoidal rule over 20,001 depths.
    Tolerance: 1e-6 of the work; a straight line is integrated exactly but for its foot, which lies between two depths (1e-8).
    """
    soil = OURS._replace(damping=0.0, exponent=exponent, band=band)
    depths = np.linspace(0.0, depth, 20001)
    out = np.trapezoid([normal_force(soil, d, -1e-3, depth).force for d in depths.tolist()], depths)
    work_in = 30000.0 * depth ** (exponent + 1.0) / (exponent + 1.0)
    assert out <= work_in * (1.0 + 1e-6)
    assert out == pytest.approx(min(0.5 * band * 30000.0 * depth**exponent, work_in), rel=1e-3 if band < 1e-3 else 1e-6)


def test_the_datum_latches_at_the_first_rest_and_then_only_grows() -> None:
    """Verifies: δ_MAX: not before the sink rate first falls to ṙ; afterwards the greatest depth, whatever the rate.
    Setup: a history of depth and rate by hand.
    Tolerance: exact.
    """
    history = [(-0.01, FAST), (0.02, FAST), (0.05, 1.01e-4), (0.0501, 1e-4), (0.03, -FAST), (0.04, FAST), (0.06, FAST), (-0.1, -FAST)]
    expected = [UNLATCHED, UNLATCHED, UNLATCHED, 0.0501, 0.0501, 0.0501, 0.06, 0.06]
    datum, found = UNLATCHED, []
    for depth, rate in history:
        datum = latched(PAPER, depth, rate, datum)
        found.append(datum)
    assert found == expected
    assert latched(OURS, 0.02, FAST, UNLATCHED) == 0.02


@pytest.mark.parametrize("soil", [PAPER, OURS], ids=["published", "ours"])
def test_the_soil_never_pulls(soil: Soil) -> None:
    """Verifies: F_n >= 0 for every depth, rate and datum, and none above the surface.
    Setup: a grid that includes rises, with full damping from the surface on (δ_d = 0): a slow rise just below the surface would
    pull, since w_r is not yet zero there.
    Tolerance: none.
    """
    soil = soil._replace(ramp=0.0)
    for depth in (-0.1, 0.0, 1e-6, 0.01, 0.0499, 0.05, 0.2):
        for rate in (-3.0, -0.1, -1e-4, 0.0, 1e-4, 0.1, 3.0):
            for datum in (UNLATCHED, 0.05):
                force = normal_force(soil, depth, rate, datum).force
                assert force >= 0.0
                assert force == 0.0 or depth > 0.0


@pytest.mark.parametrize("soil", [PAPER, OURS], ids=["published", "ours"])
@pytest.mark.parametrize("datum", [UNLATCHED, 0.05, 0.03])
@pytest.mark.parametrize("depth", [0.02, 0.04996, 0.04993, 0.07, 0.12])
@pytest.mark.parametrize("rate", [0.2, 8e-5, 4e-5, -2e-4])
def test_derivatives_by_depth_and_rate(soil: Soil, datum: float, depth: float, rate: float) -> None:
    """Verifies: dF/dδ and dF/dδ̇, which Newton takes.
    Setup: five-point differences, 1e-7 m and 1e-7 m/s: a thousandth of band and residual rate; off the kinks at the datum and at δ_d.
    Tolerance: 1e-5 relative, or cancellation: 1e-16 F/1e-7 of 2e4 N.
    """
    e = 1e-7

    def five(f: list[float]) -> float:
        return (8 * (f[2] - f[1]) - (f[3] - f[0])) / (12 * e)

    law = normal_force(soil, depth, rate, datum)
    by_depth = five([normal_force(soil, depth + k * e, rate, datum).force for k in (-2, -1, 1, 2)])
    by_rate = five([normal_force(soil, depth, rate + k * e, datum).force for k in (-2, -1, 1, 2)])
    assert law.stiffness == pytest.approx(by_depth, rel=1e-5, abs=1e-2)
    assert law.damping == pytest.approx(by_rate, rel=1e-5, abs=1e-2)


def test_friction_opposes_slip_on_the_cone_and_plowing_opposes_the_slide(random: np.random.Generator) -> None:
    """Verifies: F_t = -μ F_n v/sqrt(v² + v_s²) - K_p δ_t: opposite to either, μ F_n when fast, dissipative at every speed.
    Setup: random slips; slip and slide apart.
    Tolerance: 1e-12; cone reached within ½ (v_s/v)² = 5e-7 at a thousand v_s.
    """
    nothing = (0.0, 0.0, 0.0)
    for speed in (1e-4, 1e-3, 0.1, 1.0):
        slip = random.normal(size=3)
        slip *= speed / np.linalg.norm(slip)
        force = np.array(tangential_force(PAPER, 1000.0, tuple(slip), nothing))
        assert force @ slip < 0.0
        assert np.linalg.norm(np.cross(force, slip)) < 1e-12 * 360.0 * speed
        assert np.linalg.norm(force) == pytest.approx(360.0 * speed / np.hypot(speed, 1e-3), rel=1e-12)
    slide = (0.0, 0.03, -0.04)
    np.testing.assert_allclose(tangential_force(PAPER, 1000.0, nothing, slide), -290.8 * np.array(slide), rtol=1e-12)


def test_the_predicted_depth_is_where_the_work_of_weight_and_soil_balance() -> None:
    """Verifies: eq. 10: m g δ = ∫ K δ^p dδ.
    Setup: quadrature of the law's own force from the surface to the predicted depth; Fig. 11's numbers.
    Tolerance: 1e-6, the trapezoid's; 0.3327 m to its digits.
    """
    depth = predicted_depth(7063.5, 1.63, 150000.0, 1.5)
    assert depth == pytest.approx(0.3327, abs=5e-5)
    soil = PAPER._replace(bearing=150000.0, damping=0.0)
    path = np.linspace(0.0, depth, 4001)
    forces = [normal_force(soil, d, FAST, UNLATCHED).force for d in path]
    assert np.trapezoid(forces, path) == pytest.approx(7063.5 * 1.63 * depth, rel=1e-6)
