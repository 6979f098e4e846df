"""SpringFollower: a second mass, tied to a wall and, by a spring with damper, to an end that moves."""

import numpy as np

from ..shell import Unit, input_, output, parameter, state

SUBSTEP = 2e-4   # s, of the classical fourth-order method inside: its error is far below that of any coupling


class SpringFollower(Unit):
    """m x" = k (u - x) + c (u' - x') - k2 x;  it pulls the end by the same force. u and u' run linearly over the interval."""

    description = "A mass tied to a moving end."
    initially = ("end.position", "end.velocity")
    variables = (
        parameter("mass", 1.0, "kg", "m", minimum=1e-6),
        parameter("rate", 20.0, "N/m", "k", minimum=0.0),
        parameter("damping", 0.4, "N.s/m", "c", minimum=0.0),
        parameter("wall_rate", 60.0, "N/m", "k2", minimum=0.0),
        input_("end.position", 0.0, "m", "u", slope=True),
        input_("end.velocity", 0.0, "m/s", "u'", slope=True),
        output("end.force", 0.0, "N", "on the end"),
        state("own", (0.0, 0.0), "position and velocity of the mass"),
    )

    def initialise(self) -> None:
        self["end.force"] = -self.pull(0.0, *self["own"].tolist())

    def pull(self, t: float, x: float, v: float) -> float:
        """The tie's force on the mass."""
        u = self.value("end.position") + self.value("end.position_slope") * t
        w = self.value("end.velocity") + self.value("end.velocity_slope") * t
        return self.value("rate") * (u - x) + self.value("damping") * (w - v)

    def rates(self, t: float, y: np.ndarray) -> np.ndarray:
        x, v = y.tolist()
        return np.array([v, (self.pull(t, x, v) - self.value("wall_rate") * x) / self.value("mass")])

    def advance(self, time: float, step: float) -> None:
        count = max(1, round(step / SUBSTEP))
        h, y = step / count, self["own"].copy()
        for number in range(count):
            t = number * h
            k1 = self.rates(t, y)
            k2 = self.rates(t + 0.5 * h, y + 0.5 * h * k1)
            k3 = self.rates(t + 0.5 * h, y + 0.5 * h * k2)
            k4 = self.rates(t + h, y + h * k3)
            y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        self["own"] = y
        self["end.force"] = -self.pull(step, *y.tolist())
