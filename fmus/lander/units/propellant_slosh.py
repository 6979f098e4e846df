"""PropellantSlosh: a spherical pendulum of propellant in the body."""

from math import ceil
from typing import Any

from ..laws.base_motion import as_base, base_at
from ..laws.slosh import Pendulum, Sway, slosh_wrench, sway_acceleration, swayed
from ..laws.vectors import ZERO, Vector, add, apply_transposed, axpy, rotation, scale, sub
from ..shell import Unit, parameter, state
from ._effects import BODY, KIND, REQUIRED, effect, motion_of, power, vector_of

LONGEST = 2e-3  # s, of the integrator


def pendulum_of(unit: Unit, prefix: str = "") -> Pendulum:
    """The law's parameters."""
    mass, length, damping = (unit.value(prefix + name) for name in ("mass", "length", "damping"))
    return Pendulum(mass, length, damping, vector_of(unit, prefix + "hinge"))


class PropellantSlosh(Unit):
    """A pendulum at small angles in the body's apparent gravity, hanging from `hinge` along -X; its mass is part of the vehicle's.

    What acts on the body is what the sideways motion adds to the same mass frozen (laws/slosh.py). It hangs at rest at the start.
    The mean of the force over an interval is what the bob's sideways momentum changed by.
    """

    description = "Propellant slosh: a pendulum's reaction on the body."
    kind, required = KIND, REQUIRED
    variables = (
        parameter("mass", 0.0, "kg", "that sloshes, part of the vehicle's mass; 0: none", minimum=0.0),
        parameter("length", 0.6, "m", "of the pendulum", minimum=1e-2),
        parameter("damping", 0.02, "1", "ratio to critical", minimum=0.0),
        parameter("hinge", (0.3, 0.0, 0.0), "m", "of the pendulum, frame B"),
        parameter("gravity", 1.63, "m/s2", "along -x of L", minimum=0.0, maximum=100.0),
        *BODY,
        *effect(),
        state("place", (0.0, 0.0, 0.0)),
        state("velocity", (0.0, 0.0, 0.0)),
    )

    experiment = (0.0, 1.0, 0.02)
    reference_parameters = (("mass", 300.0),)

    @classmethod
    def stimulus(cls, time: float) -> dict[str, Any]:
        """A body that stands and is pushed to the right ever less."""
        return {"body.acceleration": (0.0, 0.5 * (1.0 - time), 0.0), "body.acceleration_slope": (0.0, -0.5, 0.0)}

    def prepare(self) -> None:
        self.pendulum = pendulum_of(self)

    def advance(self, time: float, step: float) -> None:
        motion, gravity = motion_of(self), self.value("gravity")
        sway = Sway(vector_of(self, "place"), vector_of(self, "velocity"))
        parts = ceil(step / LONGEST)
        h = step / parts
        first = slosh_wrench(self.pendulum, as_base(base_at(motion, 0.0), gravity), sway)
        force, torque, work = ZERO, ZERO, 0.0
        for k in range(parts):
            middle = base_at(motion, (k + 0.5) * h)
            base = as_base(middle, gravity)
            half = swayed(sway, sway_acceleration(self.pendulum, as_base(base_at(motion, k * h), gravity), sway), 0.5 * h)
            a = sway_acceleration(self.pendulum, base, half)
            f, m = slosh_wrench(self.pendulum, base, half)
            force, torque = add(force, f), add(torque, m)
            work -= h * power(f, m, apply_transposed(rotation(middle.attitude), middle.velocity), middle.rate)
            sway = Sway(axpy(h, half.velocity, sway.place), axpy(h, a, sway.velocity))
        self["place"], self["velocity"] = sway.place, sway.velocity
        last = slosh_wrench(self.pendulum, as_base(base_at(motion, step), gravity), sway)
        self.show("effect.force", first[0], scale(1.0 / parts, force), last[0], step)
        self.show("effect.torque", first[1], scale(1.0 / parts, torque), last[1], step)
        self["effect.work"] += work

    def show(self, name: str, first: Vector, mean: Vector, last: Vector, step: float) -> None:
        """One output with its companions."""
        self[name], self[name + "_mean"], self[name + "_slope"] = last, mean, scale(1.0 / step, sub(last, first))
