"""The honeycomb's force law, point by point: closed forms, finite differences, work over a cycle."""

from math import tanh

import numpy as np
import pytest
from apollo_samples import core
from lander.laws.honeycomb import (
    DATUM_WEIGHT,
    Core,
    Stop,
    bearing_friction,
    brake_damping,
    core_force,
    primary_force,
    secondary_force,
    stage_load,
    stop_force,
    transition,
)

S = 1e-3  # m
F1, F2 = 20017.0, 42358.0
PRIMARY = core((F1, F2), 0.254, 0.812, S, 1.0)
UNDAMPED = PRIMARY._replace(damping=0.0)
TENSION = core((2224.0, 22241.0), 0.102, 0.407, S, 1.0)
COMPRESSION = core((20017.0, 20017.0), 0.610, 0.305, S, 1.0)
STOP = Stop(4e7, 6e4, 1e-4)


def quasi_static(cartridge: Core, path: np.ndarray) -> tuple[np.ndarray, float]:
    """Forces along a path of strokes, its memory latched as the leg does it, and the work put into the core."""
    crushed, forces = cartridge.width, []
    for d in path:
        crushed = max(crushed, d)
        forces.append(core_force(cartridge, d, 0.0, crushed).force)
    return np.array(forces), float(np.trapezoid(forces, path))


def test_the_stage_weight_is_equation_2() -> None:
    """Verifies: w = ½ [1 - tanh(6/s (x - s/2))]; F_1 before the boundary, the mean of both loads half a width before it, then F_2.
    Setup: the formula, written out; stage load at three strokes.
    Tolerance: 1e-14, the same formula; 1e-12 where F_1's tail enters.
    """
    for x in (0.0, 0.3e-3, 0.5e-3, 1e-3):
        assert transition(x, S).force == pytest.approx(0.5 * (1.0 - tanh(6.0 / S * (x - 0.5 * S))), rel=1e-14)
    assert abs(DATUM_WEIGHT - 0.9975274) < 1e-7
    assert stage_load(PRIMARY, 0.1, 0.1).force == pytest.approx(F1, rel=1e-12)
    assert stage_load(PRIMARY, 0.254 - 0.5 * S, 0.254 - 0.5 * S).force == pytest.approx(0.5 * (F1 + F2), rel=1e-12)
    assert stage_load(PRIMARY, 0.26, 0.26).force == F2


def test_a_passed_stage_stays_latched() -> None:
    """Verifies: after the boundary has been passed the second load holds wherever the strut is; before, going back restores the first.
    Setup: d_MAX just past and just short of the boundary, stroke well below it.
    Tolerance: exact.
    """
    assert stage_load(PRIMARY, 0.20, 0.2541).force == F2
    assert stage_load(PRIMARY, 0.20, 0.2539).force == pytest.approx(F1, rel=1e-12)


def test_a_virgin_core_builds_its_load_up_over_the_transition_width() -> None:
    """Verifies: d_MAX = s at the start: 0.25 % of F_1 at zero stroke, F_1 from s on, and nothing while extended.
    Setup: virgin core, no rate.
    Tolerance: 1e-12 against ½ [1 - tanh 3] divided by ½ [1 + tanh 3].
    """
    at_rest = core_force(UNDAMPED, 0.0, 0.0, S).force
    assert at_rest == pytest.approx(F1 * (1.0 - tanh(3.0)) / (1.0 + tanh(3.0)), rel=1e-12)
    assert core_force(UNDAMPED, S, 0.0, S).force == pytest.approx(F1, rel=1e-12)
    assert core_force(UNDAMPED, 0.1, 0.0, S).force == pytest.approx(F1, rel=1e-12)
    assert core_force(UNDAMPED, -S, 0.0, S).force < 1e-5 * F1
    assert core_force(UNDAMPED._replace(datum_weight=1.0), 0.1, 0.0, S).force == pytest.approx(DATUM_WEIGHT * F1, rel=1e-12)


def test_a_crushed_core_unloads_within_its_band_and_remembers() -> None:
    """Verifies: memory: the force falls over s below the greatest stroke, is gone beyond it, and comes back only there.
    Setup: crush to 0.1 m, back to 0, forward to 0.12 m.
    Tolerance: 1e-9 of F_1 outside the band (tail of tanh); exact shape within it.
    """
    path = np.concatenate([np.linspace(0.0, 0.1, 2001), np.linspace(0.1, 0.0, 2001), np.linspace(0.0, 0.12, 2401)])
    forces, _ = quasi_static(UNDAMPED, path)
    back = slice(2001, 4002)
    above = 0.1 - path[back]
    expected = F1 * 0.5 * (1.0 - np.tanh(6.0 / S * (above - 0.5 * S))) / DATUM_WEIGHT
    np.testing.assert_allclose(forces[back], expected, atol=1e-9 * F1)
    again = path[4002:]
    assert np.all(forces[4002:][again < 0.1 - 3.0 * S] < 1e-9 * F1)
    np.testing.assert_allclose(forces[4002:][again > 0.1 + S], F1, rtol=1e-9)


