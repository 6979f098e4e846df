"""QuarterVehicle: two masses on a vertical line with a strut between them, the pad below."""

from math import exp, sqrt

from ..shell import Unit, input_, output, parameter, state
from ._step_count import StepCount


class QuarterVehicle(Unit):
    """M x_b" = S - M g,  m x_p" = F - S - m g,  S = -k (x_b - x_p - L) - c (x_b' - x_p').

    Linear, so it is solved exactly for a force F + F_slope t over the interval: the centre of mass flies a cubic, and the
    stretch y = x_b - x_p - L is a particular solution a + b t and two exponentials (the strut must be overdamped).
    Whole state in the shell's memory: rollback is exact.
    """

    description = "Quarter vehicle: body, strut and pad."
    variables = (
        parameter("body_mass", 1233.0, "kg", "M", minimum=1e-3),
        parameter("pad_mass", 11.0, "kg", "m", minimum=1e-3),
        parameter("stiffness", 1e6, "N/m", "k of the strut", minimum=1.0),
        parameter("damping", 1e4, "N.s/m", "c of the strut", minimum=0.0),
        parameter("free_length", 1.0, "m", "L of the strut", minimum=0.0),
        parameter("gravity", 1.62, "m/s2", "g"),
        parameter("height_start", 0.01, "m", "of the pad above the soil"),
        parameter("velocity_start", -1.0, "m/s", "of both masses, up"),
        input_("pad.force", 0.0, "N", "on the pad, up", nominal=1e4, slope=True),
        output("pad.position", 0.01, "m", "height above the untouched soil", nominal=1.0, initially=("height_start",)),
        output("pad.velocity", 0.0, "m/s", "up", nominal=1.0, initially=("velocity_start",)),
        state("centre", (0.0, 0.0), "of mass: position, velocity"),
        state("stretch", (0.0, 0.0), "of the strut, and its rate"),
    )
    experiment = (0.0, 0.3, 1e-4)

    def prepare(self) -> None:
        self.count = StepCount("QuarterVehicle")
        self.M, self.m = self.value("body_mass"), self.value("pad_mass")
        self.k, self.c, self.g = self.value("stiffness"), self.value("damping"), self.value("gravity")
        self.total, self.reduced = self.M + self.m, self.M * self.m / (self.M + self.m)
        half = 0.5 * self.c / self.reduced
        root = sqrt(max(half * half - self.k / self.reduced, 0.0))
        self.fast, self.slow = -half - root, -half + root

    def check(self) -> list[str]:
        limit = 2.0 * sqrt(self.k * self.reduced)
        return [] if self.c > limit else [f"damping is {self.c} N.s/m, expects more than {limit:.6g} N.s/m: an overdamped strut"]

    def initialise(self) -> None:
        x, v = self.value("height_start"), self.value("velocity_start")
        self["centre"] = (x + self.M / self.total * self.value("free_length"), v)
        self["stretch"] = (0.0, 0.0)
        self["pad.position"], self["pad.velocity"] = x, v

    def do_step(self, current_time: float, step_size: float) -> bool:
        self.count.add()
        return super().do_step(current_time, step_size)

    def advance(self, time: float, step: float) -> None:
        memory, slices = self.memory, self.layout.slices
        at = slices["pad.force"].start
        force, rise = memory[at].item(), memory[at + 1].item()
        at = slices["centre"].start
        X, V, y, w = memory[at : at + 4].tolist()
        h = step
        b = -rise * self.reduced / (self.m * self.k)
        a = -(force * self.reduced / self.m + self.c * b) / self.k
        z, dz = y - a, w - b
        second = (dz - self.slow * z) / (self.fast - self.slow)
        first = z - second
        p, q = first * exp(self.slow * h), second * exp(self.fast * h)
        y, w = p + q + a + b * h, self.slow * p + self.fast * q + b
        A, J = force / self.total - self.g, rise / self.total
        X, V = X + h * (V + h * (0.5 * A + h * J / 6.0)), V + h * (A + 0.5 * h * J)
        memory[at : at + 4] = X, V, y, w
        share = self.M / self.total
        at = slices["pad.position"].start
        memory[at : at + 2] = X - share * (y + self.value("free_length")), V - share * w
