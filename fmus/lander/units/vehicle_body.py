"""VehicleBody: the lander's rigid body, to which legs, engine and further effects attach by wrenches."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..laws.body_exchange import WRENCH, advance_body, write_body
from ..laws.impedance import NUMBERS
from ..laws.rigid_body import Body, BodyLoad, BodyState, body_rate, inertia_matrix
from ..laws.vectors import ZERO, Vector, apply, from_yaw_pitch_roll, rotation
from ..shell import Unit, input_, output, parameter
from ..shell.records import Record

Array = NDArray[np.float64]
LEGS = tuple(f"leg{k}" for k in range(1, 9))
PORTS = (*LEGS, "engine", *(f"effect{k}" for k in range(1, 5)))
LONGEST = 1e-3  # s, Runge-Kutta step: its error per step is below 1e-12 of the motion at rates of 1 rad/s
ROUNDING = 1e-12  # of a sum of principal moments: a flat body has the largest equal to it
UNLOADED = BodyLoad(ZERO, ZERO, ZERO, ZERO)


def model_inputs(port: str) -> tuple[Record, ...]:
    """How the wrench of a leg answers the body's motion, as GearLeg's `mount.model_*` gives it; zero: not known."""
    return (
        input_(f"{port}.model_lever", (0.0,) * 3, "m", "the ball joint from B's origin, frame B", nominal=1.0),
        input_(f"{port}.model_mass", (0.0,) * 9, "kg", "felt at the ball joint, by rows, frame B", nominal=10.0),
        input_(f"{port}.model_straight", (0.0,) * 9, "kg", "inertia force on the ball joint by the base's acceleration", nominal=10.0),
        input_(f"{port}.model_turning", (0.0,) * 9, "kg.m", "the same by its angular acceleration", nominal=100.0),
        input_(f"{port}.model_stiffness", (0.0,) * 9, "N/m", "of the struts at the ball joint, by rows, frame B", nominal=1e7),
        input_(f"{port}.model_damping", (0.0,) * 9, "N.s/m", "of the struts, by rows, frame B", nominal=1e5),
        input_(f"{port}.model_ground_stiffness", (0.0,) * 9, "N/m", "of the ground under the pad, frame B", nominal=1e7),
        input_(f"{port}.model_ground_damping", (0.0,) * 9, "N.s/m", "of the ground under the pad, frame B", nominal=1e6),
    )


class VehicleBody(Unit):
    """Newton-Euler for the vehicle with its gear undeformed: Table 1 is the composite, and each leg's wrench is what differs from it.

    m a = R Σf - m g x̂,   I ω' = Σκ - ω × I ω,   R from the quaternion, q' = ½ q ω

    Every wrench is given in B about B's origin, which is the composite centre of mass. Attitude: R(B to L) = Rz(roll) Ry(pitch) Rx(yaw);
    pitch is positive nose up, roll right side down, yaw nose left. Velocity at the start is given in B, as Table 5 does.
    Where legs offer a model of how their wrench answers (legK.model_*) and the master says what the body reached in the pass before
    (body.reference_*), the mean wrenches of that pass are corrected for what the body now does otherwise (laws/impedance.py).
    Outputs with mean and slope are those of the motion just made: a leg stepped afterwards ends with the body's velocity exactly, and with
    its place but for the curvature of the acceleration.
    """

    description = "Rigid body of the lander: six degrees of freedom under the wrenches of legs, engine and effects."
    required = (
        *(f"{port}.{member}" for port in (*LEGS[:4], "engine") for member in ("force", "torque")),
        *(f"body.{member}" for member in ("position", "quaternion", "velocity", "angular_velocity")),
    )
    variables = (
        parameter("mass", 7063.5, "kg", "whole vehicle, gear included (Table 1)", minimum=1.0),
        parameter("inertia", (16492.0, 17409.0, 20800.0), "kg.m2", "Ixx, Iyy, Izz of the whole vehicle, frame B (Table 1)", minimum=1e-3),
        parameter("inertia_products", (0.0, 0.0, 0.0), "kg.m2", "∫xy dm, ∫xz dm, ∫yz dm, frame B"),
        parameter("gravity", 1.63, "m/s2", "along -x of L", minimum=0.0, maximum=100.0),
        parameter("position_start", (4.0, 0.0, 0.0), "m", "of the origin of B, frame L"),
        parameter("velocity_start", (0.0, 0.0, 0.0), "m/s", "of the origin of B, frame B (Table 5)"),
        parameter("yaw_start", 0.0, "rad", "about X, positive nose left", minimum=-3.2, maximum=3.2),
        parameter("pitch_start", 0.0, "rad", "about Y, positive nose up", minimum=-1.5, maximum=1.5),
        parameter("roll_start", 0.0, "rad", "about Z, positive right side down", minimum=-3.2, maximum=3.2),
        parameter("rates_start", (0.0, 0.0, 0.0), "rad/s", "yaw (X), pitch (Y), roll (Z) rate, frame B"),
        *(
            record
            for port in PORTS
            for record in (
                input_(f"{port}.force", (0.0, 0.0, 0.0), "N", "on the body, frame B", nominal=1e4, slope=True, added=True),
                input_(
                    f"{port}.torque", (0.0, 0.0, 0.0), "N.m", "on the body about B's origin, frame B", nominal=1e4, slope=True, added=True
                ),
            )
        ),
        input_("body.reference_velocity", (0.0, 0.0, 0.0), "m/s", "body.velocity reached in the last pass, frame L", nominal=1.0),
        input_("body.reference_angular_velocity", (0.0, 0.0, 0.0), "rad/s", "body.angular_velocity reached in the last pass", nominal=0.1),
        input_("body.reference_valid", 0.0, "1", "1 where there was a last pass over this interval, else 0", nominal=1.0),
        *(record for port in LEGS for record in model_inputs(port)),
        output("body.position", (4.0, 0.0, 0.0), "m", "of the origin of B, frame L", nominal=1.0),
        output("body.quaternion", (1.0, 0.0, 0.0, 0.0), "1", "attitude (w, x, y, z), B to L", nominal=1.0),
        output("body.velocity", (0.0, 0.0, 0.0), "m/s", "of the origin of B, frame L", nominal=1.0),
        output("body.angular_velocity", (0.0, 0.0, 0.0), "rad/s", "frame B", nominal=0.1),
        output("body.acceleration", (0.0, 0.0, 0.0), "m/s2", "of the origin of B, frame L", nominal=1.0, mean=True, slope=True),
        output("body.angular_acceleration", (0.0, 0.0, 0.0), "rad/s2", "frame B", nominal=1.0, mean=True, slope=True),
        *(output(f"attitude.{a}", 0.0, "rad", f"{a} angle, 321 sequence", nominal=1.0) for a in ("yaw", "pitch", "roll")),
        *(output(f"rates.{a}", 0.0, "rad/s", f"{a} rate, frame B", nominal=0.1, mean=True, slope=True) for a in ("yaw", "pitch", "roll")),
        output("energy.kinetic", 0.0, "J", "of the whole vehicle, gear undeformed", nominal=1e3),
        output("energy.potential", 0.0, "J", "m g x, zero at the origin of L", nominal=1e3),
        *(output(f"{port}.work", 0.0, "J", "done on the body through this port since the start", nominal=1e3) for port in PORTS),
    )

    experiment = (0.0, 0.5, 5e-3)
    reference_parameters = (("rates_start", (-0.0108, 0.1, -0.05)),)

    @classmethod
    def stimulus(cls, time: float) -> dict[str, Any]:
        """Thrust that decays, and a push of leg 1 off the middle."""
        return {
            "engine.force": (5000.0 * (1.0 - time), 0.0, 0.0),
            "engine.force_slope": (-5000.0, 0.0, 0.0),
            "leg1.force": (2000.0, 300.0, -100.0),
            "leg1.torque": (50.0, 4000.0, -200.0),
        }

    def check(self) -> Iterable[str]:
        yield from inertia_of_no_body(self)

    def prepare(self) -> None:
        inertia = inertia_matrix(triple(self["inertia"]), triple(self["inertia_products"]))
        self.body = Body(self.value("mass"), inertia, self.value("gravity"))
        self.inputs = (
            self.span(f"{PORTS[0]}.force", f"{PORTS[-1]}.torque_added").reshape(len(PORTS), WRENCH),
            self.span(f"{LEGS[0]}.model_lever", f"{LEGS[-1]}.model_ground_damping").reshape(len(LEGS), NUMBERS),
            self.span("body.reference_velocity", "body.reference_valid"),
        )
        self.outputs = (
            self.span("body.position", "body.angular_acceleration_slope"),
            self.span("attitude.yaw", "energy.potential"),
            self.span(f"{PORTS[0]}.work", f"{PORTS[-1]}.work"),
        )

    def initialise(self) -> None:
        attitude = from_yaw_pitch_roll(self.value("yaw_start"), self.value("pitch_start"), self.value("roll_start"))
        velocity = apply(rotation(attitude), triple(self["velocity_start"]))
        now = BodyState(triple(self["position_start"]), attitude, velocity, triple(self["rates_start"]))
        rate = body_rate(self.body, now, UNLOADED, 0.0)  # the wrenches are not known yet: legs wait for the body's motion
        write_body(self.body, now, *self.outputs[:2])
        for axis, value in zip(("yaw", "pitch", "roll"), now.rate, strict=True):
            self[f"rates.{axis}_mean"] = value
        self["body.acceleration"] = self["body.acceleration_mean"] = rate.acceleration
        self["body.angular_acceleration"] = self["body.angular_acceleration_mean"] = rate.spin_up

    def advance(self, time: float, step: float) -> None:
        advance_body(self.body, LONGEST, step, *self.inputs, *self.outputs)


def inertia_of_no_body(unit: Unit) -> Iterable[str]:
    """What is wrong with a unit's `inertia` and `inertia_products`: no body has a principal moment beyond the sum of the other two."""
    least, middle, largest = np.linalg.eigvalsh(inertia_matrix(triple(unit["inertia"]), triple(unit["inertia_products"]))).tolist()
    if not (least > 0.0 and largest <= (least + middle) * (1.0 + ROUNDING)):
        yield (
            f"inertia and inertia_products: the principal moments are {least:g}, {middle:g} and {largest:g} kg.m2, "
            "expects each more than 0 and at most the sum of the other two"
        )


def triple(view: Array) -> Vector:
    """A view of three numbers as a tuple."""
    x, y, z = view.tolist()
    return (x, y, z)
