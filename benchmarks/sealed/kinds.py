"""What kinds of truth a set holds, and in which shares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SHARES = {
    "single 25": 0.12, "single 49": 0.12, "single 100": 0.10, "single large": 0.10, "null white": 0.09, "null coloured": 0.09,
    "decoy": 0.08, "twin": 0.12, "outside": 0.10, "two": 0.08,
}  # fmt: skip
TWINS = (("thrust_tail_off", "ground_effect"), ("initial_rates", "cg_offset"), ("telemetry_lowpass", "clock_offset"),
         ("cg_offset", "thrust_offset"), ("step_-Y", "ground_azimuth"))  # fmt: skip
ENERGY = {"single 25": (25.0, 25.0), "single 49": (49.0, 49.0), "single 100": (100.0, 100.0), "single large": (100.0, 400.0),
          "twin": (25.0, 64.0), "outside": (100.0, 400.0), "two": (64.0, 225.0)}  # fmt: skip
"""λ is drawn between these, evenly in its logarithm."""
NULLS = ("null white", "null coloured", "decoy")


@dataclass(frozen=True)
class Plan:
    """What a case is to be."""

    number: int
    kind: str
    target: float
    """λ; 0 where nothing is hidden."""
    colour: float
    misstated: float
    path: str


def counts(n: int) -> dict[str, int]:
    """Cases of each kind, by the largest remainders."""
    exact = {kind: n * share for kind, share in SHARES.items()}
    whole = {kind: int(x) for kind, x in exact.items()}
    for kind in sorted(exact, key=lambda it: whole[it] - exact[it])[: n - sum(whole.values())]:
        whole[kind] += 1
    return whole


def plans(n: int, seed: int, kinds: tuple[str, ...] = ()) -> list[Plan]:
    """The set's cases in an order that says nothing."""
    random = np.random.default_rng([seed, 0])
    names = [kinds[i % len(kinds)] for i in range(n)] if kinds else [kind for kind, count in counts(n).items() for _ in range(count)]
    return [_plan(i, names[j], random) for i, j in enumerate(random.permutation(n).tolist())]


def _plan(number: int, kind: str, random: np.random.Generator) -> Plan:
    low, high = ENERGY.get(kind, (0.0, 0.0))
    draw, coloured, wrong = random.random(3).tolist()
    colour = float(random.uniform(0.0, 0.8)) if coloured < 0.5 else 0.0
    colour = {"null white": 0.0, "null coloured": float(random.uniform(0.3, 0.8))}.get(kind, colour)
    misstated = float(random.uniform(0.8, 1.25)) if wrong < 1.0 / 3.0 else 1.0
    path = "units" if random.random() < 0.25 else "twin"
    return Plan(number, kind, float(low * (high / low) ** draw) if low else 0.0, colour, misstated, path)
