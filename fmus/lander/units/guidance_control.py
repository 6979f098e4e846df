"""GuidanceControl: by default the descent engine's tail-off; the slot in which other guidance takes its place."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..laws.tailoff import fitted_slope, mean_thrust, thrust, thrust_points
from ..shell import Unit, input_, nanoseconds, output, parameter, state

CONTACTS = range(1, 9)
POINTS = 8


def corners_of(unit: Unit, prefix: str = "") -> Any:
    """The corners of the law of thrust."""
    start, decay = unit.value(prefix + "thrust_start"), unit.value(prefix + "decay_time")
    return thrust_points(start, decay, unit[prefix + "table_time"], unit[prefix + "table_thrust"], int(unit.value(prefix + "table_points")))


def falling_times(unit: Unit, prefix: str = "") -> Iterable[str]:
    """What is wrong with the table of thrust, a line each."""
    times = unit[prefix + "table_time"][: int(unit.value(prefix + "table_points"))]
    for i in np.flatnonzero(np.diff(times) <= 0.0):
        name = f"{prefix}table_time"
        yield f"{name}[{i + 2}] is {times[i + 1]} s, expects more than {name}[{i + 1}], {times[i]} s"


class GuidanceControl(Unit):
    """Thrust along the body's X axis as a function of time since the first contact of any pad or probe.

    before contact   T = thrust_before_contact
    after it         T = thrust_start max(0, 1 - τ/decay_time), or a table of up to eight points, zero after its last

    A contact is seen at the start of the interval in which its signal is set: τ = 0 there. The force acts along +X of frame B through
    the line of thrust at thrust_offset; the torque is about the origin of B, about X it is the jet's swirl times thrust.
    engine.force_mean is exact (the law is piecewise linear in time), force_slope is the slope of the nearest straight line over the
    interval, force the value at its end. next_event_time is the next corner of the law after the interval. Attitude, rates, position and
    velocity are
    taken for the sake of the port's contract, and not used.
    """

    description = "Descent engine tail-off: thrust over time since first contact."
    required = (*(f"contact{k}" for k in range(1, 5)), "engine.force", "engine.torque")
    variables = (
        parameter("table_points", 0, "1", "points in use of the thrust table, 0: the decay", integer=True, minimum=0, maximum=POINTS),
        parameter("table_time", (0.0,) * POINTS, "s", "time since first contact, rising", minimum=0.0),
        parameter("table_thrust", (0.0,) * POINTS, "N", "thrust at these times", minimum=0.0),
        parameter("thrust_start", 0.0, "N", "thrust at first contact", minimum=0.0),
        parameter("decay_time", 0.0, "s", "time from first contact to zero thrust, 0: at once", minimum=0.0),
        parameter("thrust_before_contact", 0.0, "N", "thrust until first contact", minimum=0.0),
        parameter("thrust_offset", (0.0, 0.0), "m", "Y and Z of the line of thrust in frame B"),
        parameter("swirl", 0.0, "m", "torque about X by thrust"),
        *(input_(f"attitude.{a}", 0.0, "rad", f"{a} angle", nominal=1.0) for a in ("yaw", "pitch", "roll")),
        *(input_(f"rates.{a}", 0.0, "rad/s", f"{a} rate, frame B", nominal=0.1) for a in ("yaw", "pitch", "roll")),
        input_("body.position", (0.0, 0.0, 0.0), "m", "origin of B, frame L", nominal=1.0),
        input_("body.velocity", (0.0, 0.0, 0.0), "m/s", "of the origin of B, frame L", nominal=1.0),
        *(input_(f"contact{k}", False, "", f"pad or probe {k} touches", boolean=True) for k in CONTACTS),
        output(
            "engine.force",
            (0.0, 0.0, 0.0),
            "N",
            "on the body, frame B",
            nominal=1e4,
            mean=True,
            slope=True,
            initially=("thrust_before_contact",),
        ),
        output(
            "engine.torque",
            (0.0, 0.0, 0.0),
            "N.m",
            "on the body, frame B, about the origin of B",
            nominal=1e4,
            mean=True,
            slope=True,
            initially=("thrust_before_contact", "thrust_offset", "swirl"),
        ),
        output("engine.thrust", 0.0, "N", "thrust along +X of B", nominal=1e4, mean=True, slope=True, initially=("thrust_before_contact",)),
        output("engine.on", False, "", "whether there is thrust", boolean=True, initially=("thrust_before_contact",)),
        output("next_event_time", -1.0, "s", "next corner of the law of thrust, -1: none", nominal=1.0, initially=()),
        state("contact_time", -1.0, "time of first contact"),
        state("touched", 0.0),
    )

    experiment = (0.0, 1.0, 0.02)
    reference_parameters = (("thrust_before_contact", 12000.0), ("thrust_start", 12000.0), ("decay_time", 0.5))

    @classmethod
    def stimulus(cls, time: float) -> dict[str, float]:
        return {"contact2": float(time >= 0.25), "contact4": float(time >= 0.4)}

    def prepare(self) -> None:
        self.corners = corners_of(self)

    def check(self) -> Iterable[str]:
        return falling_times(self)

    def initialise(self) -> None:
        before = self.value("thrust_before_contact")
        self.show(before, before, 0.0)

    def advance(self, time: float, step: float) -> None:
        if not self.value("touched") and self.span("contact1", "contact8").any():
            self["touched"], self["contact_time"] = 1.0, time
        if not self.value("touched"):
            self.initialise()
            return
        tau = max(0.0, time - self.value("contact_time"))
        self.show(thrust(tau + step, self.corners), mean_thrust(tau, step, self.corners), fitted_slope(tau, step, self.corners))
        self["next_event_time"] = self.next_corner(nanoseconds(time + step))

    def next_corner(self, now: int) -> float:
        """The first corner after a time in ns, in s; -1 where none is left."""
        instants = (self.value("contact_time") + self.corners[:, 0]).tolist()
        return next((instant for instant in instants if nanoseconds(instant) > now), -1.0)

    def show(self, end: float, mean: float, slope: float) -> None:
        """Fill the outputs: force along X, torque r × F of the offset line of thrust and of the jet's swirl."""
        (y, z), swirl = self["thrust_offset"], self.value("swirl")
        for suffix, value in (("", end), ("_mean", mean), ("_slope", slope)):
            self["engine.force" + suffix] = (value, 0.0, 0.0)
            self["engine.torque" + suffix] = (0.0 + swirl * value, z * value, 0.0 - y * value)
            self["engine.thrust" + suffix] = value
        self["engine.on"] = float(end > 0.0)
