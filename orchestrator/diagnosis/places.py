"""Addresses of parameters: `PLACE.NAME`, `PLACE[LEG].NAME`, with `[i]` behind for one component (decision 9)."""

from __future__ import annotations

import re
from dataclasses import dataclass

from orchestrator.errors import AddressError, nearest

PLACES = {
    "soil": "RegolithContact",
    "gear": "GearLeg",
    "body": "VehicleBody",
    "guidance": "GuidanceControl",
    "sensor": "RateSensor",
    "plume": "ThrustGroundEffect",
    "slosh": "PropellantSlosh",
    "rcs": "ReactionControl",
    "body_term": "BodyTerm",
}
"""Place -> model name of the unit that stands there."""
CLOCK = "clock"
TWIN = "LunarLander"
LEGS = ("+Z", "+Y", "-Z", "-Y")
"""Legs 1 to 4 of the twin."""
SHORT = {
    "velocity_body": ("body.velocity_start",),
    "attitude": ("body.yaw_start", "body.pitch_start", "body.roll_start"),
    "rates": ("body.rates_start",),
    "ground_slope": ("soil.ground_slope",),
    "ground_azimuth": ("soil.ground_azimuth",),
    "mass": ("body.mass", "gear.vehicle_mass"),
}
"""Short names of the data format. `attitude` is one value for each of its addresses, `mass` one for both."""
ONE_FOR_EACH = ("attitude",)
_FORM = re.compile(r"(?P<place>\w+)(\[(?P<leg>[^\]]+)\])?\.(?P<name>[A-Za-z_][\w.]*)(\[(?P<element>\d+)\])?")


@dataclass(frozen=True)
class Address:
    """An address taken apart; `leg` and `element` are None where all are meant."""

    place: str
    name: str
    leg: str | None = None
    element: int | None = None

    @property
    def variable(self) -> str:
        """The variable's name in its unit, with its index."""
        return self.name if self.element is None else f"{self.name}[{self.element}]"


def parse(address: str) -> Address:
    """The parts of one address (not a short name)."""
    match = _FORM.fullmatch(address)
    if match is None:
        raise AddressError(f"{address}: is no address; write PLACE.NAME, PLACE[LEG].NAME or PLACE.NAME[i], e.g. soil[+Y].friction")
    place, leg = match["place"], match["leg"]
    if place not in PLACES and place != CLOCK:
        raise AddressError(f'{address}: no place "{place}"; {nearest(place, [*PLACES, CLOCK])}')
    if leg is not None and place not in ("soil", "gear"):
        raise AddressError(f"{address}: {place} is not one a leg; write {place}.{match['name']}")
    return Address(place, match["name"], leg, int(match["element"]) if match["element"] else None)


def spelt_out(address: str) -> tuple[str, ...]:
    """A short name -> its addresses; any other address is itself."""
    if address in SHORT:
        return SHORT[address]
    if "." not in address:
        raise AddressError(f'{address}: is no address; {nearest(address, SHORT)} (or PLACE.NAME, e.g. soil.friction)')
    return (address,)
