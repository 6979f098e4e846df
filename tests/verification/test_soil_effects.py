"""Effects of the regolith beyond the paper: closed forms, energy over closed cycles, tangents by differences, null values bit for bit."""

from collections.abc import Callable
from math import exp, tanh
from pathlib import Path

import numpy as np
import pytest
from apollo_samples import PAD
from lander.laws.footpad import DATUM, PadMotion, pad_wrench, start_memory
from lander.laws.generic_terms import AGAINST_MOTION, ALWAYS, RISING, SINKING, NormalTerm
from lander.laws.soil import PUBLISHED, RATE_INDEPENDENT, UNLATCHED, Soil, friction_scale, latched, normal_force
from lander.laws.soil_effects import SoilEffects
from lander.laws.soil_stepping import InterfaceModel, PadStart, Shift, step_soil
from lander.laws.surface import inclined_plane
from lander.laws.tangent_term import AGAINST_SLIDE, AGAINST_SLIP, TangentTerm
from lander.laws.vectors import ZERO, Vector, identity
from lander.shell.reference import reference_text
from lander.units.lunar_lander import LunarLander
from lander.units.regolith_contact import EFFECTS, RegolithContact
from scipy.spatial.transform import Rotation

FOLDER = Path(__file__).parents[2] / "fmus" / "reference"

BASE = Soil(PUBLISHED, 30000.0, 1.5, 3000.0, 0.1, 1e-4, 1e-4, 0.36, 290.8, 1e-3)
LEVEL, SLOPE = inclined_plane(0.0, 0.0), inclined_plane(0.08, -0.2)
FAST = 0.3  # m/s
EACH = {
    "layer": SoilEffects(layer_stiffness=2e5, layer_depth=0.02),
    "drag": SoilEffects(inertial_drag=4e3),
    "adhesion": SoilEffects(True, adhesion=200.0),
    "rebound": SoilEffects(True, rebound_share=0.4, rebound_depth=5e-3),
    "stribeck": SoilEffects(stribeck_rise=0.2, stribeck_velocity=0.3),
    "term": SoilEffects(True, normal_term=NormalTerm(150.0, 1.0, 2.0, AGAINST_MOTION)),
    "sinking": SoilEffects(True, normal_term=NormalTerm(150.0, 0.5, 1.0, SINKING)),
    "rising": SoilEffects(True, normal_term=NormalTerm(150.0, 1.0, 0.0, RISING)),
    "always": SoilEffects(True, normal_term=NormalTerm(150.0, 2.0, 1.0, ALWAYS)),
    "slip": SoilEffects(tangent_term=TangentTerm(100.0, 1.0, 1.0, 1.0, AGAINST_SLIP)),
    "slide": SoilEffects(tangent_term=TangentTerm(100.0, 1.0, 2.0, 0.5, AGAINST_SLIDE)),
}
EACH["all"] = SoilEffects(
    True, 2e5, 0.02, 4e3, 200.0, 0.4, 5e-3, 0.2, 0.3, NormalTerm(150.0, 1.0, 1.0, ALWAYS), TangentTerm(100.0, 1.0, 1.0, 1.0, AGAINST_SLIP)
)
LAWS = pytest.mark.parametrize("law", [PUBLISHED, RATE_INDEPENDENT], ids=["published", "ours"])


def soil_with(effects: SoilEffects, law: int = PUBLISHED, **changes: float) -> Soil:
    """The base soil with effects and changed numbers."""
    return BASE._replace(law=law, effects=effects, **changes)


def test_the_reference_experiments_are_what_they_were() -> None:
    """Verifies: at null, RegolithContact and LunarLander give their stored results.
    Setup: the stimuli of the units, in process, against fmus/reference.
    Tolerance: 1e-9 of a column's largest value, another machine's library functions; on the machine that stored them the text is equal.
    """
    for unit in (RegolithContact, LunarLander):
        found, stored = (text.splitlines() for text in (reference_text(unit), (FOLDER / f"{unit.__name__}.csv").read_text()))
        names = [line for line in found if line.startswith(("#", "time"))]
        assert names == [line for line in stored if line.startswith(("#", "time"))]
        ours, theirs = (np.array([line.split(",") for line in text[len(names) :]], float) for text in (found, stored))
        assert (np.abs(ours - theirs).max(axis=0) <= 1e-9 * np.abs(theirs).max(axis=0) + 1e-12).all()  # 1e-12: columns of rounding


