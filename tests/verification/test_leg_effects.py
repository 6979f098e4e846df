"""Effects of the struts beyond the paper: rate hardening, the generic strut term, an offset centre of mass; null values bit for bit."""

from math import tanh
from pathlib import Path

import numpy as np
import pytest
from apollo_samples import core, leg_at
from lander.laws.generic_terms import AGAINST_MOTION, ALL_STRUTS, ALWAYS, PRIMARIES, SECONDARIES, StrutTerm, strut_term
from lander.laws.honeycomb import core_force
from lander.laws.leg import Crush, Leg, crushed, shape, strut_loads
from lander.laws.leg_dynamics import leg_motion, tangents
from lander.laws.leg_inertia import Base
from lander.laws.leg_joints import joint_damping
from lander.laws.vectors import ZERO, dot
from lander.shell.reference import reference_text
from lander.units.gear_leg import EFFECTS, GearLeg
from lander.units.lunar_lander import LunarLander

FOLDER = Path(__file__).parents[2] / "fmus" / "reference"

VIRGIN = Crush(1e-3, 1e-3, 1e-3, 1e-3, 1e-3)
CORE = core((20017.0, 42358.0), 0.254, 0.812, 1e-3, 1.0)
TERMS = {
    "against stroke": StrutTerm(400.0, 1.0, 0.0, ALWAYS, ALL_STRUTS),
    "against motion": StrutTerm(400.0, 1.0, 2.0, AGAINST_MOTION, ALL_STRUTS),
    "dry": StrutTerm(400.0, 0.0, 0.0, AGAINST_MOTION, PRIMARIES),
    "mixed": StrutTerm(400.0, 0.5, 1.0, ALWAYS, SECONDARIES),
}


def test_the_leg_at_null_is_what_it_was() -> None:
    """Verifies: GearLeg gives its stored result; exponents, phase and struts without a coefficient move no bit of it or of LunarLander.
    Setup: the units' stimuli, in process, against fmus/reference and against each other.
    Tolerance: 1e-9 of a column's largest value (another machine's library functions) against the file; none against each other.
    """
    rows, stored = ([x for x in t.splitlines() if x[0] != "#"] for t in (reference_text(GearLeg), (FOLDER / "GearLeg.csv").read_text()))
    assert rows[0] == stored[0]
    ours, theirs = (np.array([x.split(",") for x in lines[1:]], float) for lines in (rows, stored))
    assert (np.abs(ours - theirs).max(axis=0) <= 1e-9 * np.abs(theirs).max(axis=0) + 1e-12).all()
    odd = (("strut_term_stroke", 1.0), ("strut_term_rate", 0.5), ("strut_term_phase", 3.0), ("strut_term_struts", 2.0))
    for unit in (GearLeg, LunarLander):
        changed = type(unit.__name__, (unit,), {"reference_parameters": (*unit.reference_parameters, *odd)})
        plain, moved = ([x for x in reference_text(u).splitlines() if x[0] != "#"] for u in (unit, changed))
        assert plain == moved


def test_every_effect_of_the_struts_reaches_all_legs_of_the_twin() -> None:
    """Verifies: LunarLander hands NAME on to each of its legs as GearLeg does to its own.
    Tolerance: exact; joints 1e-15 m.
    """
    values = {"rate_hardening": 0.3, "strut_term": 50.0, "strut_term_stroke": 1.0, "strut_term_rate": 0.5, "strut_term_phase": 3.0}
    twin, unit, plain = LunarLander(instance_name="twin"), GearLeg(instance_name="unit"), LunarLander(instance_name="plain")
    for one in (twin, unit):
        for name, value in {**values, "strut_term_struts": 1.0, "cg_offset": (0.03, -0.02)}.items():
            one[name] = value
    for one in (twin, unit, plain):
        one.prepare()
    for leg, bare in zip((*twin.vehicle.legs, unit.leg), (*plain.vehicle.legs, plain.vehicle.legs[0]), strict=True):
        assert leg.term == StrutTerm(50.0, 1.0, 0.5, AGAINST_MOTION, PRIMARIES)
        assert {leg.primary.hardening, leg.tension.hardening, leg.compression.hardening} == {0.3}
        for joint in ("upper", "right", "left", "pad"):
            shift = np.subtract(getattr(leg.geometry, joint), getattr(bare.geometry, joint))
            np.testing.assert_allclose(shift, (0.0, -0.03, 0.02), atol=1e-15)
        assert leg.geometry[4:] == bare.geometry[4:]


