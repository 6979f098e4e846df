"""GearLeg: one cantilever leg with its crushable struts and its footpad, at any azimuth."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..laws.generic_terms import AGAINST_MOTION, ALWAYS, StrutTerm
from ..laws.honeycomb import DATUM_WEIGHT, Core, Stop, brake_damping
from ..laws.leg import Leg, disc_inertia
from ..laws.leg_exchange import BOTTOMED, GAVE_UP, advance_leg, start_leg
from ..laws.leg_geometry import GearDimensions, GeometryError, LegGeometry, leg_geometry, moved
from ..shell import Unit, UnitError, input_, output, parameter, state

Array = NDArray[np.float64]


POSE = ("body.position", "body.quaternion")
TWIST = (*POSE, "body.velocity", "body.angular_velocity")
MOTION = (*TWIST, "body.acceleration", "body.angular_acceleration")
GROUND = (*POSE, "pad.contact_stiffness", "pad.contact_damping")
LOADED = (*MOTION, "pad.force", "pad.force_added")


EFFECTS = (  # beyond the paper (decision 9); null unless set
    parameter("cg_offset", (0.0, 0.0), "m", "Y and Z of the centre of mass from the vehicle's axis, frame B", minimum=-1.0, maximum=1.0),
    parameter("rate_hardening", 0.0, "s/m", "k: crush loads times 1 + k times the crushing rate", minimum=0.0),
    parameter("strut_term", 0.0, "N", "generic: F += c (stroke/0.01 m)^a (rate/0.1 m/s)^b"),
    parameter("strut_term_stroke", 0.0, "1", "a", minimum=0.0, maximum=6.0),
    parameter("strut_term_rate", 0.0, "1", "b", minimum=0.0, maximum=6.0),
    parameter("strut_term_phase", 0, "1", "0: against the stroke, 3: against the motion", integer=True, minimum=0, maximum=3),
    parameter("strut_term_struts", 0, "1", "0: all, 1: primaries, 2: secondaries", integer=True, minimum=0, maximum=2),
)


class GearLeg(Unit):
    """A primary strut on a universal joint, whose piston ends in the footpad's ball joint, braced by two secondaries on its cylinder.

    The ball joint's position relative to the body is the leg's only coordinate (three stroking freedoms, no constraint); the pad turns on
    its ball joint. Honeycomb: eqs. 1 to 4 of the paper, stages latching, memory per core, saturated damping, bearing friction, stops.
    Where the soil says how its force answers the pad's motion (pad.contact_* about pad.predicted_velocity) the leg steps with it:
    both sides of the contact know the other's slope, and a pad that sticks to the ground stays put.
    SDIRK2 inside, at most `longest_substep` long. The base moves from its pose and twist at the interval's start with the given
    accelerations.

    mount is what the leg adds to the rigid undeformed leg, which the body carries: with the strut unloaded and the pad free it is near
    zero.
    pad.model_* is the reduced interface model: a = a_f + Y F + A_x (x - x_n - V_b t - A_b t²/2) + A_v (v - v_n - A_b t), frame L.
    Valid for strokes inside the limits of Table 3; beyond, the stops are stiff but finite, and `bottomed` tells.
    """

    description = "One cantilever landing gear leg with honeycomb struts and a footpad on a ball joint."
    required = (*TWIST, "pad.force", "mount.force", "mount.torque", "pad.position", "pad.velocity")
    variables = (
        parameter("azimuth", 0.0, "rad", "of the leg about B's x axis, from +Z to +Y", minimum=-7.0, maximum=7.0),
        parameter("origin_height", 3.62, "m", "B's origin above the base of the undeformed footpads (Table 1)"),
        parameter("footprint_radius", 4.242, "m", "Table 2"),
        parameter("truss_radius_upper", 3.061, "m", "Table 2"),
        parameter("truss_radius_lower", 2.996, "m", "Table 2"),
        parameter("truss_height_upper", 2.874, "m", "above the footpad base, Table 2"),
        parameter("truss_height_lower", 1.19, "m", "above the footpad base, Table 2"),
        parameter("footpad_height", 0.10, "m", "base to ball joint, Table 2"),
        parameter("secondary_truss_width", 2.239, "m", "between the two lower truss points, Table 2"),
        parameter("connection", 1.157, "m", "from the ball joint up the primary to the secondaries, Table 2"),
        parameter("footpad_radius", 0.47, "m", "37 in diameter; not in the paper", minimum=1e-3),
        parameter("primary_strut_mass", 43.1, "kg", "cylinder, Table 1", minimum=0.0),
        parameter("primary_piston_mass", 13.6, "kg", "Table 1", minimum=1e-3),
        parameter("secondary_strut_mass", 5.12, "kg", "each, Table 1", minimum=0.0),
        parameter("footpad_mass", 11.0, "kg", "Table 1", minimum=1e-3),
        parameter("vehicle_mass", 7063.5, "kg", "in the paper's mass-normalised strut damping", minimum=1.0),
        parameter("gravity", 1.63, "m/s2", "along -x of L", minimum=0.0, maximum=100.0),
        parameter("primary_load", (20017.0, 42358.0), "N", "stages 1 and 2, Table 3", minimum=1.0),
        parameter("primary_boundary", 0.254, "m", "stroke at the end of stage 1, Table 3", minimum=1e-3),
        parameter("primary_limit", 0.812, "m", "stroke limit, Table 3", minimum=1e-3),
        parameter("compression_load", 20017.0, "N", "secondary, Table 3", minimum=1.0),
        parameter("compression_limit", 0.305, "m", "secondary, Table 3", minimum=1e-3),
        parameter("tension_load", (2224.0, 22241.0), "N", "secondary, stages 1 and 2, Table 3", minimum=1.0),
        parameter("tension_boundary", 0.102, "m", "secondary, end of stage 1, Table 3", minimum=1e-3),
        parameter("tension_limit", 0.407, "m", "secondary, Table 3", minimum=1e-3),
        parameter("transition_width", 1e-3, "m", "s of eqs. 2 and 3", minimum=1e-6, maximum=0.05),
        parameter("damping_ratio", 1.0, "1", "ζ of the struts", minimum=0.0),
        parameter("printed_datum_weight", False, "", "eq. 3 to the letter: crushing at 0.9975 of the load", boolean=True),
        parameter("bearing_friction", 0.23, "1", "μ_B, Table 3", minimum=0.0),
        parameter("bearing_slip_velocity", 1e-2, "m/s", "regularises the sign of the bearing friction", minimum=1e-6),
        parameter("joint_damping", 100.0, "N.s/m", "of every joint; N.m.s/rad where it turns", minimum=0.0),
        parameter("stop_stiffness", 4e7, "N/m", "of the end stops: that of the stiffest core, F/s", minimum=1.0),
        parameter("stop_damping", 6e4, "N.s/m", "of the end stops: critical for piston and pad", minimum=0.0),
        *EFFECTS,
        parameter("longest_substep", 5e-4, "s", "of the integrator inside the leg", minimum=1e-7),
        parameter("stroke_rate_start", 0.0, "m/s", "compression rate of the primary at the start, for drop tests"),
        input_("body.position", (4.0, 0.0, 0.0), "m", "of the origin of B, frame L", nominal=1.0),
        input_("body.quaternion", (1.0, 0.0, 0.0, 0.0), "1", "B to L", nominal=1.0),
        input_("body.velocity", (0.0, 0.0, 0.0), "m/s", "of the origin of B, frame L", nominal=1.0),
        input_("body.angular_velocity", (0.0, 0.0, 0.0), "rad/s", "frame B", nominal=0.1),
        input_("body.acceleration", (0.0, 0.0, 0.0), "m/s2", "of the origin of B, frame L", nominal=1.0, slope=True),
        input_("body.angular_acceleration", (0.0, 0.0, 0.0), "rad/s2", "frame B", nominal=1.0, slope=True),
        input_("pad.force", (0.0, 0.0, 0.0), "N", "on the pad, frame L", nominal=1e4, slope=True, added=True),
        input_("pad.torque", (0.0, 0.0, 0.0), "N.m", "on the pad about the ball joint, frame L", nominal=1e3, slope=True, added=True),
        input_("pad.contact_stiffness", (0.0,) * 9, "N/m", "-dF/dx of the ground, by rows, frame L", nominal=1e7),
        input_("pad.contact_damping", (0.0,) * 9, "N.s/m", "-dF/dv of the ground, by rows, frame L", nominal=1e6),
        input_("pad.predicted_velocity", (0.0, 0.0, 0.0), "m/s", "of the pad as the soil saw it, frame L", nominal=1.0, slope=True),
        output(
            "mount.force",
            (0.0, 0.0, 0.0),
            "N",
            "on the body, frame B, less the rigid leg's",
            nominal=1e4,
            mean=True,
            slope=True,
            initially=LOADED,
        ),
        output(
            "mount.torque",
            (0.0, 0.0, 0.0),
            "N.m",
            "on the body about B's origin, frame B",
            nominal=1e4,
            mean=True,
            slope=True,
            initially=LOADED,
        ),
        output("mount.model_lever", (0.0,) * 3, "m", "p: the ball joint from B's origin, frame B", nominal=1.0, initially=POSE),
        output("mount.model_mass", (0.0,) * 9, "kg", "M felt at the ball joint, by rows, frame B", nominal=10.0, initially=POSE),
        output(
            "mount.model_straight",
            (0.0,) * 9,
            "kg",
            "inertia force on the ball joint by the base's acceleration",
            nominal=10.0,
            initially=POSE,
        ),
        output("mount.model_turning", (0.0,) * 9, "kg.m", "the same by its angular acceleration", nominal=100.0, initially=POSE),
        output(
            "mount.model_stiffness", (0.0,) * 9, "N/m", "K of the struts at the ball joint, by rows, frame B", nominal=1e7, initially=LOADED
        ),
        output("mount.model_damping", (0.0,) * 9, "N.s/m", "D of the struts, by rows, frame B", nominal=1e5, initially=LOADED),
        output("mount.model_ground_stiffness", (0.0,) * 9, "N/m", "of the ground under the pad, frame B", nominal=1e7, initially=GROUND),
        output("mount.model_ground_damping", (0.0,) * 9, "N.s/m", "of the ground under the pad, frame B", nominal=1e6, initially=GROUND),
        output("pad.position", (0.0, 0.0, 0.0), "m", "of the ball joint, frame L", nominal=1.0, initially=POSE),
        output("pad.quaternion", (1.0, 0.0, 0.0, 0.0), "1", "pad to L", nominal=1.0, initially=POSE),
        output("pad.velocity", (0.0, 0.0, 0.0), "m/s", "of the ball joint, frame L", nominal=1.0, initially=TWIST),
        output("pad.angular_velocity", (0.0, 0.0, 0.0), "rad/s", "frame L", nominal=1.0, initially=TWIST),
        output(
            "pad.model_acceleration",
            (0.0, 0.0, 0.0),
            "m/s2",
            "a_f: of the ball joint without force, frame L",
            nominal=1.0,
            initially=LOADED,
        ),
        output("pad.model_mobility", (0.0,) * 9, "1/kg", "Y, by rows, frame L", nominal=0.04, initially=LOADED),
        output("pad.model_stiffness", (0.0,) * 9, "1/s2", "A_x, by rows, frame L", nominal=1e6, initially=LOADED),
        output("pad.model_damping", (0.0,) * 9, "1/s", "A_v, by rows, frame L", nominal=1e4, initially=LOADED),
        output(
            "pad.model_base_velocity",
            (0.0, 0.0, 0.0),
            "m/s",
            "V_b: of the body's point at the ball joint, frame L",
            nominal=1.0,
            initially=TWIST,
        ),
        output("pad.model_base_acceleration", (0.0, 0.0, 0.0), "m/s2", "A_b: of the same point, frame L", nominal=1.0, initially=MOTION),
        output("pad.model_inertia", (0.0, 0.0, 0.0), "kg.m2", "of the pad about its own axes", nominal=1.0, initially=()),
        output("pad.model_joint_damping", 0.0, "N.m.s/rad", "of the ball joint", nominal=100.0, initially=()),
        output("pad.model_strut_rate", (0.0, 0.0, 0.0), "rad/s", "of the piston, frame L", nominal=1.0, initially=TWIST),
        output("primary.stroke", 0.0, "m", "compression", nominal=0.1, initially=()),
        output("right.stroke", 0.0, "m", "elongation of the secondary to the right, looking outward", nominal=0.1, initially=()),
        output("left.stroke", 0.0, "m", "elongation of the secondary to the left", nominal=0.1, initially=()),
        output("primary.load", 0.0, "N", "axial force, compression positive", nominal=1e4, initially=LOADED),
        output("right.load", 0.0, "N", "axial force, tension positive", nominal=1e4, initially=LOADED),
        output("left.load", 0.0, "N", "axial force, tension positive", nominal=1e4, initially=LOADED),
        output("primary.peak_stroke", 0.0, "m", "greatest compression so far", nominal=0.1, initially=()),
        output("right.peak_stroke", 0.0, "m", "greatest elongation so far", nominal=0.1, initially=()),
        output("left.peak_stroke", 0.0, "m", "greatest elongation so far", nominal=0.1, initially=()),
        output("bottomed", False, "", "whether any strut is beyond its stroke limit", boolean=True, initially=()),
        output("mount.work", 0.0, "J", "done on the leg by the body since the start", nominal=1e3, initially=()),
        output("pad.work", 0.0, "J", "done on the leg by the pad's wrench since the start", nominal=1e3, initially=()),
        output("energy.kinetic", 0.0, "J", "less that of the rigid leg, which the body carries", nominal=1e3, initially=TWIST),
        output("energy.potential", 0.0, "J", "less that of the rigid leg", nominal=1e3, initially=TWIST),
        output("energy.dissipated", 0.0, "J", "taken up by struts and joints since the start", nominal=1e3, initially=()),
        state("leg.position", (0.0, 0.0, 0.0)),
        state("leg.velocity", (0.0, 0.0, 0.0)),
        state("leg.attitude", (1.0, 0.0, 0.0, 0.0)),
        state("leg.rate", (0.0, 0.0, 0.0)),
        state("leg.crush", (0.0,) * 5),
        state("leg.guess", (0.0, 0.0, 0.0), "last acceleration, where Newton starts"),
    )

    experiment = (0.0, 0.2, 5e-3)

    @classmethod
    def stimulus(cls, time: float) -> dict[str, Any]:
        """A push on the pad that grows until the left secondary gives way; the body is held."""
        share = min(1.0, time / 0.1)
        return {"pad.force": (6000.0 * share, 900.0 * share, -600.0 * share)}

    def check(self) -> Iterable[str]:
        yield from stages_past_limits(self)

    def prepare(self) -> None:
        self.leg = leg_of(self, self.value("azimuth"), self.value("vehicle_mass"))
        self.inputs = (
            self.span("body.position", "body.angular_acceleration_slope"),
            self.span("pad.force", "pad.torque_added"),
            self.span("pad.contact_stiffness", "pad.predicted_velocity_slope"),
        )
        self.outputs = (
            self.span("mount.force", "mount.torque_slope"),
            self.span("mount.model_lever", "mount.model_ground_damping"),
            self.span("pad.position", "pad.angular_velocity"),
            self.span("pad.model_acceleration", "pad.model_strut_rate"),
            self.span("primary.stroke", "left.peak_stroke"),
            self.span("mount.work", "energy.dissipated"),
        )
        self.states = self.span("leg.position", "leg.guess")

    def initialise(self) -> None:
        start_leg(self.leg, self.value("gravity"), self.value("stroke_rate_start"), *self.inputs, *self.outputs, self.states)

    def advance(self, time: float, step: float) -> None:
        gravity, longest = self.value("gravity"), self.value("longest_substep")
        done = advance_leg(self.leg, gravity, longest, step, *self.inputs, *self.outputs, self.states)
        if done == GAVE_UP:
            raise UnitError(
                f"the struts' equations did not converge over {step:g} s with pad.force {self['pad.force'].round(1).tolist()} N; "
                "a shorter interval may do"
            )
        self["bottomed"] = float(done == BOTTOMED)


def stages_past_limits(unit: Unit) -> Iterable[str]:
    """What is wrong with a unit's cartridges: the first stage ends before the stroke does, and past the rise of its own force."""
    width = unit.value("transition_width")
    for strut in ("primary", "tension"):
        boundary, limit = unit.value(f"{strut}_boundary"), unit.value(f"{strut}_limit")
        if not boundary < limit:
            yield f"{strut}_boundary is {boundary:g} m, expects less than {strut}_limit, {limit:g} m"
        if not width < boundary:
            yield f"transition_width is {width:g} m, expects less than {strut}_boundary, {boundary:g} m"


