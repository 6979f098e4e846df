"""Generic terms on the body, and of the rate gyros."""

from __future__ import annotations

from collections.abc import Iterator

from orchestrator.diagnosis.terms.term import Energy, Term

FORCE, TORQUE = 200.0, 500.0  # N and N m at the reference point: one standard deviation
CONSTANT, FADING, SPEED, SPEED_SQUARED, RATE, RATE_SQUARED, TILT, THRUST = range(1, 9)
_AXES = ("Fx", "Fy", "Fz", "Tx", "Ty", "Tz")
_SAID = ("force along X", "force along Y", "force along Z", "torque about X", "torque about Y", "torque about Z")
_ANGLES = ("yaw", "pitch", "roll")
_FORMS: dict[int, tuple[str, str, str, float, tuple[Energy, Energy]]] = {
    CONSTANT: ("constant", "constant", "", 1.0, ("active", "active")),
    FADING: ("fading", "fading from the start", " exp(-t/τ)", 1.0, ("active", "active")),
    SPEED: ("speed", "linear in the velocity along it", " v/(0.1 m/s)", 3.0, ("active", "dissipative")),
    SPEED_SQUARED: ("speed2", "quadratic in the velocity along it", " v|v|/(0.1 m/s)²", 9.0, ("active", "dissipative")),
    RATE: ("rate", "linear in the rate about it", " ω/(0.1 rad/s)", 0.5, ("active", "dissipative")),
    RATE_SQUARED: ("rate2", "quadratic in the rate about it", " ω|ω|/(0.1 rad/s)²", 0.25, ("active", "dissipative")),
    TILT: ("tilt", "linear in the angle about it", " angle/(0.1 rad)", 1.0, ("conservative", "conservative")),
    THRUST: ("thrust", "in proportion to thrust", " T/(1000 N)", 3.0, ("active", "active")),
}
"""Basis -> name, words, formula, value at the reference point (0.3 m/s, 0.05 rad/s, 0.1 rad, 3000 N), energy for c > 0 and c < 0."""
_SIDEWAYS = (CONSTANT, FADING, SPEED, SPEED_SQUARED)
_ABOUT = (CONSTANT, FADING, RATE, RATE_SQUARED, TILT, THRUST)
_CHOSEN = {1: (SPEED, THRUST), 2: _SIDEWAYS, 3: _SIDEWAYS, 4: _ABOUT, 5: _ABOUT, 6: _ABOUT}
"""Axis -> bases; a force along X that lasts is another weight."""
_EQUALS = {(1, THRUST): "thrust_start", (4, THRUST): "swirl", (5, THRUST): "thrust_offset", (6, THRUST): "thrust_offset"}


def body_terms() -> Iterator[Term]:
    """c times one of eight bases, along or about an axis of B."""
    for axis, bases in _CHOSEN.items():
        for basis in bases:
            named, said, formula, reference, energy = _FORMS[basis]
            size, measure = (FORCE, "N") if axis <= 3 else (TORQUE, "N.m")
            yield Term(
                f"body_{_AXES[axis - 1]}_{named}",
                "body",
                "body",
                f"body, {_SAID[axis - 1]}, {said}",
                f"{_AXES[axis - 1]} += c{formula}",
                "body_term.coefficient",
                (("body_term.axis", axis), ("body_term.basis", basis)),
                size / reference,
                measure,
                *energy,
                _EQUALS.get((axis, basis), ""),
            )


def sensor_terms() -> Iterator[Term]:
    """What the rate gyros add of their own: lag, scale, bias and misalignment."""
    yield _sensor("lag", "lag", "τ dy/dt = u - y, τ = c", "sensor.time_constant", 0.05, "s", "telemetry_lowpass")
    yield _sensor("scale", "scale of all rates", "y = (1 + c) u", "sensor.scale", 0.03, "1", "gyro_scale")
    for i, axis in enumerate(_ANGLES, 1):
        formula = f"y_{axis} = u_{axis} + c"
        yield _sensor(f"bias_{axis}", f"bias of the {axis} rate", formula, f"sensor.bias[{i}]", 0.0035, "rad/s", "gyro_bias")
    for i, axis in enumerate("XYZ", 1):
        formula = f"y = u + c e_{axis} × u"
        yield _sensor(f"turn_{axis}", f"turned about {axis}", formula, f"sensor.misalignment[{i}]", 0.02, "rad", "gyro_cross_axis")


def _sensor(name: str, said: str, formula: str, address: str, sigma: float, measure: str, equals: str) -> Term:
    words = f"rate gyros, {said}"
    return Term(f"sensor_{name}", "sensor", "sensor", words, formula, address, (), sigma, measure, "none", "none", equals, name == "lag")