def test_the_legs_refuse_what_cannot_be() -> None:
    """Verifies: a line that names the variable: bounds, and a phase that struts do not have."""
    for unit in (GearLeg, LunarLander):
        wrong = [(r.name, r.minimum - 1.0) for r in EFFECTS if r.minimum is not None] + [("strut_term_phase", 1.0)]
        for name, value in wrong:
            one = unit(instance_name="one")
            one[name] = value
            one.setup_experiment(0.0, None, None)
            complaint = one.settle()
            assert complaint is not None
            assert name in complaint
            assert "\n" not in complaint


def test_crush_loads_grow_with_the_rate_of_crushing() -> None:
    """Verifies: F = F_s (1 + k ḋ) crushing, both stages; F_s when held or unloading.
    Setup: k = 0.5 s/m on the crushing front, where the weight is 1, and just off it unloading.
    Tolerance: 1e-12.
    """
    hard = CORE._replace(hardening=0.5)
    for d, load in ((0.1, 20017.0), (0.3, 42358.0)):
        for v in (0.01, 0.2, 2.0):
            assert core_force(hard, d, v, d - 1e-4).force == pytest.approx(load * (1.0 + 0.5 * v), rel=1e-12)
        assert core_force(hard, d, -1e-3, d + 2e-4) == core_force(CORE, d, -1e-3, d + 2e-4)


@pytest.mark.parametrize("v", [-0.3, -2e-3, 3e-3, 0.3])
@pytest.mark.parametrize(("d", "crushed"), [(0.05, 0.04), (0.05, 0.0503), (0.2535, 0.2), (0.2535, 0.2539), (0.3, 0.3004), (0.4, 0.3)])
def test_derivatives_of_a_hardening_core(d: float, crushed: float, v: float) -> None:
    """Verifies: dF/dd and dF/dv, crushing and unloading, in the band and at the stage's step.
    Setup: five-point differences of 1e-7.
    Tolerance: 1e-5, or cancellation: 1e-16 of 4e4 N over 1e-7.
    """
    hard, e = CORE._replace(hardening=0.5), 1e-7
    f = {(i, j): core_force(hard, d + i * e, v + j * e, crushed).force for i in range(-2, 3) for j in range(-2, 3)}
    by_d = (8 * (f[1, 0] - f[-1, 0]) - (f[2, 0] - f[-2, 0])) / (12 * e)
    by_v = (8 * (f[0, 1] - f[0, -1]) - (f[0, 2] - f[0, -2])) / (12 * e)
    law = core_force(hard, d, v, crushed)
    assert law.stiffness == pytest.approx(by_d, rel=1e-5, abs=0.1)
    assert law.damping == pytest.approx(by_v, rel=1e-5, abs=0.1)


def test_the_strut_term_is_its_formula() -> None:
    """Verifies: c (|d|/1 cm)^a (|ḋ|/0.1 m/s)^b with the sign of the stroke or of the motion.
    Tolerance: 1e-12.
    """
    for d in (-0.03, 0.002, 0.02):
        for v in (-0.4, 0.05):
            size = 400.0 * (abs(d) / 0.01) ** 1.5 * (abs(v) / 0.1) ** 2
            assert strut_term(StrutTerm(400.0, 1.5, 2.0, ALWAYS), d, v).force == pytest.approx(size * tanh(d / 1e-3), rel=1e-12)
            assert strut_term(StrutTerm(400.0, 1.5, 2.0, AGAINST_MOTION), d, v).force == pytest.approx(size * tanh(v / 1e-3), rel=1e-12)


