"""RegolithContact: the soil under one footpad."""

from collections.abc import Iterable
from typing import Any

from ..laws.footpad import COLUMNS, POINTS, Footpad
from ..laws.generic_terms import NormalTerm
from ..laws.soil import Soil
from ..laws.soil_effects import SoilEffects
from ..laws.soil_exchange import advance_soil, start_soil
from ..laws.surface import Surface, inclined_plane
from ..laws.tangent_term import TangentTerm
from ..shell import Unit, UnitError, input_, output, parameter, state
from ._terrain import TERRAIN, note_map, refuse_gaps, relief_of

DEEP = 0.05  # m: a pad that starts deeper than this is a mistake of the scenario, not a landing


PAD = ("pad.position", "pad.quaternion", "pad.velocity", "pad.angular_velocity")


EFFECTS = (  # beyond the paper (decision 9); null unless set
    parameter("layer_stiffness", 0.0, "N/m", "per footpad, of a layer that begins at layer_depth", minimum=0.0),
    parameter("layer_depth", 0.02, "m", "where the stiffer layer begins", minimum=0.0),
    parameter("inertial_drag", 0.0, "N.s2/m2", "A per footpad: A times the sink rate's square while sinking", minimum=0.0),
    parameter("adhesion", 0.0, "N", "per footpad: pulls it down while it rises in the soil", minimum=0.0),
    parameter("rebound_share", 0.0, "1", "of the spring's force at the datum, given back on the way out", minimum=0.0, maximum=1.0),
    parameter("rebound_depth", 5e-3, "m", "over which it is given back", minimum=1e-6, maximum=1.0),
    parameter("stribeck_rise", 0.0, "1", "of the friction coefficient toward rest", minimum=0.0, maximum=10.0),
    parameter("stribeck_velocity", 0.05, "m/s", "over which that rise dies", minimum=1e-5),
    parameter("normal_term", 0.0, "N", "generic, per footpad: F_n += c (depth/0.01 m)^a (rate/0.1 m/s)^b"),
    parameter("normal_term_depth", 0.0, "1", "a", minimum=0.0, maximum=6.0),
    parameter("normal_term_rate", 0.0, "1", "b", minimum=0.0, maximum=6.0),
    parameter("normal_term_phase", 0, "1", "0: always, 1: sinking, 2: rising, 3: against motion", integer=True, minimum=0, maximum=3),
    parameter("tangent_term", 0.0, "N", "generic, per footpad: F_t -= c (depth/0.01 m)^a (speed/0.1 m/s)^b (slide/0.1 m)^d"),
    parameter("tangent_term_depth", 0.0, "1", "a", minimum=0.0, maximum=6.0),
    parameter("tangent_term_speed", 0.0, "1", "b", minimum=0.0, maximum=6.0),
    parameter("tangent_term_slide", 0.0, "1", "d", minimum=0.0, maximum=6.0),
    parameter("tangent_term_phase", 0, "1", "0: against slip; 1: against slide", integer=True, minimum=0, maximum=1),
)


