"""ThrustGroundEffect: the engine's plume pushes the vehicle up near the ground."""

from typing import Any

from ..laws.base_motion import BaseState, base_at
from ..laws.plume import Plume, plume_force
from ..laws.vectors import apply_transposed, rotation
from ..shell import Unit, parameter
from ._effects import BODY, KIND, REQUIRED, THRUST, effect, motion_of


def plume_of(unit: Unit, prefix: str = "") -> Plume:
    """The law's parameters."""
    return Plume(*(unit.value(prefix + name) for name in ("share", "height", "rest_height")))


class ThrustGroundEffect(Unit):
    """A force along the body's X axis that grows toward the ground: share T exp(-h/height), h = body.position[1] - rest_height.

    The mean over an interval is Simpson's, from the thrust as it comes and the body's motion as it is told.
    """

    description = "Ground effect of the descent engine's plume on the body."
    kind, required = KIND, REQUIRED
    variables = (
        parameter("share", 0.0, "1", "of the thrust, at rest_height; 0: none"),
        parameter("height", 1.0, "m", "over which the force falls to 1/e", minimum=1e-3),
        parameter("rest_height", 3.6, "m", "height of the origin of B when the vehicle stands"),
        THRUST,
        *BODY,
        *effect("engine.thrust", "body.position", "share", "height", "rest_height"),
    )

    experiment = (0.0, 1.0, 0.02)
    reference_parameters = (("share", 0.2),)

    @classmethod
    def stimulus(cls, time: float) -> dict[str, Any]:
        """Sinking at half a metre a second under fading thrust."""
        return {
            "engine.thrust": 5000.0 * (1.0 - time),
            "engine.thrust_slope": -5000.0,
            "body.position": (4.1 - 0.5 * time, 0.0, 0.0),
            "body.velocity": (-0.5, 0.0, 0.0),
        }

    def prepare(self) -> None:
        self.plume = plume_of(self)

    def force_at(self, state: BaseState, t: float) -> float:
        """Along X, N, t seconds into the interval."""
        return plume_force(self.plume, self.value("engine.thrust") + t * self.value("engine.thrust_slope"), state.position[0])

    def initialise(self) -> None:
        self["effect.force"] = (plume_force(self.plume, self.value("engine.thrust"), float(self["body.position"][0])), 0.0, 0.0)

    def advance(self, time: float, step: float) -> None:
        motion = motion_of(self)
        states = [base_at(motion, share * step) for share in (0.0, 0.5, 1.0)]
        first, middle, last = (self.force_at(state, share * step) for state, share in zip(states, (0.0, 0.5, 1.0), strict=True))
        along = [apply_transposed(rotation(state.attitude), state.velocity)[0] for state in states]
        self["effect.force"] = (last, 0.0, 0.0)
        self["effect.force_mean"] = ((first + 4.0 * middle + last) / 6.0, 0.0, 0.0)
        self["effect.force_slope"] = ((last - first) / step, 0.0, 0.0)
        self["effect.work"] -= step * (first * along[0] + 4.0 * middle * along[1] + last * along[2]) / 6.0
