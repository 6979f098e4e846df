"""Geometry of one cantilever leg in the body frame, from the parameters of Table 2; any azimuth, any number of legs."""

from math import cos, isfinite, sin
from typing import NamedTuple

from .vectors import Vector, add, axpy, cross, norm, scale, sub

UP: Vector = (1.0, 0.0, 0.0)


class GearDimensions(NamedTuple):
    """Table 2, m. Heights are above the footpad's base; radii from the vehicle's axis."""

    footprint_radius: float = 4.242
    truss_radius_upper: float = 3.061
    truss_radius_lower: float = 2.996
    truss_height_upper: float = 2.874
    truss_height_lower: float = 1.19
    footpad_height: float = 0.10
    secondary_truss_width: float = 2.239
    connection: float = 1.157  # l_conn: from the ball joint up the primary


class LegGeometry(NamedTuple):
    """Where the undeformed leg's joints are, in B (m), and its lengths (m)."""

    upper: Vector  # universal joint of the primary
    right: Vector  # lower truss point, to the right looking outward
    left: Vector
    pad: Vector  # ball joint
    length: float  # primary, joint to joint
    cylinder: float  # upper joint to the connection
    piston: float  # ball joint to the piston's head
    right_length: float
    left_length: float


class GeometryError(ValueError):
    """A leg that cannot be built; the message names the dimension, its value and the limit."""


def leg_geometry(dimensions: GearDimensions, azimuth: float, origin_height: float, stroke_limit: float) -> LegGeometry:
    """The leg at `azimuth` (rad; 0 is +Z, 90 deg is +Y); origin_height is B's origin above the footpad base, m.

    "Right" is to the right looking outward along the leg (physics.md). The piston's head touches the far end of the uncrushed
    cartridge, so the piston is the strut's length less the stroke limit: the paper does not give its length.
    Raises GeometryError where the members cannot close.
    """
    g = dimensions
    check_dimensions(g)
    outward = (0.0, sin(azimuth), cos(azimuth))
    rightward = cross(outward, UP)
    upper = point(outward, g.truss_radius_upper, g.truss_height_upper - origin_height)
    pad = point(outward, g.footprint_radius, g.footpad_height - origin_height)
    lower = point(outward, g.truss_radius_lower, g.truss_height_lower - origin_height)
    right = axpy(0.5 * g.secondary_truss_width, rightward, lower)
    left = axpy(-0.5 * g.secondary_truss_width, rightward, lower)
    length = norm(sub(pad, upper))
    if not g.connection < length:
        raise GeometryError(f"connection is {g.connection:g} m, must be below the primary's length {length:g} m")
    if not 0.0 < stroke_limit < g.connection:
        raise GeometryError(f"primary stroke limit is {stroke_limit:g} m, must be above 0 and below connection {g.connection:g} m")
    joint = axpy((length - g.connection) / length, sub(pad, upper), upper)
    sides = norm(sub(joint, right)), norm(sub(joint, left))
    if min(sides) < 0.1:
        raise GeometryError(f"secondary strut is {min(sides):g} m long, must be at least 0.1 m: connection and lower truss coincide")
    return LegGeometry(upper, right, left, pad, length, length - g.connection, length - stroke_limit, sides[0], sides[1])


def moved(leg: LegGeometry, y: float, z: float) -> LegGeometry:
    """The leg of a vehicle whose centre of mass, B's origin, stands (y, z) (m) from its axis: the joints move by minus that."""
    away = (0.0, -y, -z)
    return leg._replace(upper=add(leg.upper, away), right=add(leg.right, away), left=add(leg.left, away), pad=add(leg.pad, away))


def check_dimensions(g: GearDimensions) -> None:
    """Raise GeometryError unless every dimension is positive and the upper joint stands above the footpad."""
    for name, value in g._asdict().items():
        if not (isfinite(value) and value > 0.0):
            raise GeometryError(f"{name} is {value:g} m, must be above 0")
    if g.truss_height_upper <= g.footpad_height:
        raise GeometryError(f"truss_height_upper is {g.truss_height_upper:g} m, must be above footpad_height {g.footpad_height:g} m")


def point(outward: Vector, radius: float, height: float) -> Vector:
    """The point at `radius` along `outward` and `height` along the vehicle's axis, in B, m."""
    return add(scale(radius, outward), scale(height, UP))
