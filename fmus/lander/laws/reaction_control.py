"""A pulse of the reaction control jets: a constant torque for a time."""

from typing import NamedTuple

from .compiled import jit
from .vectors import Vector


class Pulse(NamedTuple):
    """Torque about B's axes between two instants."""

    torque: Vector  # N m
    start: float  # s
    duration: float  # s


@jit
def fires(pulse: Pulse, t: float) -> bool:
    """Whether the jets fire at t (s)."""
    return pulse.start <= t < pulse.start + pulse.duration


@jit
def pulse_share(pulse: Pulse, t: float, step: float) -> float:
    """Share of [t, t + step] in which the jets fire."""
    return max(0.0, min(t + step, pulse.start + pulse.duration) - max(t, pulse.start)) / step


@jit
def pulse_slope(pulse: Pulse, t: float, step: float) -> float:
    """Slope (1/s) of the straight line nearest to the pulse of height one over [t, t + step] in the mean square.

    12/h³ ∫ (s - h/2) ds over the time of firing: it keeps the pulse's first moment.
    """
    begin, end = max(t, pulse.start), min(t + step, pulse.start + pulse.duration)
    if end <= begin:
        return 0.0
    return 12.0 / (step * step * step) * (end - begin) * (0.5 * (begin + end) - t - 0.5 * step)