def geometry_of(unit: Unit, azimuth: float) -> LegGeometry:
    """The undeformed leg from a unit's parameters; GeometryError where it cannot close."""
    dimensions = GearDimensions(**{name: unit.value(name) for name in GearDimensions._fields})
    leg = leg_geometry(dimensions, azimuth, unit.value("origin_height"), unit.value("primary_limit"))
    reach, shortest = unit.value("compression_limit"), min(leg.right_length, leg.left_length)
    if not reach < shortest:
        raise GeometryError(f"compression_limit is {reach:g} m, must be below the secondary's length {shortest:g} m")
    y, z = unit["cg_offset"].tolist()
    return moved(leg, y, z) if y != 0.0 or z != 0.0 else leg


def strut_term_of(unit: Unit) -> StrutTerm:
    """The generic term of the struts; ValueError for a phase that struts do not have."""
    phase = int(unit.value("strut_term_phase"))
    if phase not in (ALWAYS, AGAINST_MOTION):
        raise ValueError(f"strut_term_phase is {phase}, expects {ALWAYS} (against the stroke) or {AGAINST_MOTION} (against the motion)")
    c, a, b = unit.value("strut_term"), unit.value("strut_term_stroke"), unit.value("strut_term_rate")
    return StrutTerm(c, a, b, phase, int(unit.value("strut_term_struts")))