SECOND = ("layer_depth", "rebound_depth", "stribeck_velocity")  # what does nothing without its coefficient


def test_a_null_coefficient_is_the_same_to_the_bit() -> None:
    """Verifies: with every coefficient null, depths, velocities, exponents and phases move no bit of either unit.
    Setup: the reference experiments as they are, and with all of those changed.
    Tolerance: none.
    """
    others = [r for r in EFFECTS if r.name in SECOND or r.name.startswith(("normal_term_", "tangent_term_"))]
    assert len(others) == 3 + 3 + 4
    for unit, prefix in ((RegolithContact, ""), (LunarLander, "soil.")):
        changed = tuple((prefix + r.name, 1.0 if r.kind == "Integer" else 0.5) for r in others)
        odd = type(unit.__name__, (unit,), {"reference_parameters": (*unit.reference_parameters, *changed)})
        plain, moved = ([x for x in reference_text(u).splitlines() if x[0] != "#"] for u in (unit, odd))
        assert plain == moved


def test_every_effect_reaches_one_leg_of_the_twin_with_the_footpads_share(random: np.random.Generator) -> None:
    """Verifies: `soil.NAME[k]` of LunarLander becomes soil k's effects, RegolithContact's `NAME` its own: forces a fifth to each point.
    Setup: random values for pad 3; the records that the laws get.
    Tolerance: 1e-15: a fifth by multiplication.
    """
    values = {r.name: float(random.integers(0, 2)) if r.kind == "Integer" else float(random.uniform(0.1, 1.0)) for r in EFFECTS}
    twin, unit = LunarLander(instance_name="twin"), RegolithContact(instance_name="unit")
    for name, value in values.items():
        twin[f"soil.{name}"][2], unit[name] = value, value
    twin.prepare()
    unit.prepare()
    v, fifth = values, 0.2
    expected = [True, fifth * v["layer_stiffness"], v["layer_depth"], fifth * v["inertial_drag"], fifth * v["adhesion"]]
    expected += [v["rebound_share"], v["rebound_depth"], v["stribeck_rise"], v["stribeck_velocity"]]
    terms = [[v[name] for name in values if name.startswith(term)] for term in ("normal_term", "tangent_term")]
    for effects in (twin.vehicle.soils[2].effects, unit.soil.effects):
        assert list(effects[:9]) == pytest.approx(expected, rel=1e-15)
        for found, numbers in zip(effects[9:], terms, strict=True):
            assert list(found) == pytest.approx([fifth * numbers[0], *numbers[1:]], rel=1e-15)
    assert all(not soil.effects.normal and soil.effects.adhesion == 0.0 for k, soil in enumerate(twin.vehicle.soils) if k != 2)


@pytest.mark.parametrize("record", EFFECTS, ids=lambda r: r.name)
def test_values_out_of_bounds_are_refused_by_name(record: object) -> None:
    """Verifies: a line that names the variable, in the unit and in the twin."""
    for unit, name in ((RegolithContact, record.name), (LunarLander, f"soil.{record.name}")):
        if record.minimum is None:
            continue
        one = unit(instance_name="one")
        one[name] = record.minimum - 1.0 if record.minimum == 0.0 else 0.0
        one.setup_experiment(0.0, None, None)
        complaint = one.settle()
        assert complaint is not None
        assert name in complaint
        assert "\n" not in complaint


def falling(effects: SoilEffects, law: int, mass: float, speed: float, time: float) -> tuple[float, float, float]:
    """Speed, depth and work taken by the soil of a free mass on one footpad after `time`, from the surface down at `speed`."""
    bare = Soil(law, 1e-9, 1.0, 0.0, 0.0, 1e-4, 1e-4, 0.0, 0.0, 1e-3, effects)
    none = identity(0.0)
    model = InterfaceModel(ZERO, identity(1.0 / mass), none, none, ZERO, ZERO, (1.0, 1.0, 1.0), 0.0, ZERO)
    start = PadStart((0.10 - 1e-9, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), (-speed, 0.0, 0.0), ZERO)
    memory = np.zeros((5, 8))
    start_memory(LEVEL, PAD, PadMotion(start.position, identity(1.0), start.velocity, ZERO), memory)
    at, _, _, course, ok = step_soil(bare, LEVEL, PAD, model, start, Shift(ZERO, ZERO), memory, time, 1e-4)
    assert ok
    return -at.velocity[0], 0.10 - at.position[0], -course.work