class RegolithContact(Unit):
    """Reaction of regolith on a footpad through five points, and the pad's motion against it.

    The surface is an inclined plane, with a height map, craters and boulders on it where `terrain.*` says so (docs/terrain.md).

    law 1  the paper's: F_n = w_b w_r (K_n δ^p + w_d C_n δ̇), eqs. 5 to 9. It needs a residual sink rate: a resting pad creeps by design at
           about 0.05 mm/s (below 0.1 mm/s), and a rebound is free of force.
    law 2  rate-independent compaction: plastic flow on K_n δ^p, elastic unloading over the band b, no creep.
    F_t = -μ F_n v/|v| - K_p δ_t against slip and slide. Table 4 is per footpad: a fifth of K_n, C_n and K_p goes to each point.
    Effects beyond the paper (layer to tangent_term) are null unless set, per footpad too; docs/physics.md has their equations.

    The pad is integrated here against the law over each interval, with the leg as reduced interface model (pad.model_*); without a
    model the
    pad goes on at its last velocity. pad.mismatch_* is what the leg did otherwise in the last pass, and is made good.
    Valid for penetrations of some centimetres, on which Table 4 was fitted; a start deeper than 5 cm is refused.
    """

    description = "Regolith under one footpad: normal contact, friction and plowing at five points."
    required = ("pad.position", "pad.velocity", "pad.force", "contact", "gap")
    initially = PAD
    variables = (
        parameter("law", 1, "1", "1: published, with residual sink rate; 2: rate-independent", integer=True, minimum=1, maximum=2),
        parameter("bearing_strength", 350254.0, "N/m", "K_n per footpad, N/m^p (Table 4)", minimum=1.0),
        parameter("compaction_exponent", 1.0, "1", "p (Table 4)", minimum=0.5, maximum=4.0),
        parameter("rebound_band", 1e-4, "m", "b (Table 4)", minimum=1e-6, maximum=0.1),
        parameter("residual_sink_rate", 1e-4, "m/s", "(Table 4)", minimum=1e-7, maximum=0.1),
        parameter("damping", 0.0, "N.s/m", "C_n per footpad (Table 4)", minimum=0.0),
        parameter("damping_activation_depth", 0.0, "m", "δ_d (Table 4); 0: full damping at once", minimum=0.0),
        parameter("friction", 0.33, "1", "μ (Table 4)", minimum=0.0),
        parameter("plowing", 1454.0, "N/m", "K_p per footpad (Table 4)", minimum=0.0),
        parameter("slip_velocity", 1e-3, "m/s", "regularises the sign of Coulomb's friction", minimum=1e-7),
        *EFFECTS,
        parameter("ground_slope", 0.0, "rad", "of the plane; at azimuth 0 it rises toward +Z of L", minimum=-1.2, maximum=1.2),
        parameter("ground_azimuth", 0.0, "rad", "of the slope about L's x axis", minimum=-7.0, maximum=7.0),
        parameter("ground_origin", (0.0, 0.0, 0.0), "m", "a point of the plane, frame L"),
        *TERRAIN,
        parameter("footpad_radius", 0.47, "m", "of the circle of rim points", minimum=1e-3),
        parameter("footpad_height", 0.10, "m", "base to ball joint (Table 2)", minimum=0.0),
        parameter("longest_substep", 5e-4, "s", "of the integrator inside", minimum=1e-7),
        input_("pad.position", (1.0, 0.0, 0.0), "m", "of the ball joint, frame L", nominal=1.0),
        input_("pad.quaternion", (1.0, 0.0, 0.0, 0.0), "1", "pad to L", nominal=1.0),
        input_("pad.velocity", (0.0, 0.0, 0.0), "m/s", "of the ball joint, frame L", nominal=1.0),
        input_("pad.angular_velocity", (0.0, 0.0, 0.0), "rad/s", "frame L", nominal=1.0),
        input_("pad.model_acceleration", (0.0, 0.0, 0.0), "m/s2", "a_f: of the ball joint without force, frame L", nominal=1.0),
        input_("pad.model_mobility", (0.0,) * 9, "1/kg", "Y, by rows, frame L", nominal=0.04),
        input_("pad.model_stiffness", (0.0,) * 9, "1/s2", "A_x, by rows, frame L", nominal=1e6),
        input_("pad.model_damping", (0.0,) * 9, "1/s", "A_v, by rows, frame L", nominal=1e4),
        input_("pad.model_base_velocity", (0.0, 0.0, 0.0), "m/s", "V_b, frame L", nominal=1.0),
        input_("pad.model_base_acceleration", (0.0, 0.0, 0.0), "m/s2", "A_b, frame L", nominal=1.0),
        input_("pad.model_inertia", (0.0, 0.0, 0.0), "kg.m2", "of the pad about its own axes; 0: it does not answer torques", nominal=1.0),
        input_("pad.model_joint_damping", 0.0, "N.m.s/rad", "of the ball joint", nominal=100.0),
        input_("pad.model_strut_rate", (0.0, 0.0, 0.0), "rad/s", "of the piston, frame L", nominal=1.0),
        input_("pad.mismatch_velocity", (0.0, 0.0, 0.0), "m/s", "leg less prediction in the last pass, frame L", nominal=1e-3),
        input_("pad.mismatch_angular_velocity", (0.0, 0.0, 0.0), "rad/s", "leg less prediction in the last pass, frame L", nominal=1e-2),
        output("pad.force", (0.0, 0.0, 0.0), "N", "on the pad, frame L", nominal=1e4, mean=True, slope=True),
        output("pad.torque", (0.0, 0.0, 0.0), "N.m", "on the pad about the ball joint, frame L", nominal=1e3, mean=True, slope=True),
        output("pad.predicted_position", (0.0, 0.0, 0.0), "m", "of the ball joint, frame L", nominal=1.0),
        output("pad.predicted_velocity", (0.0, 0.0, 0.0), "m/s", "of the ball joint, frame L", nominal=1.0, mean=True, slope=True),
        output("pad.predicted_angular_velocity", (0.0, 0.0, 0.0), "rad/s", "frame L", nominal=1.0),
        output("pad.contact_stiffness", (0.0,) * 9, "N/m", "-dF/dx of the ground, by rows, frame L", nominal=1e7, mean=True),
        output("pad.contact_damping", (0.0,) * 9, "N.s/m", "-dF/dv of the ground, by rows, frame L", nominal=1e6, mean=True),
        output("penetration", 0.0, "m", "depth of the pad's centre below the surface", nominal=0.05),
        output("gap", 0.0, "m", "height of the lowest point above the surface along L's x; negative in the soil", nominal=0.1),
        output("skid", 0.0, "m", "slide of the pad's centre in the soil since first contact", nominal=0.1),
        output("normal_force", 0.0, "N", "along the surface's normal", nominal=1e4),
        output("pad.work", 0.0, "J", "done on the soil by the pad since the start", nominal=1e3),
        output("contact", False, "", "whether any point is in the soil", boolean=True),
        output("contact_time", -1.0, "s", "of first contact, -1 before", nominal=1.0),
        state("points", (0.0,) * (POINTS * COLUMNS), "per point: datum, slide, last place, last depth"),
    )

    experiment = (0.0, 0.1, 2e-3)

    @classmethod
    def stimulus(cls, time: float) -> dict[str, Any]:
        """A pad pushed into the soil at a given speed, sliding."""
        return {"pad.position": (0.105 - 0.4 * time, 0.2 * time, 0.0), "pad.velocity": (-0.4, 0.2, 0.0)}

    def check(self) -> Iterable[str]:
        yield from begun_too_early(self)

    def prepare(self) -> None:
        self.soil, plane = soil_of(self)
        self.surface = plane._replace(relief=relief_of(self))
        self.pad = Footpad(self.value("footpad_radius"), self.value("footpad_height"))
        self.port = self.span("pad.position", "pad.angular_velocity")
        self.outputs = (
            self.span("pad.force", "pad.torque_slope"),
            self.span("pad.predicted_position", "pad.predicted_angular_velocity"),
            self.span("penetration", "pad.work"),
            self.span("pad.contact_stiffness", "pad.contact_damping_mean"),
            self["points"].reshape(POINTS, COLUMNS),
        )
        self.model = self.span("pad.model_acceleration", "pad.model_strut_rate")
        self.shift = self.span("pad.mismatch_velocity", "pad.mismatch_angular_velocity")

    def initialise(self) -> None:
        note_map(self)
        self.refuse_gaps(self.value("terrain.reach"))
        depth = start_soil(self.soil, self.surface, self.pad, self.port, *self.outputs)
        refuse_deep(depth, "the pad")
        self.feel(self.start_time)

    def advance(self, time: float, step: float) -> None:
        done, touch = advance_soil(
            self.soil, self.surface, self.pad, self.value("longest_substep"), step, self.port, self.model, self.shift, *self.outputs
        )
        if not done:
            self.refuse_gaps(self.pad.radius, step)
            raise UnitError(
                f"the contact's equations did not converge over {step:g} s at a sink depth of {-self.value('gap'):.4g} m; "
                "a shorter interval may do"
            )
        if touch >= 0.0 and self.value("contact_time") < 0.0:
            self["contact_time"] = time + touch  # of a graze, too, that is over when the interval ends
        self.feel(time)

    def refuse_gaps(self, reach: float, ahead: float = 0.0) -> None:
        """UnitError where the height map is not whole within `reach` (m) of the pad, as it will be `ahead` (s) from now."""
        _, y, z = (self["pad.position"] + ahead * self["pad.velocity"]).tolist()
        refuse_gaps(self.surface, y, z, reach, "the pad")

    def feel(self, time: float) -> None:
        """Contact signal and the time of the first contact."""
        touching = self.value("gap") < 0.0
        self["contact"] = float(touching)
        if touching and self.value("contact_time") < 0.0:
            self["contact_time"] = time