def placed(leg: Leg, random: np.random.Generator) -> tuple[tuple[float, ...], tuple[float, ...], Crush]:
    """A random place and velocity of the ball joint, and cores that have just unloaded."""
    p = tuple(float(x) for x in np.array(leg.geometry.pad) + random.uniform(-0.08, 0.08, 3))
    v = tuple(float(x) for x in random.uniform(-0.3, 0.3, 3))
    return p, v, Crush(*(d + random.uniform(2e-4, 8e-4) for d in crushed(leg, p, VIRGIN)))


@pytest.mark.parametrize("name", [*TERMS, "hardening"])
def test_a_legs_tangents_and_power_hold_the_effects(name: str, random: np.random.Generator) -> None:
    """Verifies: `tangents` is minus the derivatives of the struts' generalised force; the power of phase 3 and of hardening is the smaller.
    Setup: random places and velocities; five-point differences of Σ F dl/dp, loading and unloading at random.
    Tolerance: 2e-5 of the largest element.
    """
    for _ in range(6):
        leg = leg_at(float(random.uniform(-3.0, 3.0)), term=TERMS.get(name, StrutTerm()))
        if name == "hardening":
            cores = {core: getattr(leg, core)._replace(hardening=0.5) for core in ("primary", "tension", "compression")}
            leg = leg._replace(**cores)
        p, v, crush = placed(leg, random)
        arm = leg.geometry.cylinder

        def q(x: np.ndarray, u: np.ndarray, leg: Leg = leg, crush: Crush = crush, arm: float = arm) -> np.ndarray:
            at = shape(leg, tuple(x.tolist()), tuple(u.tolist()))
            loads, e = strut_loads(leg, at, crush), np.array(at.axis)
            sides = -loads.right.force * np.array(at.right) - loads.left.force * np.array(at.left)
            return loads.primary.force * e + arm / at.length * (sides - e * (e @ sides))

        def minus_slope(f: object, e: float) -> np.ndarray:
            columns = [(8 * (f(e * a) - f(-e * a)) - (f(2 * e * a) - f(-2 * e * a))) / (-12 * e) for a in np.eye(3)]
            return np.column_stack(columns)

        x, u = np.array(p), np.array(v)
        at = shape(leg, p, v)
        stiffness, damping = (np.array(m) for m in tangents(leg, at, strut_loads(leg, at, crush), 0.0, joint_damping(leg, at)))
        damping -= np.array(joint_damping(leg, at))
        by_speed = minus_slope(lambda d, x=x, u=u: q(x, u + d), 1e-7)
        np.testing.assert_allclose(damping, by_speed, atol=2e-5 * max(np.abs(by_speed).max(), 1e3))
        held = minus_slope(lambda d, x=x, u=u: q(x + d, u), 1e-7)
        alone = held_rates(leg, p, v, crush)
        np.testing.assert_allclose(stiffness + alone, held, atol=2e-5 * np.abs(held).max())


def held_rates(leg: Leg, p: tuple[float, ...], v: tuple[float, ...], crush: Crush) -> np.ndarray:
    """What `tangents` leaves out: the rates' dependence on p times the struts' damping, by differences, N/m."""

    def rates(x: np.ndarray) -> np.ndarray:
        at = shape(leg, tuple(x.tolist()), v)
        return np.array([-at.stretch, dot(at.right, at.joint_velocity), dot(at.left, at.joint_velocity)])

    at, e = shape(leg, p, v), 1e-6
    loads = strut_loads(leg, at, crush)
    x = np.array(p)
    turned = np.column_stack([(rates(x + e * a) - rates(x - e * a)) / (2 * e) for a in np.eye(3)])
    axis, arm = np.array(at.axis), leg.geometry.cylinder / at.length
    across = [arm * (np.array(u) - axis * (axis @ np.array(u))) for u in (at.right, at.left)]
    forces = (-loads.primary.damping * axis, loads.right.damping * across[0], loads.left.damping * across[1])
    return np.array(sum(np.outer(f, row) for f, row in zip(forces, turned, strict=True)))