@LAWS
def test_a_mass_under_inertial_drag_slows_as_the_closed_form(law: int) -> None:
    """Verifies: v = v₀/(1 + A v₀ t/m), δ = m/A ln(1 + A v₀ t/m), and the energy lost is the work on the soil.
    Setup: 100 kg at 0.6 m/s into soil with hardly a spring, A = 2000 N s2/m2 for the footpad, 0.1 s; steps of 0.1 ms.
    Tolerance: 1e-6, SDIRK2's (h A v/m)² ~ 1e-6 with small constants.
    """
    mass, drag, speed, time = 100.0, 2000.0, 0.6, 0.1
    v, depth, work = falling(SoilEffects(inertial_drag=drag / 5), law, mass, speed, time)
    assert v == pytest.approx(speed / (1.0 + drag * speed * time / mass), rel=1e-6)
    assert depth == pytest.approx(mass / drag * np.log(1.0 + drag * speed * time / mass), rel=1e-6)
    assert work == pytest.approx(0.5 * mass * (speed**2 - v**2), rel=1e-6)


@LAWS
def test_the_generic_term_can_say_inertial_drag_and_layer(law: int) -> None:
    """Verifies: phase 1 with b = 2 is the drag; the units 0.01 m and 0.1 m/s; δ̇² of A = c/0.01.
    Setup: no rebound band in play (virgin soil, sinking).
    Tolerance: 1e-12: tanh is 1 at 0.3 m/s.
    """
    drag = normal_force(soil_with(SoilEffects(inertial_drag=4e3), law), 0.03, FAST, UNLATCHED)
    term = normal_force(soil_with(SoilEffects(True, normal_term=NormalTerm(40.0, 0.0, 2.0, SINKING)), law), 0.03, FAST, UNLATCHED)
    assert term == pytest.approx(drag, rel=1e-12)
    spring = normal_force(soil_with(SoilEffects(True, normal_term=NormalTerm(70.0, 1.0, 0.0, ALWAYS)), law), 0.03, FAST, UNLATCHED)
    assert spring.force - normal_force(BASE._replace(law=law), 0.03, FAST, UNLATCHED).force == pytest.approx(210.0, rel=1e-9)


@LAWS
def test_the_layer_begins_at_its_depth(law: int) -> None:
    """Verifies: F_n = K_n δ^p + K_l (δ - δ_l) below δ_l, the base law above it.
    Tolerance: 1e-12.
    """
    soil, bare = (soil_with(effects, law, damping=0.0) for effects in (EACH["layer"], SoilEffects()))
    assert normal_force(soil, 0.02, FAST, UNLATCHED) == normal_force(bare, 0.02, FAST, UNLATCHED)
    for depth in (0.021, 0.05):
        more = normal_force(soil, depth, FAST, UNLATCHED).force - normal_force(bare, depth, FAST, UNLATCHED).force
        assert more == pytest.approx(2e5 * (depth - 0.02), rel=1e-9)


@LAWS
def test_adhesion_pulls_while_rising_only_and_gives_no_friction(law: int) -> None:
    """Verifies: F_n = -A tanh(-δ̇/ṙ) rising out of the band, nothing added sinking; a pad that is pulled slides without friction.
    Setup: datum far below, so that the law itself is silent.
    Tolerance: 1e-12.
    """
    soil = soil_with(EACH["adhesion"], law, plowing=0.0)
    for rate in (-1e-5, -1e-4, -0.2):
        assert normal_force(soil, 0.02, rate, 0.05).force == pytest.approx(-200.0 * tanh(-rate / 1e-4), rel=1e-9)
    assert normal_force(soil, 0.02, FAST, UNLATCHED) == normal_force(BASE._replace(law=law), 0.02, FAST, UNLATCHED)
    assert normal_force(soil, -1e-9, -FAST, 0.05).force == 0.0
    at = motion((0.10 - 0.02, 0.0, 0.0), velocity=(0.2, 0.5, 0.0))
    memory = memory_of(at, LEVEL)
    memory[:, DATUM] = 0.05
    wrench, _ = pad_wrench(soil, LEVEL, PAD, at, memory)
    assert wrench.force == pytest.approx((-1000.0, 0.0, 0.0), rel=1e-12)