def core_of(unit: Unit, loads: Array, boundary: float, limit: float, vehicle_mass: float) -> Core:
    """A cartridge; its damping is that of its greatest load."""
    width = unit.value("transition_width")
    c = brake_damping(unit.value("damping_ratio"), float(loads.max()), width, vehicle_mass)
    weight = 1.0 if unit.value("printed_datum_weight") else DATUM_WEIGHT
    return Core(float(loads[0]), float(loads[-1]), boundary, limit, width, c, weight, unit.value("rate_hardening"))


def leg_of(unit: Unit, azimuth: float, vehicle_mass: float) -> Leg:
    """Everything constant about a leg from a unit's parameters; azimuth in rad, vehicle_mass in kg. ValueError where it cannot be."""
    reach = unit.value("compression_limit")
    return Leg(
        geometry_of(unit, azimuth),
        unit.value("primary_strut_mass"),
        unit.value("primary_piston_mass"),
        unit.value("secondary_strut_mass"),
        unit.value("footpad_mass"),
        disc_inertia(unit.value("footpad_mass"), unit.value("footpad_radius")),
        core_of(unit, unit["primary_load"], unit.value("primary_boundary"), unit.value("primary_limit"), vehicle_mass),
        core_of(unit, unit["tension_load"], unit.value("tension_boundary"), unit.value("tension_limit"), vehicle_mass),
        core_of(unit, unit["compression_load"], 2.0 * reach, reach, vehicle_mass),
        Stop(unit.value("stop_stiffness"), unit.value("stop_damping"), 1e-4),
        unit.value("bearing_friction"),
        unit.value("bearing_slip_velocity"),
        unit.value("joint_damping"),
        strut_term_of(unit),
    )
