"""MassSpring: the toy unit on which the shell is tested."""

from math import cos, sin, sqrt

from ..shell import Unit, UnitError, input_, output, parameter, state


class MassSpring(Unit):
    """m d2x/dt2 = F - k x, exact for a force held over the interval."""

    description = "A mass on a spring."
    variables = (
        parameter("mass", 2.0, "kg", "of the body", minimum=1e-6),
        parameter("rate", 8.0, "N/m", "of the spring", minimum=0.0),
        parameter("law", 1, "1", "1: linear", integer=True, minimum=1, maximum=2),
        parameter("longest", 5.0, "m", "stroke at which the spring breaks"),
        input_("end.force", (0.0, 0.0), "N", "along x, y, frame L", nominal=1.0, slope=True, added=True),
        input_("held", False, "", "the mass is held", boolean=True),
        output("end.position", (0.1, 0.0), "m", "frame L", nominal=1.0),
        output("end.acceleration", (0.0, 0.0), "m/s2", "frame L", depends=("end.force", "end.force_added"), mean=True),
        output("end.free", False, "", "not held", boolean=True),
        state("velocity", (0.0, 0.0)),
        state("steps", 0.0),
    )

    def prepare(self) -> None:
        self.omega = sqrt(self.value("rate") / self.value("mass"))

    def check(self) -> list[str]:
        return ["rate is 13.0 N/m, expects any other number"] if self.value("rate") == 13.0 else []

    def initialise(self) -> None:
        self["end.position"] = (0.1 * self.value("mass"), 0.0)
        self["end.acceleration"] = self["end.force"] / self.value("mass")
        self["end.free"] = 1.0 - self["held"]

    def advance(self, time: float, step: float) -> None:
        x, v, w = self["end.position"], self["velocity"], self.omega
        if self.value("mass") == 3.0:
            x[0] = 1.0 / (self.value("mass") - 3.0)
        rest = (self["end.force"] + self["end.force_added"]) / self.value("rate")
        c, s = cos(w * step), sin(w * step)
        x[:], v[:] = rest + c * (x - rest) + s / w * v, -w * s * (x - rest) + c * v
        self["end.free"] = 1.0 - self["held"]
        self["steps"] += 1.0
        if abs(x).max() > self.value("longest"):
            raise UnitError(f"end.position is {abs(x).max():.6g} m, expects at most longest, {self.value('longest')} m")