@LAWS
def test_the_rebound_gives_back_its_share_over_its_depth(law: int) -> None:
    """Verifies: ρ K_n δ_MAX^p (1 - (δ_MAX - δ)/b_r) at any rate, and work ½ ρ K_n δ_MAX^p b_r on the way out.
    Setup: datum 5 cm; quadrature from the datum up at 0.2 m/s, where law 1 is silent.
    Tolerance: 1e-6; our law's own band of 0.1 mm is shorter than the first point off the datum matters: 2 %.
    """
    soil = soil_with(EACH["rebound"], law)
    full = 0.4 * 30000.0 * 0.05**1.5
    for above, share in ((1e-3, 0.8), (2.5e-3, 0.5), (6e-3, 0.0)):
        for rate in (-0.2, 0.0):
            assert normal_force(soil, 0.05 - above, rate, 0.05).force == pytest.approx(share * full, rel=1e-6, abs=1e-9)
    path = np.linspace(0.05, 0.04, 10001)
    back = np.trapezoid([normal_force(soil, d, -0.2, 0.05).force for d in path], -path)
    assert back == pytest.approx(0.5 * full * 5e-3, rel=1e-6 if law == PUBLISHED else 0.05)
    assert normal_force(soil, 0.04, -FAST, UNLATCHED).force == normal_force(BASE._replace(law=law), 0.04, -FAST, UNLATCHED).force


def test_friction_rises_toward_rest_after_stribeck() -> None:
    """Verifies: F_t/F_n = (μ + rise exp(-(v/v_s)²)) v/sqrt(v² + v_slip²).
    Tolerance: 1e-12.
    """
    soil = soil_with(EACH["stribeck"])
    for v in (1e-4, 0.02, 0.3, 3.0):
        mu = 0.36 + 0.2 * exp(-((v / 0.3) ** 2))
        assert friction_scale(soil, v) * v == pytest.approx(mu * v / np.hypot(v, 1e-3), rel=1e-12)


def cycle(soil: Soil, deep: float, top: float, speed: float, rounds: int = 2) -> float:
    """Work of the pad on one point, J, for δ going from the surface to `deep` and back to `top` and down again, twice: δ by cosines."""
    time = np.linspace(0.0, 1.0, 4001)
    work, datum = 0.0, UNLATCHED
    middle = 0.5 * (deep + top)
    legs = [(0.0, deep)] + [(deep, top), (top, deep)] * rounds + [(deep, -1e-3)]
    assert top < middle < deep
    for a, b in legs:
        span = abs(b - a) / speed * 2.0
        depth = a + (b - a) * 0.5 * (1.0 - np.cos(np.pi * time))
        rate = (b - a) * 0.5 * np.pi * np.sin(np.pi * time) / span
        power = np.empty_like(time)
        for k, (d, v) in enumerate(zip(depth.tolist(), rate.tolist(), strict=True)):
            power[k] = normal_force(soil, d, v, datum).force * v
            datum = latched(soil, d, v, datum)
        work += float(np.trapezoid(power, dx=span / (len(time) - 1)))
    return work


def silent(law: int, effects: SoilEffects) -> Soil:
    """A soil whose own law gives next to nothing, so that only the effect's work is left."""
    return Soil(law, 1e-9, 1.0, 0.0, 0.0, 1e-4, 1e-4, 0.0, 0.0, 1e-3, effects)


@LAWS
@pytest.mark.parametrize("deep", [2e-3, 0.04])
@pytest.mark.parametrize("name", ["layer", "drag", "adhesion", "rebound", "term", "sinking"])
def test_dissipative_effects_take_energy_over_closed_cycles(law: int, deep: float, name: str) -> None:
    """Verifies: ∮ F dδ > 0 with the effect in the whole law, and the part of drag, adhesion and terms alone is not negative.
    Setup: to 2 mm and to 4 cm at 0.2 m/s, twice between there and half way, then out; quadrature of the law along the path. Rebound with
    ρ = 1 over 5 cm too: more than the depth.
    Tolerance: 1e-9 J of quadrature.
    """
    effects = EACH[name]
    assert cycle(soil_with(effects, law), deep, 0.5 * deep, 0.2) > 0.0
    if name == "rebound":
        whole = cycle(soil_with(SoilEffects(True, rebound_share=1.0, rebound_depth=0.05), law), deep, 0.5 * deep, 0.2)
        assert whole > 0.0
    if name in ("drag", "adhesion", "term", "sinking"):
        assert cycle(silent(law, effects), deep, 0.5 * deep, 0.2) > -1e-9


