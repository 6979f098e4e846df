"""What a landing is made of, and its record."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LEGS = ("+Z", "+Y", "-Z", "-Y")
AZIMUTHS = (0.0, 0.5 * pi, pi, -0.5 * pi)
PAD_RADIUS, PAD_HEIGHT, PAD_MASS = 0.47, 0.10, 11.0
LIMIT = 0.812  # stroke of a primary
CONNECTION = 1.157  # from the ball joint up the primary
CYLINDER_MASS, PISTON_MASS = 43.1, 13.6


@dataclass(frozen=True)
class Landing:
    """Tables 1 to 5 of the paper, Zupp-like; SI; body axes X up, Y right, Z forward."""

    mass: float = 7063.5
    inertia: tuple[float, float, float] = (16492.0, 17409.0, 20800.0)
    height: float = 3.62  # of the centre of mass above the pads' base
    gravity: float = 1.63
    velocity: tuple[float, float, float] = (-0.5730, -0.6147, -0.2130)
    attitude: tuple[float, float, float] = (0.263370, 0.016459, 0.044419)  # yaw, pitch, roll
    rates: tuple[float, float, float] = (-0.0108, 0.0, -0.05)
    slope: float = 0.078540
    azimuth: float = 0.0
    thrust: float = 5000.0
    decay: float = 1.0
    primary_loads: tuple[float, float] = (20017.0, 42358.0)
    compression_load: float = 20017.0
    tension_loads: tuple[float, float] = (2224.0, 22241.0)
    crush_width: float = 1e-3
    bearing_friction: float = 0.23
    joint_damping: float = 100.0
    secondary_mass: float = 5.12
    bearing_strength: float = 350254.0
    compaction_exponent: float = 1.0
    damping: float = 0.0
    damping_depth: float = 0.0
    friction: float = 0.33
    plowing: float = 1454.0
    rebound_band: float = 1e-4
    # beyond the paper, to be hidden in data
    inertial_drag: float = 0.0  # kg/m a pad, F = A v² while sinking
    thrust_offset: tuple[float, float] = (0.0, 0.0)  # m along Y, Z
    roll_drag: float = 0.0  # N m s², torque about Z against the square of the rate
    strength_of_pad: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)  # times the bearing strength, in the order of LEGS
    # how it is flown
    step: float = 1e-5
    duration: float = 4.0

    def brake(self, load: float) -> float:
        """c = 2 ζ ω m of a core, N s/m, ζ = 1."""
        return 2.0 * sqrt(load / self.crush_width * self.mass)


ZUPP = Landing()
ADAMS = replace(
    ZUPP, mass=4932.0, inertia=(7953.0, 6332.0, 5879.0), velocity=(-0.5740, -0.6481, -0.0447), attitude=(0.0, 0.025878, 0.040033),
    slope=0.073304, azimuth=-0.209440, thrust=3491.0, bearing_strength=150000.0, compaction_exponent=1.5, damping=150000.0,
    damping_depth=0.1, friction=0.36,
)  # fmt: skip
LIGHT = 0.01  # kg, a secondary that weighs next to nothing


@dataclass(frozen=True)
class Course:
    """Rows over time since the first pad touches."""

    times: Array
    rates: Array  # yaw, pitch, roll, rad/s
    attitude: Array  # yaw, pitch, roll, rad
    values: dict[str, float]  # at the end: strokes, penetrations, skids in m, contact times in s
