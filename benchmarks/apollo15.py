"""Which inputs, inside the bounds of scenarios/campaigns/apollo15.toml, give the measured facts of Apollo 15's landing?

    python benchmarks/apollo15.py [--out build/apollo15] [--workers 2] [--generations 6]

A first generation fills the bounds; each later one is drawn from a normal distribution about the best of all before it (the
cross-entropy method, Rubinstein 1999), in cumulative probabilities, kept inside the bounds. What counts at the end is every landing
whose facts are all inside their bounds, not the best one.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from orchestrator.campaign.campaign import Campaign
from orchestrator.campaign.crew import Crew
from orchestrator.campaign.design import from_shares
from orchestrator.campaign.inputs import overrides
from orchestrator.campaign.landing import Landing

Array = NDArray[np.float64]
CAMPAIGN = Path(__file__).parents[1] / "scenarios" / "campaigns" / "apollo15.toml"
HOLD = 0.3  # s, of the campaign's [until]
FAR = 100.0  # misfit of a landing that was not flown or never came to rest
FACTS = {  # paper.toml's [measured.apollo15]: value, and what is allowed beside it: the numbers are quoted to two figures and no accuracy
    "peak pitch rate, deg/s": (17.0, 2.0),
    "peak roll rate, deg/s": (-15.0, 2.0),
    "final pitch, deg": (6.9, 1.0),
    "final roll, deg": (-8.6, 1.0),
    "+Z after +Y, s": (0.0, 0.1),
    "first of -Z and -Y after both, s": (0.1, 0.1),  # at least 0: "+Z and +Y nearly together" came first
    "settled after, s": (1.8, 0.4),
}
FIRST, LATER, BEST = 256, 96, 24


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--out", type=Path, default=Path("build/apollo15"))
    asked.add_argument("--workers", type=int, default=2)
    asked.add_argument("--generations", type=int, default=6)
    asked.add_argument("--seed", type=int, default=15)
    given = asked.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    plan, random = Campaign.read(CAMPAIGN), np.random.default_rng(given.seed)
    shares, rows = np.empty((0, len(plan.addresses))), list[dict[str, Any]]()
    with Crew(given.workers) as crew:
        for generation in range(given.generations):
            new = next_shares(shares, np.array([row["distance"] for row in rows]), random)
            rows += flown(plan, crew, new, generation)
            shares = np.vstack([shares, new])
            nearest = min(rows, key=lambda row: float(row["distance"]))
            inside = sum(row["inside"] for row in rows)
            so_far = f"nearest {nearest['distance']:.2f}, all facts inside: {inside}"
            (given.out / "landings.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
            print(f"generation {generation}: {len(rows)} landings, {so_far}", flush=True)
    report(rows, list(plan.addresses))


def next_shares(shares: Array, distances: Array, random: np.random.Generator) -> Array:
    """Cumulative probabilities of the next generation, a row a landing."""
    if not len(shares):
        filled: Array = qmc.Sobol(shares.shape[1], seed=random).random(FIRST)
        return filled
    best = shares[np.argsort(distances)[:BEST]]
    spread = np.cov(best.T) + np.diag(np.full(best.shape[1], 0.02**2))
    return np.clip(random.multivariate_normal(best.mean(axis=0), 1.3 * spread, LATER), 1e-6, 1.0 - 1e-6)


def flown(plan: Campaign, crew: Crew, shares: Array, generation: int) -> list[dict[str, Any]]:
    columns = {name: from_shares(plan.table.vary[name], shares[:, i]) for i, name in enumerate(plan.addresses)}
    inputs = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    landings = crew.fly_all(plan.base, [overrides(plan.addresses, row) for row in inputs])
    return [judged(row, landing) | {"generation": generation} for row, landing in zip(inputs, landings, strict=True)]


def judged(inputs: Mapping[str, Any], landing: Landing) -> dict[str, Any]:
    """Inputs, facts, distance (RMS of misfits in the facts' own bounds), and whether all facts are inside."""
    facts = facts_of(landing)
    if facts is None:
        return {"inputs": dict(inputs), "facts": None, "outcome": landing.outcome, "distance": FAR, "inside": False}
    misfits = {name: (facts[name] - value) / allowed for name, (value, allowed) in FACTS.items()}
    late = "first of -Z and -Y after both, s"
    misfits[late] = min(0.0, misfits[late])          # the later the better
    worst = max(abs(misfit) for misfit in misfits.values())
    distance = float(np.sqrt(np.mean(np.square(list(misfits.values())))))
    return {"inputs": dict(inputs), "facts": facts, "outcome": landing.outcome, "distance": distance, "inside": bool(worst <= 1.0)}


def facts_of(landing: Landing) -> dict[str, float] | None:
    """As the facts are called; None where a leg never touched or nothing was flown."""
    found: Mapping[str, Any] = landing.outputs
    contacts = [found.get(f"contact_times_s.{leg}") for leg in ("+Z", "+Y", "-Z", "-Y")]
    if not found or any(time is None for time in contacts):
        return None
    forward, right, aft, left = (float(time) for time in contacts if time is not None)
    return {
        "peak pitch rate, deg/s": found["peak_rates_deg_s.pitch.max"],
        "peak roll rate, deg/s": found["peak_rates_deg_s.roll.min"],
        "final pitch, deg": found["final_attitude_deg.pitch"],
        "final roll, deg": found["final_attitude_deg.roll"],
        "+Z after +Y, s": forward - right,
        "first of -Z and -Y after both, s": min(aft, left) - max(forward, right),
        "settled after, s": found["master.simulated_s"] - HOLD,
    }


def report(rows: list[dict[str, Any]], names: list[str]) -> None:
    """Markdown: the nearest landing's facts, and how far each input reaches among those with all facts inside."""
    nearest = min(rows, key=lambda row: float(row["distance"]))
    print("\n| fact | measured | allowed | nearest landing |\n|---|---|---|---|")
    for name, (value, allowed) in FACTS.items():
        print(f"| {name} | {value:g} | ± {allowed:g} | {nearest['facts'][name]:.3g} |")
    inside = [row for row in rows if row["inside"]]
    print(f"\n{len(inside)} of {len(rows)} landings have all facts inside.\n")
    print("| input | least | greatest | nearest landing |\n|---|---|---|---|")
    for name in names:
        values = [float(row["inputs"][name]) for row in inside] or [float("nan")]
        print(f"| {name} | {min(values):.4g} | {max(values):.4g} | {nearest['inputs'][name]:.4g} |")


if __name__ == "__main__":
    main()
