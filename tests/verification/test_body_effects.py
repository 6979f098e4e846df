"""Effects on the body: laws against closed forms, and the twin with each of them against what must follow."""

from math import cos, exp, pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from lander.laws.leg_inertia import Base
from lander.laws.plume import Plume, plume_force
from lander.laws.reaction_control import Pulse, pulse_share, pulse_slope
from lander.laws.slosh import Pendulum, Sway, slosh_wrench, sway_acceleration
from lander.laws.vectors import ZERO, add, cross
from lander.units.guidance_control import GuidanceControl
from lander.units.lunar_lander import LunarLander
from lander.units.propellant_slosh import PropellantSlosh

G = 1.63


def twin(**parameters: Any) -> LunarLander:
    """The whole vehicle ten metres up; `rcs__torque` is the parameter rcs.torque."""
    one = LunarLander(instance_name="twin")
    one["position_start"], one["tolerance"] = (10.0, 0.0, 0.0), 1e-7
    for name, value in parameters.items():
        one[name.replace("__", ".")] = value
    one.setup_experiment(0.0, None, None)
    one.exit_initialization_mode()
    assert one.stepping, one.message
    return one


def flown(one: LunarLander, seconds: float, step: float = 0.01) -> LunarLander:
    """The unit after some time."""
    for k in range(round(seconds / step)):
        assert one.do_step(k * step, step), one.message
    return one


def test_the_pendulum_swings_at_the_closed_frequency_and_damps_as_it_should() -> None:
    """Verifies: PropellantSlosh on a body that stands, started by a short push.
    Setup: l = 0.6 m, g = 1.63 m/s2, ζ = 0.02: place = A exp(-ζ ω_0 t) cos(ω t + φ); four seconds in steps of 10 ms.
    Tolerance: 1e-4 of the amplitude: the midpoint rule at 2 ms errs by (ω h)²/24 in phase, 5e-7 a radian.
    """
    one = PropellantSlosh(instance_name="slosh")
    one["mass"] = 200.0
    one.setup_experiment(0.0, None, None)
    one.exit_initialization_mode()
    one["place"] = (0.0, 0.02, 0.0)
    omega, zeta = sqrt(G / 0.6), 0.02
    free = omega * sqrt(1.0 - zeta * zeta)
    for k in range(400):
        assert one.do_step(0.01 * k, 0.01)
        t = 0.01 * (k + 1)
        exact = 0.02 * exp(-zeta * omega * t) * (cos(free * t) + zeta * omega / free * sin(free * t))
        assert one["place"][1] == pytest.approx(exact, abs=2e-6)


def test_without_damping_the_rod_pulls_through_the_hinge() -> None:
    """The frozen mass's load and the slosh's together have no moment about the hinge. Tolerance: rounding."""
    pendulum, sway = Pendulum(300.0, 0.6, 0.0, (0.3, 0.1, -0.2)), Sway((0.0, 1e-3, 2e-3), (0.0, 0.01, -0.02))
    base = Base((1.2, 0.3, -0.1), ZERO, ZERO)
    force, torque = slosh_wrench(pendulum, base, sway)
    rest = (-0.3, 0.1, -0.2)
    frozen = (-300.0 * 1.2, -300.0 * 0.3, 300.0 * 0.1)
    total, moment = add(force, frozen), add(torque, cross(rest, frozen))
    assert np.array(moment) == pytest.approx(np.array(cross(pendulum.hinge, total)), abs=1e-9 * 300.0)
    assert sway_acceleration(pendulum, base, Sway(ZERO, ZERO)) == (0.0, -0.3, 0.1)


def test_a_sloshing_vehicle_and_its_pendulum_keep_their_momentum_and_the_coupled_frequency() -> None:
    """Verifies: slosh inside the twin: the stage solves for the accelerations it follows.
    Setup: hinge at the centre of mass plus l, so that the bob's rest is at the origin and only translation couples; vertical thrust m g
    over the body; free: ω² = (a_x / l) M / (M - m), legs hanging.
    Tolerance: 1e-3 of the frequency, from zero crossings of the bob's place at 2 ms; legs swing by less than that.
    """
    one = twin(slosh__mass=700.0, slosh__damping=0.0, slosh__hinge=(0.6, 0.0, 0.0), guidance__thrust_before_contact=7063.5 * G)
    one["bob"][0] = 0.01
    places = []
    for k in range(2000):
        assert one.do_step(0.002 * k, 0.002), one.message
        places.append(float(one["bob"][0]))
        if k == 99:  # before the vehicle has tilted
            assert 7063.5 * one["body.velocity"][1] == pytest.approx(-700.0 * one["bob"][2], rel=0.01)
    signs = np.sign(places)
    crossings = [0.002 * (k + 1 + places[k] / (places[k] - places[k + 1])) for k in np.flatnonzero(signs[1:] != signs[:-1])]
    omega = pi / np.diff(crossings).mean()
    assert omega == pytest.approx(sqrt(G / 0.6 * 7063.5 / (7063.5 - 700.0)), rel=1e-3)


