"""Unit strings such as "N.m", "m/s2", "N.s/m": their exponents of kg, m, s, rad, and the unit of a rate of change.

Grammar: factors joined by points, each a symbol with an optional power; after the one slash all factors divide.
"""

import re

SYMBOLS: dict[str, dict[str, int]] = {
    "kg": {"kg": 1},
    "m": {"m": 1},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "K": {"K": 1},
    "A": {"A": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
    "Hz": {"s": -1},
    "1": {},
}
ORDER = ("kg", "m", "s", "A", "K", "rad")
FACTOR = re.compile(r"([A-Za-z]+|1)(-?\d+)?")


def exponents(unit: str) -> dict[str, int]:
    """Exponents of the base units, in the order FMI lists them; "" and "1" are dimensionless."""
    powers = dict.fromkeys(ORDER, 0)
    above, slash, below = (unit or "1").partition("/")
    for factors, sign in ((above, 1), (below, -1)):
        for factor in factors.split(".") if factors or sign == 1 or slash else []:
            match = FACTOR.fullmatch(factor)
            if match is None or match[1] not in SYMBOLS:
                raise ValueError(f"unit {unit!r}: {factor!r} is no symbol of {', '.join(SYMBOLS)}")
            for name, power in SYMBOLS[match[1]].items():
                powers[name] += sign * power * int(match[2] or 1)
    return {name: power for name, power in powers.items() if power}


def rate_of(unit: str) -> str:
    """The unit of the rate of change: N → N/s, m/s2 → m/s3, N.s/rad → N.s/rad.s."""
    above, slash, below = (unit or "1").partition("/")
    if not slash:
        return f"{above}/s"
    factors = below.split(".")
    match = FACTOR.fullmatch(factors[-1])
    if match and match[1] == "s":
        return f"{above}/{'.'.join([*factors[:-1], f's{int(match[2] or 1) + 1}'])}"
    return f"{above}/{below}.s"