def begun_too_early(unit: Unit) -> Iterable[str]:
    """What is wrong with a unit's start time: an instant below zero would say that there was no contact yet."""
    if unit.start_time < 0.0:
        yield f"the run begins at {unit.start_time:g} s, expects 0 s or later: a contact_time below 0 means none yet"


def soil_of(unit: Unit, prefix: str = "", element: int = 0) -> tuple[Soil, Surface]:
    """Soil of one contact point, and the plane of its surface, from the given element of a unit's parameters (names with `prefix`)."""
    share = 1.0 / POINTS

    def of(name: str) -> float:
        return value_of(unit, prefix + name, element)

    soil = Soil(
        int(of("law")),
        share * of("bearing_strength"),
        of("compaction_exponent"),
        share * of("damping"),
        of("damping_activation_depth"),
        of("rebound_band"),
        of("residual_sink_rate"),
        of("friction"),
        share * of("plowing"),
        of("slip_velocity"),
        effects_of(unit, prefix, element),
    )
    x, y, z = unit[f"{prefix}ground_origin"].reshape(-1, 3)[element].tolist()
    return soil, inclined_plane(of("ground_slope"), of("ground_azimuth"), (x, y, z))


def value_of(unit: Unit, name: str, element: int) -> float:
    """One element of a parameter."""
    return float(unit[name][element])


