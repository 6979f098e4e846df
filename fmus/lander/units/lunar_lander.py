"""LunarLander: the whole vehicle on its soil in one unit, the monolithic twin of the co-simulation."""

from collections.abc import Iterable
from dataclasses import replace
from math import pi
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..laws.footpad import COLUMNS, POINTS, Footpad, deepest
from ..laws.leg import leg_mass, rigid_inertia
from ..laws.rigid_body import Body, BodyState, inertia_matrix
from ..laws.twin import BODY_COLUMNS, LEG_COLUMNS, Flight, Vehicle
from ..laws.twin_effects import Effects, Tail, guided
from ..laws.twin_exchange import LEG_REPORT, Run, engine_at, fly_and_show, kept, show
from ..laws.twin_nominal import BESIDE, KEPT, ROOM, Nominal, nominal_room
from ..laws.twin_stepping import Ride, Settings, pad_motion, push_at_start, start_accelerations, start_flight
from ..laws.vectors import Vector, apply, from_yaw_pitch_roll, rotation
from ..shell import Unit, UnitError, input_, output, parameter, state
from ..shell.records import Record
from . import (
    _terrain,
    body_term,
    gear_leg,
    guidance_control,
    propellant_slosh,
    reaction_control,
    regolith_contact,
    thrust_ground_effect,
    vehicle_body,
)

LEGS = 4
Array = NDArray[np.float64]


def parameters_of(variables: Iterable[Record], without: Iterable[str]) -> tuple[Record, ...]:
    """The parameters another unit declares: declared once, beside their number."""
    left_out = set(without)
    return tuple(v for v in variables if v.causality == "parameter" and v.name not in left_out)


def for_each_soil(record: Record) -> Record:
    """A soil's parameter once for each leg: `soil.friction[1..4]`; vectors by rows."""
    return replace(record, name=f"soil.{record.name}", start=record.start * LEGS, vector=True)


def named(prefix: str, unit: type[Unit], *without: str) -> tuple[Record, ...]:
    """The parameters of another unit under a prefix: `guidance.decay_time`."""
    return tuple(replace(record, name=f"{prefix}.{record.name}") for record in parameters_of(unit.variables, without))


def leg_outputs(k: int) -> tuple[Record, ...]:
    """What leg k and its soil show, in the order of `twin_exchange.show_leg`."""
    struts = ("primary", "right", "left")
    return (
        output(f"leg{k}.pad.position", (0.0, 0.0, 0.0), "m", "of the ball joint, frame L", nominal=1.0),
        output(f"leg{k}.pad.velocity", (0.0, 0.0, 0.0), "m/s", "of the ball joint, frame L", nominal=1.0),
        *(output(f"leg{k}.{s}.stroke", 0.0, "m", "compression of the primary, elongation of a secondary", nominal=0.1) for s in struts),
        *(output(f"leg{k}.{s}.load", 0.0, "N", "axial force without bearing friction", nominal=1e4) for s in struts),
        *(output(f"leg{k}.{s}.peak_stroke", 0.0, "m", "greatest stroke at a communication point so far", nominal=0.1) for s in struts),
        output(f"leg{k}.bottomed", False, "", "whether any strut is beyond its stroke limit now", boolean=True),
        output(f"leg{k}.energy.dissipated", 0.0, "J", "taken up by struts and joints since the start", nominal=1e3),
        output(f"leg{k}.pad.work", 0.0, "J", "done on the leg by the soil since the start", nominal=1e3),
        output(f"soil{k}.penetration", 0.0, "m", "depth of the pad's centre below the surface", nominal=0.05),
        output(f"soil{k}.gap", 0.0, "m", "height of the lowest point above the surface along L's x; negative in the soil", nominal=0.1),
        output(f"soil{k}.skid", 0.0, "m", "slide of the pad's centre in the soil since first contact", nominal=0.1),
        output(f"soil{k}.normal_force", 0.0, "N", "along the surface's normal", nominal=1e4),
        output(f"soil{k}.contact", False, "", "whether any point is in the soil", boolean=True),
        output(f"soil{k}.contact_time", -1.0, "s", "of first contact, -1 before", nominal=1.0),
    )


