"""The paper's vehicle, soils and landings as records of the laws, numbers from its Tables 1 to 5 (specification: parameters.toml)."""

from math import pi, radians
from typing import Any, NamedTuple

from lander.laws.footpad import Footpad, lever
from lander.laws.honeycomb import DATUM_WEIGHT, Core, Stop, brake_damping
from lander.laws.leg import Leg, disc_inertia
from lander.laws.leg_geometry import GearDimensions, leg_geometry
from lander.laws.leg_stepping import PadLoad
from lander.laws.rigid_body import Body, BodyState, inertia_matrix
from lander.laws.soil import PUBLISHED, Soil
from lander.laws.surface import depth_at, inclined_plane
from lander.laws.twin import Engine, Flight, Vehicle
from lander.laws.twin_stepping import empty_flight, start_flight
from lander.laws.vectors import ZERO, Matrix, Vector, add, apply, from_yaw_pitch_roll, identity, rotation

MASS, GRAVITY, CG_HEIGHT = 7063.5, 1.63, 3.62
INERTIA: Vector = (16492.0, 17409.0, 20800.0)
PRIMARY_LOADS = (20017.0, 42358.0)
AZIMUTHS = {"+Z": 0.0, "+Y": 0.5 * pi, "-Z": pi, "-Y": -0.5 * pi}
PAD = Footpad(0.47, 0.10)
ENGINE_OFF = Engine((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
ZUPP_SOIL = Soil(PUBLISHED, 350254.0 / 5, 1.0, 0.0, 0.0, 1e-4, 1e-4, 0.33, 1454.0 / 5, 1e-3)
ADAMS_SOIL = Soil(PUBLISHED, 150000.0 / 5, 1.5, 150000.0 / 5, 0.1, 1e-4, 1e-4, 0.36, 1454.0 / 5, 1e-3)


class Landing(NamedTuple):
    """Table 5: angles in rad, velocity in B in m/s, rates in rad/s."""

    yaw: float
    pitch: float
    roll: float
    velocity: Vector
    rates: Vector
    slope: float
    azimuth: float


RATES: Vector = (radians(-0.6188), 0.0, radians(-2.8648))
ZUPP = Landing(radians(15.09), radians(0.9430), radians(2.5450), (-0.5730, -0.6147, -0.2130), RATES, radians(4.5), 0.0)
ADAMS = Landing(0.0, radians(1.4827), radians(2.2937), (-0.5740, -0.6481, -0.0447), RATES, radians(4.2), radians(-12.0))


def core(loads: tuple[float, float], boundary: float, limit: float, width: float, zeta: float) -> Core:
    """A cartridge of Table 3 with the paper's damping."""
    return Core(loads[0], loads[1], boundary, limit, width, brake_damping(zeta, max(loads), width, MASS), DATUM_WEIGHT)


def leg_at(azimuth: float, width: float = 1e-3, zeta: float = 1.0, **changes: Any) -> Leg:
    """The paper's leg; `changes` replace fields of `Leg`."""
    leg = Leg(
        leg_geometry(GearDimensions(), azimuth, CG_HEIGHT, 0.812),
        43.1,
        13.6,
        5.12,
        11.0,
        disc_inertia(11.0, PAD.radius),
        core(PRIMARY_LOADS, 0.254, 0.812, width, zeta),
        core((2224.0, 22241.0), 0.102, 0.407, width, zeta),
        core((20017.0, 20017.0), 0.610, 0.305, width, zeta),
        Stop(4e7, 6e4, 1e-4),
        0.23,
        1e-2,
        100.0,
    )
    return leg._replace(**changes)


def vehicle(landing: Landing = ZUPP, soil: Soil = ZUPP_SOIL, gravity: float = GRAVITY, **changes: Any) -> Vehicle:
    """Four legs on one inclined plane; `changes` replace fields of every leg."""
    legs = tuple(leg_at(azimuth, **changes) for azimuth in AZIMUTHS.values())
    surface = inclined_plane(landing.slope, landing.azimuth)
    body = Body(MASS, inertia_matrix(INERTIA, (0.0, 0.0, 0.0)), gravity)
    return Vehicle(body, legs, (soil,) * 4, (surface,) * 4, PAD)


def lowest_gaps(craft: Vehicle, turned: Matrix, height: float = 0.0) -> list[float]:
    """Distance of each pad's lowest contact point from its surface, along the normal, with B's origin at `height`, m."""
    gaps = []
    for leg, surface in zip(craft.legs, craft.surfaces, strict=True):
        joint = add(apply(turned, leg.geometry.pad), (height, 0.0, 0.0))
        gaps.append(min(-depth_at(surface, add(joint, lever(craft.pad, turned, i))) for i in range(5)))
    return gaps


def started(craft: Vehicle, landing: Landing = ZUPP, above: float = 0.0) -> Flight:
    """The flight at the instant when the lowest pad is `above` (m) the ground."""
    attitude = from_yaw_pitch_roll(landing.yaw, landing.pitch, landing.roll)
    turned = rotation(attitude)
    height = above - min(lowest_gaps(craft, turned)) / craft.surfaces[0].normal[0]
    flight = empty_flight(len(craft.legs))
    start_flight(craft, BodyState((height, 0.0, 0.0), attitude, apply(turned, landing.velocity), landing.rates), flight)
    return flight


def pad_load(force: Vector, torque: Vector = ZERO, force_slope: Vector = ZERO, torque_slope: Vector = ZERO) -> PadLoad:
    """A wrench on the pad that does not answer the pad's motion: whatever else the record holds is zero."""
    answers = (identity(0.0) if name in ("stiffness", "damping") else ZERO for name in PadLoad._fields[4:])
    return PadLoad(force, torque, force_slope, torque_slope, *answers)