def test_energy_absorbed_is_load_times_stroke() -> None:
    """Verifies: over a cycle the core keeps F_1 d_1 + F_2 d_2 up to the transition's ½ s.
    Setup: trapezoid over 0 to 0.4 m and back; what the elastic band takes going in it gives back coming out.
    Closed form: plateaus, and ∫ w_L over the band = s/12 ln(1 + e⁶)/0.9975, about s/2, taken in at F_1 and given back at F_2.
    Tolerance: 1e-5 relative: the trapezoid's 5 micrometre steps and the tails of tanh.
    """
    n = 80_001
    forward = np.linspace(-5.0 * S, 0.4, n)
    _, net = quasi_static(UNDAMPED, np.concatenate([forward, forward[::-1]]))
    band = 0.5 * S / DATUM_WEIGHT * (1.0 + 0.5 * np.log1p(np.exp(-6.0)) / 3.0)  # ∫ w_L from the datum down, over F
    loading = F1 * band + F1 * (0.254 - 0.5 * S - S) + F2 * (0.4 - 0.254 + 0.5 * S)
    assert net == pytest.approx(loading - F2 * band, rel=1e-5)


def test_damping_is_saturated_at_the_stage_load_and_lives_in_the_band_only() -> None:
    """Verifies: eq. 1 with the paper's damping as physics.md settles it: min(F_s, w_L (F_s + c v)), never negative, none outside the band.
    Setup: fast and slow rates on the virgin curve, in the band, beyond it, unloading.
    Tolerance: exact to rounding.
    """
    assert core_force(PRIMARY, 0.1, 1.0, 0.1).force == pytest.approx(F1, rel=1e-12)
    assert core_force(PRIMARY, 0.3, 5.0, 0.3).force == F2
    weight = 0.5 * (1.0 - tanh(6.0 / S * (0.7e-3 - 0.5 * S))) / DATUM_WEIGHT
    assert core_force(PRIMARY, 0.0993, 1e-3, 0.1).force == pytest.approx(weight * (F1 + PRIMARY.damping * 1e-3), rel=1e-9)
    assert core_force(PRIMARY, 0.05, 1.0, 0.1).force < 1e-9
    assert core_force(PRIMARY, 0.0999, -1.0, 0.1).force == 0.0


def test_brake_damping_is_mass_normalised_critical() -> None:
    """Verifies: c = 2 ζ ω m with ω = sqrt(F/(s m)): a mass on the spring F/s with ζ = 1 is critically damped.
    Setup: discriminant c² - 4 k m of the oscillator; a quarter of it at ζ = ½.
    Tolerance: 1e-12.
    """
    c = brake_damping(1.0, F2, S, 7063.5)
    assert c * c == pytest.approx(4.0 * (F2 / S) * 7063.5, rel=1e-12)
    assert brake_damping(0.5, F2, S, 7063.5) == pytest.approx(0.5 * c, rel=1e-12)


def test_stops_push_back_at_both_ends_and_never_pull() -> None:
    """Verifies: K x + c min(1, x/ramp) v beyond the face; the ring holds the piston in, the spent cartridge stops it.
    Setup: by hand, 50 micrometres (half the ramp) and 1 mm deep.
    Tolerance: 1e-12.
    """
    assert stop_force(STOP, -1e-9, 1.0).force == 0.0
    assert stop_force(STOP, 5e-5, 0.1).force == pytest.approx(4e7 * 5e-5 + 6e4 * 0.5 * 0.1, rel=1e-12)
    assert stop_force(STOP, 1e-3, 0.1).force == pytest.approx(4e4 + 6e3, rel=1e-12)
    assert stop_force(STOP, 1e-3, -10.0).force == 0.0
    assert primary_force(UNDAMPED, STOP, 0.813, 0.0, 0.813).force == pytest.approx(F2 + 4e4, rel=1e-9)
    assert primary_force(UNDAMPED, STOP, -1e-3, 0.0, S).force == pytest.approx(-4e4, rel=1e-4)