def test_generic_terms_keep_or_give_energy_as_said() -> None:
    """Verifies: phase 0 with b = 0 is conservative, phase 2 gives energy to the pad.
    Setup: the cycle, from above the surface to above the surface; a = 1, so that no force jumps at the surface.
    Tolerance: 1e-6 of the energy that goes in and out, quadrature's.
    """
    spring = silent(RATE_INDEPENDENT, SoilEffects(True, normal_term=NormalTerm(100.0, 1.0, 0.0, ALWAYS)))
    assert abs(cycle(spring, 0.04, 0.02, 0.2)) < 1e-6 * 0.5 * 100.0 / 0.01 * 0.04**2
    assert cycle(silent(RATE_INDEPENDENT, EACH["rising"]), 0.04, 0.02, 0.2) < -1.0


@pytest.mark.parametrize(("phase", "sign"), [(AGAINST_SLIP, 1.0), (AGAINST_SLIDE, 0.0)])
def test_tangential_terms_take_or_keep_energy_on_a_closed_path(phase: int, sign: float) -> None:
    """Verifies: against slip the work of a closed path in the ground is taken; against slide, a spring, it is zero.
    Setup: the pad goes round an ellipse in the plane at constant depth, its slide being its place; work of the wrench without friction.
    Tolerance: against slip c times the length of the path within 1e-3 (tanh at 1 mm/s of 0.1 to 0.2 m/s); against slide 1e-6 of that.
    """
    effects = SoilEffects(tangent_term=TangentTerm(20.0, 0.0, 0.0, 0.0 if phase == AGAINST_SLIP else 1.0, phase))
    soil = silent(RATE_INDEPENDENT, effects)
    time = np.linspace(0.0, 6.0, 2001)
    angle = 2.0 * np.pi * time / time[-1]
    powers, lengths = [], []
    memory = memory_of(motion((0.10 - 0.01, 0.2, 0.0)), LEVEL)
    for a in angle:
        place = (0.10 - 0.01, 0.2 * np.cos(a), 0.1 * np.sin(a))
        velocity = (0.0, -0.2 * np.sin(a) * 2.0 * np.pi / 6.0, 0.1 * np.cos(a) * 2.0 * np.pi / 6.0)
        wrench, _ = pad_wrench(soil, LEVEL, PAD, motion(place, velocity=velocity), memory)
        powers.append(-np.dot(wrench.force, velocity))
        lengths.append(np.linalg.norm(velocity))
    work, length = (np.trapezoid(x, time) for x in (powers, lengths))
    assert work == pytest.approx(sign * 5 * 20.0 * length, rel=1e-3, abs=1e-6 * 5 * 20.0 * length)


def five(f: Callable[[float], float], e: float) -> float:
    """Five-point difference."""
    return (8 * (f(e) - f(-e)) - (f(2 * e) - f(-2 * e))) / (12 * e)


@LAWS
@pytest.mark.parametrize("name", EACH)
def test_derivatives_by_depth_and_rate_with_every_effect(name: str, law: int, random: np.random.Generator) -> None:
    """Verifies: dF/dδ and dF/dδ̇, which Newton takes, for each effect and all together, sinking and rising, in and out of the bands.
    Setup: random depths, rates and data off the kinks (layer's depth, datum, rest, band); five-point differences.
    Tolerance: 1e-5 relative, or cancellation: 1e-16 F/1e-7 of 2e4 N; at a point where force and rebound exchange places the sides differ.
    """
    soil, e = soil_with(EACH[name], law), 1e-7
    fast, slow = random.uniform(0.01, 0.5, 12), random.uniform(2e-5, 1.2e-4, 8)
    signs = np.resize([1.0, -1.0], 20)
    for rate in (signs * np.concatenate([fast, slow])).tolist():
        for above in (random.uniform(1e-5, 9e-5), random.uniform(2e-3, 4e-3), -random.uniform(1e-3, 1e-2), None):
            depth = random.uniform(0.025, 0.08)
            datum = UNLATCHED if above is None else depth + above
            law_ = normal_force(soil, depth, rate, datum)
            by_depth = five(lambda x, d=depth, v=rate, m=datum: normal_force(soil, d + x, v, m).force, e)
            by_rate = five(lambda x, d=depth, v=rate, m=datum: normal_force(soil, d, v + x, m).force, e)
            assert law_.stiffness == pytest.approx(by_depth, rel=1e-5, abs=2e-2), (rate, depth, datum)
            assert law_.damping == pytest.approx(by_rate, rel=1e-5, abs=2e-2), (rate, depth, datum)


