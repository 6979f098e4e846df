"""Craters and boulders as round heights over the ground they lie on."""

from math import sqrt
from typing import NamedTuple

from .compiled import jit
from .height import Height, around

CREST = (0.25, 0.05)  # width over which a rim is rounded, in rim heights and in depths
FOOT = 0.25  # the same at a boulder's foot, in heights of the boulder
STEEPEST = 0.5 * sqrt(3.0)  # of a boulder's radius: from there, at 60 deg, a cone goes on to the ground
Profile = tuple[float, float, float, float]  # h (m), h', h'/r (1/m), h'' (1/m) over the distance from the middle


class Crater(NamedTuple):
    """A simple crater; fresh ones have depth 0.196 D and rim 0.036 D (Pike 1977)."""

    y: float  # of its middle, m, L
    z: float
    diameter: float  # D, crest to crest, m
    depth: float  # floor below the crest, m
    rim: float  # crest above the ground around, m


class Boulder(NamedTuple):
    """A ball that stands out of the ground."""

    y: float  # of its middle, m, L
    z: float
    radius: float  # m
    height: float  # of its top above the ground, m


@jit
def lower_of(a: Profile, b: Profile, width: float) -> Profile:
    """min(a, b), rounded with a continuous slope where they are less than `width` (m) apart: min - (width - |a - b|)²/(4 width)."""
    apart = a[0] - b[0]
    if apart >= width:
        return b
    if apart <= -width:
        return a
    share = 0.5 * (1.0 - apart / width)  # of a
    rest = 1.0 - share
    steeper = a[1] - b[1]
    dip = (width - abs(apart)) ** 2 / (4.0 * width)
    return (
        min(a[0], b[0]) - dip,
        share * a[1] + rest * b[1],
        share * a[2] + rest * b[2],
        share * a[3] + rest * b[3] - steeper * steeper / (2.0 * width),
    )


@jit
def crater_profile(c: Crater, r: float) -> Profile:
    """Bowl h = d (r/R)² - (d - h_r) inside the crest, flank h = h_r (R/r)³ outside, R = D/2; the crest rounded (`lower_of`).

    d and h_r from R. J. Pike, in Impact and Explosion Cratering (1977): simple craters are 0.196 D deep with rims of 0.036 D; the flank's
    power from T. R. McGetchin et al., Earth Planet. Sci. Lett. 20 (1973). Rounding takes less than a fifth off a fresh rim's height.
    """
    radius = 0.5 * c.diameter
    curvature = 2.0 * c.depth / (radius * radius)
    bowl = (0.5 * curvature * r * r - (c.depth - c.rim), curvature * r, curvature, curvature)
    if r < 0.5 * radius:
        return bowl
    flank = c.rim * (radius / r) ** 3
    outside = (flank, -3.0 * flank / r, -3.0 * flank / (r * r), 12.0 * flank / (r * r))
    return lower_of(bowl, outside, CREST[0] * c.rim + CREST[1] * c.depth)


@jit
def boulder_profile(b: Boulder, r: float) -> Profile:
    """Cap h = √(ρ² - r²) - (ρ - h_b), from 60 deg on its tangent cone, down to h = 0, the foot rounded.

    A height has one value over a place: what overhangs is a cone instead. The soil's law stays what it is: a boulder is shape alone.
    """
    edge = STEEPEST * b.radius
    if r <= edge:
        up = sqrt(b.radius * b.radius - r * r)
        cap = (up - (b.radius - b.height), -r / up, -1.0 / up, -b.radius * b.radius / (up * up * up))
    else:
        steep = -edge / (0.5 * b.radius)
        cap = (0.5 * b.radius - (b.radius - b.height) + steep * (r - edge), steep, steep / r, 0.0)
    h, h1, h2, h3 = lower_of((-cap[0], -cap[1], -cap[2], -cap[3]), (0.0, 0.0, 0.0, 0.0), FOOT * b.height)
    return (-h, -h1, -h2, -h3)


@jit
def crater_height(c: Crater, y: float, z: float) -> Height:
    """Height of a crater over the ground it lies in, at (y, z) of L."""
    r = sqrt((y - c.y) ** 2 + (z - c.z) ** 2)
    h, first, over, second = crater_profile(c, r)
    return around(y - c.y, z - c.z, r, h, first, over, second)


@jit
def boulder_height(b: Boulder, y: float, z: float) -> Height:
    """Height of a boulder over the ground it lies on, at (y, z) of L."""
    r = sqrt((y - b.y) ** 2 + (z - b.z) ** 2)
    h, first, over, second = boulder_profile(b, r)
    return around(y - b.y, z - b.z, r, h, first, over, second)