def test_a_secondary_has_two_memories() -> None:
    """Verifies: tension and compression crush cores of their own: pulling does not spend the compression core, and the signs.
    Setup: elongated to 5 cm with either memory; pushed afterwards; beyond both stops.
    Tolerance: 1e-4 where both virgin tails meet, else 1e-9.
    """
    still = TENSION._replace(damping=0.0), COMPRESSION._replace(damping=0.0), STOP

    def force(d: float, pulled: float, pushed: float) -> float:
        return secondary_force(*still, d, 0.0, pulled, pushed).force

    assert force(0.05, 0.05, S) == pytest.approx(2224.0, rel=1e-9)
    assert force(-0.05, 0.05, 0.05) == pytest.approx(-20017.0, rel=1e-9)
    assert abs(force(-0.02, 0.05, 0.05)) < 1e-6  # gone slack in compression
    assert abs(force(0.03, 0.05, S)) < 1e-6  # gone slack in tension, although pushed is virgin
    assert force(-0.02, 0.05, S) == pytest.approx(-20017.0, rel=1e-9)  # spent in tension, virgin in compression
    assert force(0.03, S, 0.05) == pytest.approx(2224.0, rel=1e-9)  # spent in compression, virgin in tension
    assert force(0.2, 0.2, S) == pytest.approx(22241.0, rel=1e-9)
    assert force(0.408, 0.408, S) == pytest.approx(22241.0 + 4e4, rel=1e-9)
    assert force(-0.306, S, 0.306) == pytest.approx(-20017.0 - 4e4, rel=1e-9)


def test_bearing_friction_opposes_the_motion_and_saturates() -> None:
    """Verifies: F = μ |F_c| tanh(v/v_b) along v: it resists compression as well as extension, so its power is never positive on the strut.
    Setup: both directions; the strut pushes with +F when compressed at +v.
    Tolerance: 1e-12; saturation within 1e-8 at ten v_b.
    """
    for v in (-0.3, -1e-3, 1e-3, 0.3):
        friction = bearing_friction(0.23, 1000.0, v, 1e-2)
        assert friction.force * v > 0.0
        assert abs(friction.force) <= 230.0
    assert bearing_friction(0.23, 1000.0, 0.1, 1e-2).force == pytest.approx(230.0, rel=1e-8)
    assert bearing_friction(0.23, 1000.0, 5e-3, 1e-2).force == pytest.approx(230.0 * tanh(0.5), rel=1e-12)


PLACES = ((0.4e-3, S), (0.05, S), (0.0996, 0.1), (0.2536, 0.25), (0.2534, 0.2538), (0.2995, 0.3), (0.81205, 0.812))
STATES = [(d, v, crushed) for d, crushed in PLACES for v in (-2e-3, 3e-3)]  # v = 0 is a kink: saturated above, damped below


@pytest.mark.parametrize(("d", "v", "crushed"), STATES)
def test_derivatives_of_the_primary(d: float, v: float, crushed: float) -> None:
    """Verifies: dF/dd and dF/dv, which Newton and the reduced interface model take.
    Setup: central differences of 1e-8 m and 1e-8 m/s, in the band, on the virgin curve, in the stage change, in the ramp of the stop.
    Tolerance: 1e-4 of F/s (4e7 N/m) and of c: cancellation in the difference is 1e-6 of it, truncation 1e-9.
    """
    law = primary_force(PRIMARY, STOP, d, v, crushed)
    e = 1e-8
    left, right = (primary_force(PRIMARY, STOP, d + k * e, v, crushed).force for k in (-1, 1))
    slower, faster = (primary_force(PRIMARY, STOP, d, v + k * e, crushed).force for k in (-1, 1))
    assert law.stiffness == pytest.approx((right - left) / (2 * e), abs=4e3)
    assert law.damping == pytest.approx((faster - slower) / (2 * e), abs=1e-4 * PRIMARY.damping)


@pytest.mark.parametrize("d", [-0.30515, -0.0497, 0.2e-3, 0.0496, 0.1016, 0.40705])
def test_derivatives_of_a_secondary(d: float) -> None:
    """Verifies: dF/dd and dF/dv of a secondary in both directions and both stops.
    Setup: central differences of 1e-8; memories 5 cm each way.
    Tolerance: as for the primary.
    """
    law = secondary_force(TENSION, COMPRESSION, STOP, d, 1e-3, 0.05, 0.05)
    e = 1e-8
    ends = [secondary_force(TENSION, COMPRESSION, STOP, d + k * e, 1e-3, 0.05, 0.05).force for k in (-1, 1)]
    rates = [secondary_force(TENSION, COMPRESSION, STOP, d, 1e-3 + k * e, 0.05, 0.05).force for k in (-1, 1)]
    assert law.stiffness == pytest.approx((ends[1] - ends[0]) / (2 * e), abs=4e3)
    assert law.damping == pytest.approx((rates[1] - rates[0]) / (2 * e), abs=1e-4 * TENSION.damping)
    friction = bearing_friction(0.23, 1e3, d, 1e-2)
    both = [bearing_friction(0.23, 1e3, d + k * e, 1e-2).force for k in (-1, 1)]
    assert friction.damping == pytest.approx((both[1] - both[0]) / (2 * e), abs=1e-2)
