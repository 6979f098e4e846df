"""ReactionControl: a pulse of the attitude jets."""

from typing import Any

from ..laws.reaction_control import Pulse, fires, pulse_share, pulse_slope
from ..shell import Unit, nanoseconds, output, parameter
from ._effects import BODY, KIND, REQUIRED, effect, vector_of


def pulse_of(unit: Unit, prefix: str = "") -> Pulse:
    """The law's parameters; its start as an absolute time."""
    return Pulse(vector_of(unit, prefix + "torque"), unit.start_time + unit.value(prefix + "start"), unit.value(prefix + "duration"))


class ReactionControl(Unit):
    """A constant torque about the body's axes from `start` for `duration`, counted from the start of the run.

    Mean and first moment over an interval are exact; next_event_time is the pulse's next edge.
    """

    description = "Reaction control: a pulse of torque on the body."
    kind, required = KIND, REQUIRED
    variables = (
        parameter("torque", (0.0, 0.0, 0.0), "N.m", "about the axes of B; 0: none"),
        parameter("start", 0.0, "s", "of the pulse, after the start of the run", minimum=0.0),
        parameter("duration", 0.5, "s", "of the pulse", minimum=0.0),
        *BODY,
        *effect("torque", "start", "duration"),
        output("next_event_time", -1.0, "s", "next edge of the pulse, -1: none", nominal=1.0, initially=("torque", "start", "duration")),
    )

    experiment = (0.0, 1.0, 0.02)
    reference_parameters = (("torque", (0.0, 300.0, -100.0)), ("start", 0.25), ("duration", 0.33))

    @classmethod
    def stimulus(cls, time: float) -> dict[str, Any]:
        return {"body.angular_velocity": (0.0, 0.1, 0.0)}

    def prepare(self) -> None:
        self.pulse = pulse_of(self)

    def initialise(self) -> None:
        self.show(self.start_time, 1.0 if fires(self.pulse, self.start_time) else 0.0)

    def advance(self, time: float, step: float) -> None:
        share, slope = pulse_share(self.pulse, time, step), pulse_slope(self.pulse, time, step)
        torque, rate, turning = self["torque"], self["body.angular_velocity"], self["body.angular_acceleration"]
        self["effect.torque_mean"], self["effect.torque_slope"] = share * torque, slope * torque
        self["effect.work"] -= step * share * float(torque @ (rate + 0.5 * step * turning))
        self.show(time + step, 1.0 if fires(self.pulse, time + step) else 0.0)

    def show(self, time: float, share: float) -> None:
        """The torque at a time, and the next edge after it."""
        self["effect.torque"] = share * self["torque"]
        edges = (self.pulse.start, self.pulse.start + self.pulse.duration) if self["torque"].any() else ()
        self["next_event_time"] = next((edge for edge in edges if nanoseconds(edge) > nanoseconds(time)), -1.0)