def test_the_ground_effect_is_the_exponential_and_none_without_thrust() -> None:
    plume = Plume(0.2, 1.5, 3.6)
    assert plume_force(plume, 4000.0, 3.6) == pytest.approx(800.0)
    assert plume_force(plume, 4000.0, 5.1) == pytest.approx(800.0 / exp(1.0))
    assert plume_force(plume, 0.0, 3.6) == 0.0


def test_a_pulse_changes_the_angular_momentum_by_its_impulse() -> None:
    """Verifies: rcs inside the twin, edges between steps. Tolerance: 1e-6 of the impulse, tolerance 1e-7 m/s a step."""
    one = flown(twin(rcs__torque=(100.0, 0.0, 0.0), rcs__start=0.1234, rcs__duration=0.0777), 0.3)
    assert 16492.0 * one["body.angular_velocity"][0] == pytest.approx(100.0 * 0.0777, rel=5e-3)
    assert one.value("effects.work") == pytest.approx(0.5 * 16492.0 * one["body.angular_velocity"][0] ** 2, rel=0.02)


def test_mean_and_slope_of_a_pulse_keep_its_impulse_and_first_moment() -> None:
    pulse, t, step = Pulse((1.0, 0.0, 0.0), 0.13, 0.4), 0.1, 0.1
    assert pulse_share(pulse, t, step) == pytest.approx(0.7)
    fine = (np.arange(100000) + 0.5) * step / 100000
    moment = ((fine >= 0.03) * (fine - 0.5 * step)).mean() * step
    assert pulse_slope(pulse, t, step) * step**3 / 12.0 == pytest.approx(moment, rel=1e-4)


def test_swirl_is_a_torque_about_x_in_proportion_to_thrust() -> None:
    one = GuidanceControl(instance_name="guidance")
    one["thrust_before_contact"], one["swirl"], one["thrust_offset"] = 5000.0, 0.02, (0.01, -0.03)
    one.setup_experiment(0.0, None, None)
    one.exit_initialization_mode()
    assert one.do_step(0.0, 0.01)
    assert one["engine.torque_mean"] == pytest.approx([100.0, -150.0, -50.0])
    assert one.value("engine.thrust_mean") == 5000.0


NULLS: list[dict[str, Any]] = [
    {"guidance.decay_time": 2.0, "guidance.swirl": 0.1, "guidance.thrust_offset": (0.1, 0.1)},
    {"plume.height": 2.0, "plume.rest_height": 1.0},
    {"slosh.length": 2.0, "slosh.damping": 0.5, "slosh.hinge": (1.0, 1.0, 1.0)},
    {"rcs.start": 0.01, "rcs.duration": 0.01},
    {"body_term.axis": 5, "body_term.basis": 6},
]


@pytest.mark.parametrize("null", NULLS, ids=lambda null: next(iter(null)).partition(".")[0])
def test_an_effect_of_no_size_changes_no_bit(null: dict[str, Any]) -> None:
    def landed(parameters: dict[str, Any]) -> bytes:
        one = LunarLander(instance_name="twin")
        for name, value in {
            "position_start": (3.63, 0.0, 0.0),
            "velocity_start": (-0.5, -0.2, 0.0),
            "tolerance": 1e-4,
            **parameters,
        }.items():
            one[name] = value
        one.setup_experiment(0.0, None, None)
        one.exit_initialization_mode()
        assert one.stepping, one.message
        one["engine.force"] = (5000.0, 0.0, 0.0)
        flown(one, 0.15)
        return one.span("body.position", f"soil{4}.contact_time").tobytes()

    assert landed(null) == landed({})


def test_the_engine_inside_is_guidance_through_the_port() -> None:
    """Verifies: thrust from the twin's own first contact, corners of the table between steps.
    Setup: a landing of 0.4 s; the port is given the same law by its contact time, in intervals that end at its corners.
    Tolerance: 1e-6 of rates and velocities: both integrate at 1e-7 m/s a step, and contact is located within 10 us.
    """
    start = {"position_start": (3.65, 0.0, 0.0), "velocity_start": (-0.5, -0.2, 0.0), "roll_start": 0.005}
    law = {"guidance__thrust_before_contact": 5000.0, "guidance__thrust_start": 4000.0, "guidance__decay_time": 0.2}
    inside = flown(twin(**start, **law), 0.4)
    contact = min(t for k in range(1, 5) if (t := inside.value(f"soil{k}.contact_time")) >= 0.0)
    one, now = twin(**start, guidance__thrust_before_contact=0.0), 0.0
    instants = sorted({round(0.01 * k, 9) for k in range(1, 41)} | {contact, contact + 0.2})
    for end in instants:
        middle = 0.5 * (now + end)
        before, after = middle < contact, middle >= contact + 0.2
        one["engine.force"] = (5000.0 if before else 0.0 if after else 4000.0 * (1.0 - (now - contact) / 0.2), 0.0, 0.0)
        one["engine.force_slope"] = (0.0 if before or after else -20000.0, 0.0, 0.0)
        assert one.do_step(now, end - now), one.message
        now = end
    assert inside["body.velocity"] == pytest.approx(one["body.velocity"], abs=5e-5)
    assert inside["body.angular_velocity"] == pytest.approx(one["body.angular_velocity"], abs=5e-5)
    assert inside.value("effects.work") == pytest.approx(one.value("engine.work"), rel=1e-4)