def effects_of(unit: Unit, prefix: str, element: int) -> SoilEffects:
    """Effects beyond the paper on one contact point, as `soil_of` reads the soil."""
    share = 1.0 / POINTS

    def of(name: str) -> float:
        return value_of(unit, prefix + name, element)

    return SoilEffects(
        any(of(name) != 0.0 for name in ("adhesion", "rebound_share", "normal_term")),
        share * of("layer_stiffness"),
        of("layer_depth"),
        share * of("inertial_drag"),
        share * of("adhesion"),
        of("rebound_share"),
        of("rebound_depth"),
        of("stribeck_rise"),
        of("stribeck_velocity"),
        NormalTerm(share * of("normal_term"), of("normal_term_depth"), of("normal_term_rate"), int(of("normal_term_phase"))),
        TangentTerm(
            share * of("tangent_term"),
            of("tangent_term_depth"),
            of("tangent_term_speed"),
            of("tangent_term_slide"),
            int(of("tangent_term_phase")),
        ),
    )


def refuse_deep(depth: float, which: str) -> None:
    """UnitError for a pad that starts deep in the soil."""
    if depth > DEEP:
        raise UnitError(f"{which} starts {depth:.4g} m deep in the soil, expects at most {DEEP:g} m: raise position_start[1] of the body")