def test_the_strut_terms_energy_is_what_is_said() -> None:
    """Verifies: round a closed path a term against the stroke keeps energy (b = 0), one against the motion and hardening take it.
    Setup: the ball joint goes round an ellipse from the undeformed place; work of the struts' loads with the effect less without.
    Tolerance: 1e-6 of the energy in and out for the kept; sign for the taken.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, 4001)
    bare = leg_at(0.3)
    away = np.outer((0.05, 0.0, 0.02), 1.0 - np.cos(angle)) + np.outer((0.0, 0.03, 0.0), np.sin(angle))
    path = np.array(bare.geometry.pad)[:, None] + away
    speed = np.outer((0.05, 0.0, 0.02), np.sin(angle)) + np.outer((0.0, 0.03, 0.0), np.cos(angle))
    hard = bare._replace(**{core: getattr(bare, core)._replace(hardening=0.5) for core in ("primary", "tension", "compression")})

    def taken(leg: Leg) -> np.ndarray:
        powers, crush = [], VIRGIN
        for p, v in zip(path.T.tolist(), speed.T.tolist(), strict=True):
            at = shape(leg, tuple(p), tuple(v))
            loads = strut_loads(leg, at, crush)
            sides = loads.right.force * dot(at.right, at.joint_velocity) + loads.left.force * dot(at.left, at.joint_velocity)
            powers.append(sides - loads.primary.force * at.stretch)
            crush = crushed(leg, tuple(p), crush)
        return np.array(powers)

    null = taken(bare)
    for name, sign in (("against stroke", 0.0), ("against motion", 1.0), ("dry", 1.0)):
        power = taken(bare._replace(term=TERMS[name])) - null
        work, traffic = np.trapezoid(power, angle), np.trapezoid(np.abs(power), angle)
        assert traffic > 1.0
        if sign:
            assert work == pytest.approx(traffic, rel=1e-9)
        else:
            assert abs(work) < 1e-6 * traffic
    assert np.trapezoid(taken(hard) - null, angle) > 1.0


def test_what_the_struts_take_is_booked(random: np.random.Generator) -> None:
    """Verifies: the leg's power of internal forces has the term's own, so that the ledger of energy closes.
    Setup: a leg that moves freely, with and without a dry term on the primary; the difference of the two powers.
    Tolerance: 1e-9 of the power.
    """
    base = Base((1.63, 0.0, 0.0), ZERO, ZERO)
    for _ in range(5):
        bare = leg_at(0.7)
        p, v, crush = placed(bare, random)
        at = shape(bare, p, v)
        own, more = (leg_motion(leg, base, p, v, ZERO, ZERO, crush) for leg in (bare, bare._replace(term=TERMS["dry"])))
        force = strut_term(TERMS["dry"], bare.geometry.length - at.length, -at.stretch).force
        assert more.primary - own.primary == pytest.approx(force, abs=1e-9 * abs(own.primary))
        assert more.power - own.power == pytest.approx(force * at.stretch, rel=1e-6)
        assert force * at.stretch < 0.0


def test_an_offset_centre_of_mass_tips_the_landing() -> None:
    """Verifies: a centre of mass to the right (+Y) of the axis makes a level landing turn right side down, and nothing else.
    Setup: the twin's reference landing without roll, velocity straight down; 0.1 s; 5 cm to the right.
    Tolerance: sign; pitch by symmetry below 1e-9 of it.
    """

    def rates(offset: tuple[float, float]) -> np.ndarray:
        one = LunarLander(instance_name="one")
        one["position_start"], one["velocity_start"], one["cg_offset"] = (3.63, 0.0, 0.0), (-0.5, 0.0, 0.0), offset
        one.setup_experiment(0.0, None, None)
        one.enter_initialization_mode()
        one.exit_initialization_mode()
        for k in range(20):
            assert one.do_step(0.005 * k, 0.005), one.message
        return np.array(one["body.angular_velocity"])

    right, front = rates((0.05, 0.0)), rates((0.0, 0.05))
    assert abs(rates((0.0, 0.0))[1:]).max() < 1e-9
    assert right[2] > 1e-3
    assert abs(right[1]) < 1e-6 * right[2]
    assert front[1] > 1e-3 or front[1] < -1e-3
    assert abs(front[2]) < 1e-6 * abs(front[1])