def motion(place: Vector, turn: Vector = ZERO, velocity: Vector = ZERO, rate: Vector = ZERO) -> PadMotion:
    """A pad at `place`, turned by a rotation vector."""
    rows = tuple(tuple(map(float, row)) for row in Rotation.from_rotvec(turn).as_matrix())
    return PadMotion(tuple(map(float, place)), rows, tuple(map(float, velocity)), tuple(map(float, rate)))


def memory_of(at: PadMotion, surface: object) -> np.ndarray:
    """Virgin memory of a pad at `at`."""
    memory = np.zeros((5, 8))
    start_memory(surface, PAD, at, memory)
    return memory


@LAWS
@pytest.mark.parametrize("sinking", [0.3, -0.2, 6e-5])
@pytest.mark.parametrize("name", EACH)
def test_the_pads_tangents_with_every_effect(name: str, sinking: float, law: int) -> None:
    """Verifies: the blocks of `PadTangents` by place, velocity and rate.
    Setup: a tilted pad that slides on the slope, some points virgin, some in their band, some rising out of it; five-point differences by
    place, velocity and rate. The blocks by turn, k_xr and k_rr, are made of k_xx and the arms (test_footpad.py).
    Tolerance: 2e-5 of each block's largest element, at least 0.02.
    """
    soil = soil_with(EACH[name], law)
    normal = np.array(SLOPE.normal)
    place = (0.10 - 0.03) * normal + np.array([0.0, 0.4, -0.3])
    velocity = np.cross(normal, (0.1, 0.3, -0.2)) - sinking * normal
    turn = np.array([0.1, 0.01, 0.02])
    memory = memory_of(motion(place + np.array([0.001, 0.01, 0.02]), turn), SLOPE)
    depths = memory_of(motion(place, turn), SLOPE)[:, 7]
    memory[:, DATUM] = [depths[0] + 4e-5, 0.05, UNLATCHED, 0.04, 0.02]
    _, blocks = pad_wrench(soil, SLOPE, PAD, motion(place, turn, velocity), memory)

    def force_and_torque(x: np.ndarray, v: np.ndarray) -> np.ndarray:
        wrench, _ = pad_wrench(soil, SLOPE, PAD, motion(place + x, turn, velocity + v), memory)
        return np.array([*wrench.force, *wrench.torque])

    axes, still = np.eye(3), np.zeros(3)
    by_place = np.column_stack([-five_vector(lambda e, a=a: force_and_torque(e * a, still), 1e-7) for a in axes])
    by_speed = np.column_stack([-five_vector(lambda e, a=a: force_and_torque(still, e * a), 1e-7) for a in axes])
    by_rate = np.column_stack([-five_vector(lambda e, a=a: turned(soil, place, turn, velocity, e * a, memory), 1e-7) for a in axes])
    expected_blocks = [block for both in (by_place, by_speed, by_rate) for block in (both[:3], both[3:])]
    found_blocks = (blocks.k_xx, blocks.k_rx, blocks.c_xx, blocks.c_rx, blocks.c_xr, blocks.c_rr)
    for found, expected in zip(found_blocks, expected_blocks, strict=True):
        np.testing.assert_allclose(found, expected, atol=2e-5 * max(np.abs(expected).max(), 1e3))


def turned(soil: Soil, place: np.ndarray, turn: np.ndarray, velocity: np.ndarray, rate: np.ndarray, memory: np.ndarray) -> np.ndarray:
    """Force and torque at an angular velocity."""
    wrench, _ = pad_wrench(soil, SLOPE, PAD, motion(place, turn, velocity, rate), memory)
    return np.array([*wrench.force, *wrench.torque])


def five_vector(f: Callable[[float], np.ndarray], e: float) -> np.ndarray:
    """Five-point difference of a vector."""
    return (8 * (f(e) - f(-e)) - (f(2 * e) - f(-2 * e))) / (12 * e)