NOT_A_GEARS = ("azimuth", "gravity", "vehicle_mass", "longest_substep", "stroke_rate_start")
NOT_A_SOILS = ("footpad_radius", "footpad_height", "longest_substep", *(record.name for record in _terrain.TERRAIN))
ENGINE = ("engine.force", "engine.force_added", "engine.torque", "engine.torque_added")


class LunarLander(Unit):
    """Body, four legs and their soils assembled from the same laws as the units and integrated as one system, tightly.

    Unknowns are the accelerations of body, ball joints and pads (30); SDIRK2 with Newton, each leg eliminated into the body; the step
    follows
    the local error of the velocities (`tolerance`, m/s a step). It shares the laws with the units, not the coupling: the co-simulation
    must equal it.
    Inside are also, by default without effect: the engine of GuidanceControl (`guidance.*`), which acts from the twin's own first contact,
    and ThrustGroundEffect, PropellantSlosh, ReactionControl and BodyTerm (`plume.*`, `slosh.*`, `rcs.*`, `body_term.*`). The port `engine`
    adds to them; thrust that others follow is that inside plus the port's force along X.
    Legs 1 to 4 stand at `azimuth`; each has a soil of its own (`soil.*`, an element a leg), and all one relief (`terrain.*`).
    Parameters are those of VehicleBody,
    GearLeg and RegolithContact.
    With `variation` = -k a run of values a little different is flown beside the last run that had `variation` = k: by its steps, and from
    its solutions. Such a run takes a quarter of the time, and the two differ by their values alone: differences of a thousandth of a
    tolerance give derivatives. Nominal runs are kept by the instance's name, past a reset; they should have the same communication points.
    Without one a run is on its own. Such runs belong to their process: a state restored in one goes on by the nominal run as it is then,
    not to the last bit, and in another process without it.
    """

    nominals: ClassVar[dict[tuple[str, int], Nominal]] = {}

    description = "The whole lander in one unit: what the co-simulation must equal."
    required = ("engine.force", "engine.torque", "body.position", "body.quaternion", "body.velocity", "body.angular_velocity")
    initially = ENGINE
    variables = (
        *parameters_of(vehicle_body.VehicleBody.variables, ()),
        *parameters_of(gear_leg.GearLeg.variables, NOT_A_GEARS),
        parameter("azimuth", (0.0, 0.5 * pi, pi, -0.5 * pi), "rad", "of legs 1 to 4 about B's x axis, from +Z to +Y"),
        *(
            for_each_soil(record)
            for record in parameters_of(regolith_contact.RegolithContact.variables, NOT_A_SOILS)
        ),
        *_terrain.TERRAIN,
        *named("guidance", guidance_control.GuidanceControl),
        *named("plume", thrust_ground_effect.ThrustGroundEffect),
        *named("slosh", propellant_slosh.PropellantSlosh, "gravity"),
        *named("rcs", reaction_control.ReactionControl),
        *named("body_term", body_term.BodyTerm),
        parameter("tolerance", 1e-5, "m/s", "local error of any velocity a step", minimum=1e-9, maximum=1e-2),
        parameter("longest_step", 1e-2, "s", "of the integrator", minimum=1e-5),
        parameter(
            "variation", 0, "1", "0: own steps; k: own, kept as nominal run k; -k: nominal run k's", minimum=-8, maximum=8, integer=True
        ),
        input_("engine.force", (0.0, 0.0, 0.0), "N", "on the body, frame B", nominal=1e4, slope=True, added=True),
        input_("engine.torque", (0.0, 0.0, 0.0), "N.m", "on the body about B's origin, frame B", nominal=1e4, slope=True, added=True),
        output("body.position", (4.0, 0.0, 0.0), "m", "of the origin of B, frame L", nominal=1.0),
        output("body.quaternion", (1.0, 0.0, 0.0, 0.0), "1", "attitude (w, x, y, z), B to L", nominal=1.0),
        output("body.velocity", (0.0, 0.0, 0.0), "m/s", "of the origin of B, frame L", nominal=1.0),
        output("body.angular_velocity", (0.0, 0.0, 0.0), "rad/s", "frame B", nominal=0.1),
        output("body.acceleration", (0.0, 0.0, 0.0), "m/s2", "of the origin of B, frame L", nominal=1.0),
        output("body.angular_acceleration", (0.0, 0.0, 0.0), "rad/s2", "frame B", nominal=1.0),
        *(output(f"attitude.{a}", 0.0, "rad", f"{a} angle, 321 sequence", nominal=1.0) for a in ("yaw", "pitch", "roll")),
        *(output(f"rates.{a}", 0.0, "rad/s", f"{a} rate, frame B", nominal=0.1) for a in ("yaw", "pitch", "roll")),
        output("energy.kinetic", 0.0, "J", "of the whole vehicle", nominal=1e3),
        output("energy.potential", 0.0, "J", "of the whole vehicle, zero at the origin of L", nominal=1e3),
        output("engine.work", 0.0, "J", "done on the body through this port since the start", nominal=1e3),
        output("effects.work", 0.0, "J", "done on the body by engine and effects inside since the start", nominal=1e3),
        *(record for k in range(1, LEGS + 1) for record in leg_outputs(k)),
        output("steps", 0.0, "1", "integration steps so far", nominal=1e3),
        output("rejected", 0.0, "1", "integration steps refused so far", nominal=1e3),
        state("flight.body", (0.0,) * BODY_COLUMNS),
        state("flight.legs", (0.0,) * (LEGS * LEG_COLUMNS)),
        state("flight.memory", (0.0,) * (LEGS * POINTS * COLUMNS)),
        state("accelerations", (0.0,) * ((LEGS + 1) * 6)),
        state("ledger", (0.0,) * ((LEGS + 1) * 4)),
        state("touch", (-1.0,) * LEGS),
        state("bob", (0.0,) * 4, "of the slosh pendulum: place and velocity across X"),
        state("next_step", 1e-5),
    )

    experiment = (0.0, 0.1, 5e-3)
    reference_parameters = (("position_start", (3.63, 0.0, 0.0)), ("velocity_start", (-0.5, -0.2, 0.0)), ("roll_start", 0.005))

    @classmethod
    def stimulus(cls, time: float) -> dict[str, Any]:
        """Straight onto level ground, a little to the left, under half the weight in thrust."""
        return {"engine.force": (5000.0, 0.0, 0.0)}

    def check(self) -> Iterable[str]:
        yield from vehicle_body.inertia_of_no_body(self)
        yield from gear_leg.stages_past_limits(self)
        yield from self.lighter_than_its_parts()
        yield from guidance_control.falling_times(self, "guidance.")
        yield from regolith_contact.begun_too_early(self)

    def lighter_than_its_parts(self) -> Iterable[str]:
        """Mass and inertia are the whole vehicle's: what legs and slosh leave of them is a body's, too."""
        legs, slosh = sum(leg_mass(leg) for leg in self.vehicle.legs), self.value("slosh.mass")
        if not self.value("mass") > legs + slosh:
            yield f"mass is {self.value('mass'):g} kg, expects more than the {legs + slosh:g} kg of legs and slosh"
        own = np.array(self.vehicle.body.inertia) - sum(rigid_inertia(leg) for leg in self.vehicle.legs)
        least = float(np.linalg.eigvalsh(own)[0])
        if not least > 0.0:
            yield f"inertia is the whole vehicle's: its legs leave a principal moment of {least:g} kg.m2, expects more than 0"

    def prepare(self) -> None:
        body = Body(self.value("mass"), inertia_matrix(triple(self["inertia"]), triple(self["inertia_products"])), self.value("gravity"))
        legs = tuple(gear_leg.leg_of(self, azimuth, self.value("mass")) for azimuth in self["azimuth"].tolist())
        ground = [regolith_contact.soil_of(self, "soil.", k) for k in range(LEGS)]
        relief = _terrain.relief_of(self)
        soils, surfaces = tuple(soil for soil, _ in ground), tuple(plane._replace(relief=relief) for _, plane in ground)
        pad = Footpad(self.value("footpad_radius"), self.value("footpad_height"))
        self.vehicle = Vehicle(body, legs, soils, surfaces, pad)
        self.flight = Flight(
            self["flight.body"],
            self["flight.legs"].reshape(LEGS, LEG_COLUMNS),
            self["flight.memory"].reshape(LEGS, POINTS, COLUMNS),
        )
        self.course = self["accelerations"].reshape(LEGS + 1, 6), self["ledger"].reshape(LEGS + 1, 4), self["touch"]
        self.ride = Ride(self.flight, *self.course, self["bob"])
        self.effects = effects_of(self)
        settings = Settings(self.value("tolerance"), self.value("longest_step"), 0.0)
        self.port = self.span("engine.force", "engine.torque_added").reshape(6, 3)
        self.outputs = (
            self.span("body.position", "rates.roll"),
            self.span("energy.kinetic", "effects.work"),
            self.span("leg1.pad.position", f"soil{LEGS}.contact_time").reshape(LEGS, LEG_REPORT),
        )
        steps = self["next_step"], self.span("steps", "rejected")
        self.run = kept(Run(self.vehicle, self.effects, self.ride, settings, self.nominal(), self.port, *steps, *self.outputs))

    def nominal(self) -> Nominal:
        """The nominal run to be kept or flown beside; room for none on its own."""
        number = int(self.value("variation"))
        key = (self.instance_name, abs(number))
        if number > 0 and key not in self.nominals:
            self.nominals[key] = nominal_room(LEGS, ROOM)
        if number == 0 or key not in self.nominals:
            return nominal_room(0, 0)
        nominal = self.nominals[key]
        nominal.use[0], nominal.share[0] = (KEPT if number > 0 else BESIDE), 1.0
        return nominal

    def initialise(self) -> None:
        attitude = from_yaw_pitch_roll(self.value("yaw_start"), self.value("pitch_start"), self.value("roll_start"))
        velocity = apply(rotation(attitude), triple(self["velocity_start"]))
        start_flight(self.vehicle, BodyState(triple(self["position_start"]), attitude, velocity, triple(self["rates_start"])), self.flight)
        _terrain.note_map(self)
        self.refuse_gaps(self.value("terrain.reach"))
        for k in range(LEGS):
            regolith_contact.refuse_deep(deepest(self.flight.memory[k]), f"pad {k + 1}")
        engine = push_at_start(self.effects, engine_at(self.port), self.flight, self.start_time)
        if not start_accelerations(self.vehicle, engine, self.flight, self.course[0]):
            raise UnitError("the accelerations at the start could not be found; check the start position against the ground")
        show(self.vehicle, self.flight, *self.course, *self.outputs)

    def advance(self, time: float, step: float) -> None:
        undone = fly_and_show(self.run, time, step)
        if undone > 0.0:
            self.refuse_gaps(self.vehicle.pad.radius)
            raise UnitError(f"no convergence, or too many steps, at steps of {undone:.3g} s; a larger tolerance or longest_step may do")

    def refuse_gaps(self, reach: float) -> None:
        """UnitError where the height map is not whole within `reach` (m) of any pad."""
        for k in range(LEGS):
            _, y, z = pad_motion(self.flight, k).position
            _terrain.refuse_gaps(self.vehicle.surfaces[k], y, z, reach, f"pad {k + 1}")


def effects_of(unit: Unit) -> Effects:
    """Engine and effects inside; active where any is not null."""
    corners = guidance_control.corners_of(unit, "guidance.")
    y, z = unit["guidance.thrust_offset"].tolist()
    tail = Tail(corners, unit.value("guidance.thrust_before_contact"), (y, z), unit.value("guidance.swirl"))
    plume, pendulum = thrust_ground_effect.plume_of(unit, "plume."), propellant_slosh.pendulum_of(unit, "slosh.")
    pulse, term = reaction_control.pulse_of(unit, "rcs."), body_term.term_of(unit, "body_term.")
    active = guided(tail) or plume.share != 0.0 or pendulum.mass != 0.0 or any(pulse.torque) or term.coefficient != 0.0
    return Effects(active, tail, plume, pendulum, pulse, term, unit.start_time)


def triple(view: Array) -> Vector:
    """A view of three numbers as a tuple."""
    x, y, z = view.tolist()
    return (x, y, z)
