"""SpringMass: a mass on a spring, pushed at its end; exact for a force that runs linearly."""

from math import cos, sin, sqrt

from ..shell import Unit, input_, output, parameter


class SpringMass(Unit):
    """m x" = F + F_slope t - k x."""

    description = "A mass on a spring."
    variables = (
        parameter("mass", 1.0, "kg", "m", minimum=1e-6),
        parameter("rate", 40.0, "N/m", "k", minimum=1e-6),
        parameter("position_start", 0.1, "m", "at the start, at rest"),
        input_("end.force", 0.0, "N", "on the mass", slope=True),
        output("end.position", 0.0, "m", "of the mass"),
        output("end.velocity", 0.0, "m/s", "of the mass"),
    )

    def initialise(self) -> None:
        self["end.position"] = self["position_start"]

    def advance(self, time: float, step: float) -> None:
        k, w = self.value("rate"), sqrt(self.value("rate") / self.value("mass"))
        a, b = self.value("end.force") / k, self.value("end.force_slope") / k
        z, dz = self.value("end.position") - a, self.value("end.velocity") - b
        c, s = cos(w * step), sin(w * step)
        self["end.position"] = z * c + dz / w * s + a + b * step
        self["end.velocity"] = dz * c - w * z * s + b
