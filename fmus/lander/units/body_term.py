"""BodyTerm: a generic wrench on the body, for laws nobody has a name for yet."""

from typing import Any

from ..laws.base_motion import BaseState, base_at
from ..laws.body_term import Term, basis_value, term_wrench
from ..laws.vectors import Vector, add, apply_transposed, axpy, rotation, scale, sub, yaw_pitch_roll
from ..shell import Unit, parameter
from ._effects import BODY, KIND, POSE, REQUIRED, THRUST, effect, motion_of, power


def term_of(unit: Unit, prefix: str = "") -> Term:
    """The law's parameters."""
    axis, basis = (int(unit.value(prefix + name)) for name in ("axis", "basis"))
    return Term(unit.value(prefix + "coefficient"), axis, basis, unit.value(prefix + "time"))


class BodyTerm(Unit):
    """A coefficient times a basis, along (axis 1 to 3) or about (4 to 6) X, Y or Z of the body.

    basis  1 constant; 2 exp(-t/time); 3 velocity along the axis / 0.1 m/s; 4 that times its absolute value; 5 rate about the axis /
           0.1 rad/s; 6 that times its absolute value; 7 attitude angle (yaw, pitch, roll) about the axis / 0.1 rad; 8 thrust / 1000 N
    The mean over an interval is Simpson's, from the body's motion as it is told.
    """

    description = "Generic term of force or torque on the body."
    kind, required = KIND, REQUIRED
    variables = (
        parameter("coefficient", 0.0, "1", "N along an axis, N.m about one; 0: none"),
        parameter("axis", 1, "1", "1 to 6: Fx, Fy, Fz, Tx, Ty, Tz in frame B", integer=True, minimum=1, maximum=6),
        parameter("basis", 1, "1", "1 to 8: what the term follows", integer=True, minimum=1, maximum=8),
        parameter("time", 1.0, "s", "time constant of basis 2", minimum=1e-6),
        THRUST,
        *BODY,
        *effect("engine.thrust", *POSE, "coefficient", "axis", "basis", "time"),
    )

    experiment = (0.0, 1.0, 0.02)
    reference_parameters = (("coefficient", -100.0), ("axis", 5), ("basis", 6))

    @classmethod
    def stimulus(cls, time: float) -> dict[str, Any]:
        """Pitching ever faster."""
        return {"body.angular_velocity": (0.0, 0.2 * time, 0.0), "body.angular_acceleration": (0.0, 0.2, 0.0)}

    def prepare(self) -> None:
        self.term = term_of(self)

    def wrench_at(self, state: BaseState, time: float, t: float) -> tuple[Vector, Vector]:
        """Force and torque t seconds into the interval that begins at a time."""
        velocity = apply_transposed(rotation(state.attitude), state.velocity)
        thrust = self.value("engine.thrust") + t * self.value("engine.thrust_slope")
        since = time + t - self.start_time
        return term_wrench(self.term, basis_value(self.term, since, velocity, state.rate, yaw_pitch_roll(state.attitude), thrust))

    def initialise(self) -> None:
        self["effect.force"], self["effect.torque"] = self.wrench_at(base_at(motion_of(self), 0.0), self.start_time, 0.0)

    def advance(self, time: float, step: float) -> None:
        motion, instants = motion_of(self), (0.0, 0.5 * step, step)
        states = [base_at(motion, t) for t in instants]
        wrenches = [self.wrench_at(state, time, t) for state, t in zip(states, instants, strict=True)]
        for name, (first, middle, last) in zip(("effect.force", "effect.torque"), zip(*wrenches, strict=True), strict=True):
            self[name], self[name + "_slope"] = last, scale(1.0 / step, sub(last, first))
            self[name + "_mean"] = scale(1.0 / 6.0, axpy(4.0, middle, add(first, last)))
        powers = [
            power(*wrench, apply_transposed(rotation(s.attitude), s.velocity), s.rate) for wrench, s in zip(wrenches, states, strict=True)
        ]
        self["effect.work"] -= step * (powers[0] + 4.0 * powers[1] + powers[2]) / 6.0
