"""QuarterSoil: soil under the quarter vehicle's pad, without memory."""

from math import cos, pi

from ..shell import Unit, input_, output, parameter
from ._step_count import StepCount


class QuarterSoil(Unit):
    """F = max(0, K δ^p + w_d C δ'),  w_d = (1 - cos(π δ/δ_d))/2 up to δ_d: eqs. 6 and 7 without w_b and w_r; Table 4, Adams-like.

    δ = -position. Stepped, not evaluated: the force is that at the end of the interval, of inputs that are held or run linearly over it.
    """

    description = "Soil under the quarter vehicle's pad."
    initially = ("pad.position", "pad.velocity")
    variables = (
        parameter("bearing_strength", 150000.0, "N/m", "K, N/m^p", minimum=0.0),
        parameter("compaction_exponent", 1.5, "1", "p", minimum=0.5),
        parameter("damping", 150000.0, "N.s/m", "C", minimum=0.0),
        parameter("damping_activation_depth", 0.1, "m", "δ_d", minimum=1e-6),
        input_("pad.position", 0.01, "m", "height above the untouched soil", nominal=1.0, slope=True),
        input_("pad.velocity", 0.0, "m/s", "up", nominal=1.0, slope=True),
        output("pad.force", 0.0, "N", "on the pad, up", nominal=1e4),
    )
    experiment = (0.0, 0.3, 1e-4)

    def prepare(self) -> None:
        self.count = StepCount("QuarterSoil")
        names = ("bearing_strength", "compaction_exponent", "damping", "damping_activation_depth")
        self.K, self.p, self.C, self.ramp = (self.value(name) for name in names)

    def initialise(self) -> None:
        self["pad.force"] = self.force(self.value("pad.position"), self.value("pad.velocity"))

    def do_step(self, current_time: float, step_size: float) -> bool:
        self.count.add()
        return super().do_step(current_time, step_size)

    def advance(self, time: float, step: float) -> None:
        at = self.layout.slices["pad.position"].start
        x, x_slope, v, v_slope = self.memory[at : at + 4].tolist()
        self["pad.force"] = self.force(x + x_slope * step, v + v_slope * step)

    def force(self, position: float, velocity: float) -> float:
        depth = -position
        if depth <= 0.0:
            return 0.0
        weight = 0.5 * (1.0 - cos(pi * depth / self.ramp)) if depth < self.ramp else 1.0
        return max(0.0, self.K * depth**self.p - weight * self.C * velocity)
