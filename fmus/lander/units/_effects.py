"""What units attached to the body's sockets `effectK` share: the body's motion in, a wrench out."""

from ..laws.base_motion import BaseMotion
from ..laws.vectors import Quaternion, Vector, dot
from ..shell import Unit, input_, output
from ..shell.records import Record

BODY: tuple[Record, ...] = (
    input_("body.position", (4.0, 0.0, 0.0), "m", "of the origin of B, frame L", nominal=1.0),
    input_("body.quaternion", (1.0, 0.0, 0.0, 0.0), "1", "B to L", nominal=1.0),
    input_("body.velocity", (0.0, 0.0, 0.0), "m/s", "of the origin of B, frame L", nominal=1.0),
    input_("body.angular_velocity", (0.0, 0.0, 0.0), "rad/s", "frame B", nominal=0.1),
    input_("body.acceleration", (0.0, 0.0, 0.0), "m/s2", "of the origin of B, frame L", nominal=1.0, slope=True),
    input_("body.angular_acceleration", (0.0, 0.0, 0.0), "rad/s2", "frame B", nominal=1.0, slope=True),
)
THRUST = input_("engine.thrust", 0.0, "N", "of the descent engine", nominal=1e4, slope=True)
KIND, REQUIRED = "BodyEffect", ("effect.force", "effect.torque")
POSE = ("body.position", "body.quaternion", "body.velocity", "body.angular_velocity")


def effect(*initially: str) -> tuple[Record, ...]:
    """The port: the wrench on the body and the work done on this unit through it; `initially` its start depends on."""
    return (
        output("effect.force", (0.0, 0.0, 0.0), "N", "on the body, frame B", nominal=1e3, mean=True, slope=True, initially=initially),
        output(
            "effect.torque",
            (0.0, 0.0, 0.0),
            "N.m",
            "on the body about B's origin, frame B",
            nominal=1e3,
            mean=True,
            slope=True,
            initially=initially,
        ),
        output("effect.work", 0.0, "J", "done on this unit through the port since the start", nominal=1e3, initially=()),
    )


def motion_of(unit: Unit) -> BaseMotion:
    """The body's motion over the coming interval."""
    return BaseMotion(
        vector_of(unit, "body.position"),
        quaternion_of(unit, "body.quaternion"),
        vector_of(unit, "body.velocity"),
        vector_of(unit, "body.angular_velocity"),
        vector_of(unit, "body.acceleration"),
        vector_of(unit, "body.acceleration_slope"),
        vector_of(unit, "body.angular_acceleration"),
        vector_of(unit, "body.angular_acceleration_slope"),
    )


def vector_of(unit: Unit, name: str) -> Vector:
    """Three numbers of a unit as a tuple."""
    x, y, z = unit[name].tolist()
    return (x, y, z)


def quaternion_of(unit: Unit, name: str) -> Quaternion:
    """Four numbers of a unit as a tuple."""
    w, x, y, z = unit[name].tolist()
    return (w, x, y, z)


def power(force: Vector, torque: Vector, velocity: Vector, rate: Vector) -> float:
    """Of a wrench in B on a body that moves at velocity and rate, in B, W."""
    return dot(force, velocity) + dot(torque, rate)
