"""What the units in C declare: every variable once, for modelDescription.xml of FMI 2.0 and 3.0 and for the C source."""

from math import pi
from typing import NamedTuple

POWERS = {
    "1": {},
    "1/kg": {"kg": -1},
    "1/s": {"s": -1},
    "1/s2": {"s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N/s": {"kg": 1, "m": 1, "s": -3},
    "deg/s": {"rad": 1, "s": -1, "factor": pi / 180},
    "deg/s2": {"rad": 1, "s": -2, "factor": pi / 180},
    "kg": {"kg": 1},
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "m/s2": {"m": 1, "s": -2},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "s": {"s": 1},
}
"""Units of measure by exponents of the base units, with the factor to SI where it is not 1."""


class Variable(NamedTuple):
    causality: str
    name: str
    unit: str
    """"Boolean" for one, "Phase" for the enumeration."""
    text: str
    start: float | tuple[float, ...] = 0.0
    """A tuple: a vector."""
    nominal: float = 1.0

    @property
    def size(self) -> int:
        return len(self.start) if isinstance(self.start, tuple) else 1

    @property
    def starts(self) -> tuple[float, ...]:
        return self.start if isinstance(self.start, tuple) else (self.start,)


class Table(NamedTuple):
    description: str
    kind: str
    """The unit of ours whose place it takes."""
    variables: tuple[Variable, ...]
    enumeration: tuple[str, ...] = ()
    """Names of Phase's values, from 1."""


ZERO = (0.0, 0.0, 0.0)
NINE = (0.0,) * 9
AXES = ("yaw", "pitch", "roll")

GNC = Table(
    "Descent-rate hold, attitude hold with jets, engine cut-off on contact; sampled.",
    "GuidanceControl",
    (
        Variable("parameter", "sample_time", "s", "between samples", 0.05),
        Variable("parameter", "descent_rate", "m/s", "commanded", 0.9),
        Variable("parameter", "mass", "kg", "of the vehicle, as the controller believes", 7063.5),
        Variable("parameter", "gravity", "m/s2", "as the controller believes", 1.63),
        Variable("parameter", "rate_time", "s", "in which an error of the descent rate is to be made good", 0.5),
        Variable("parameter", "thrust_minimum", "N", "of the engine, firing", 4700.0, 1e4),
        Variable("parameter", "thrust_maximum", "N", "of the engine", 28000.0, 1e4),
        Variable("parameter", "decay_time", "s", "from cut-off to zero thrust, 0: at once", 0.0),
        Variable("parameter", "attitude_command", "rad", "yaw, pitch, roll", ZERO),
        Variable("parameter", "deadband", "rad", "of the jets' switching", 0.005),
        Variable("parameter", "lead", "s", "of the jets' switching", 0.5),
        Variable("parameter", "jet_torque", "N.m", "of the jets about X, Y, Z of frame B, on", (1490.0, 1490.0, 1490.0), 1e3),
        *(Variable("input", f"attitude.{a}", "rad", f"{a} angle") for a in AXES),
        *(Variable("input", f"rates.{a}", "rad/s", f"{a} rate, frame B", 0.0, 0.1) for a in AXES),
        Variable("input", "body.position", "m", "origin of B, frame L", ZERO),
        Variable("input", "body.velocity", "m/s", "of the origin of B, frame L", ZERO),
        *(Variable("input", f"contact{k}", "Boolean", f"pad or probe {k} touches") for k in range(1, 9)),
        Variable("output", "engine.force", "N", "on the body, frame B", ZERO, 1e4),
        Variable("output", "engine.torque", "N.m", "of the jets on the body, frame B, about the origin of B", ZERO, 1e4),
        Variable("output", "engine.thrust", "N", "thrust along +X of B", 0.0, 1e4),
        Variable("output", "engine.on", "Boolean", "whether there is thrust"),
        Variable("output", "phase", "Phase", "what the controller is at", 1.0),
        Variable("output", "next_event_time", "s", "of the next sample"),
        Variable("local", "shut_down_time", "s", "of the cut-off", -1.0),
        Variable("local", "thrust_at_shut_down", "N", "from which it decays", 0.0, 1e4),
    ),
    ("descent", "shut down"),
)

SOIL = Table(
    "Regolith at one point: rate-independent compaction and friction, no plowing.",
    "RegolithContact",
    (
        Variable("parameter", "bearing_strength", "N/m", "K", 350254.0, 1e5),
        Variable("parameter", "rebound_band", "m", "b, over which the ground lets go", 1e-4),
        Variable("parameter", "friction", "1", "mu", 0.33),
        Variable("parameter", "slip_velocity", "m/s", "regularises the sign of friction", 1e-3),
        Variable("parameter", "ground_slope", "rad", "of the plane; at azimuth 0 it rises toward +Z of L"),
        Variable("parameter", "ground_azimuth", "rad", "of the slope about L's x axis"),
        Variable("parameter", "ground_origin", "m", "a point of the plane, frame L", ZERO),
        Variable("parameter", "footpad_height", "m", "base to ball joint", 0.10),
        Variable("parameter", "longest_substep", "s", "of the integrator inside", 2e-6),
        Variable("input", "pad.position", "m", "of the ball joint, frame L", (1.0, 0.0, 0.0)),
        Variable("input", "pad.velocity", "m/s", "of the ball joint, frame L", ZERO),
        Variable("input", "pad.model_acceleration", "m/s2", "a_f: of the ball joint without force, frame L", ZERO),
        Variable("input", "pad.model_mobility", "1/kg", "Y, by rows, frame L", NINE, 0.04),
        Variable("input", "pad.model_stiffness", "1/s2", "A_x, by rows, frame L", NINE, 1e6),
        Variable("input", "pad.model_damping", "1/s", "A_v, by rows, frame L", NINE, 1e4),
        Variable("input", "pad.model_base_velocity", "m/s", "V_b, frame L", ZERO),
        Variable("input", "pad.model_base_acceleration", "m/s2", "A_b, frame L", ZERO),
        Variable("output", "pad.force", "N", "on the pad, frame L", ZERO, 1e4),
        Variable("output", "pad.force_mean", "N", "mean of pad.force over the last interval", ZERO, 1e4),
        Variable("output", "pad.force_slope", "N/s", "slope of pad.force over the last interval", ZERO, 1e6),
        Variable("output", "pad.predicted_position", "m", "of the ball joint, frame L", ZERO),
        Variable("output", "pad.predicted_velocity", "m/s", "of the ball joint, frame L", ZERO),
        Variable("output", "penetration", "m", "depth of the base's centre below the surface", 0.0, 0.05),
        Variable("output", "gap", "m", "height of the base's centre above the surface along L's x; negative in the soil", 0.0, 0.1),
        Variable("output", "skid", "m", "slide of the base's centre in the soil since first contact", 0.0, 0.1),
        Variable("output", "normal_force", "N", "along the surface's normal", 0.0, 1e4),
        Variable("output", "pad.work", "J", "done on the soil by the pad since the start", 0.0, 1e3),
        Variable("output", "contact", "Boolean", "whether the base's centre is in the soil"),
        Variable("local", "deepest", "m", "greatest depth so far"),
        Variable("local", "slide", "m", "of the base's centre in the soil, frame L", ZERO),
    ),
)

SENSOR = Table(
    "Rate gyro in degrees a second with a first-order lag.",
    "RateSensor",
    (
        Variable("parameter", "time_constant", "s", "of the lag", 0.05),
        *(
            variable
            for axis in AXES
            for variable in (
                Variable("input", f"rates.{axis}", "deg/s", f"true {axis} rate, frame B"),
                Variable("input", f"rates.{axis}_slope", "deg/s2", f"slope of rates.{axis} over the coming interval"),
            )
        ),
        *(Variable("output", f"telemetry.{axis}", "deg/s", f"received {axis} rate") for axis in AXES),
    ),
)
