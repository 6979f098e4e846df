"""How fast campaigns are: landings a minute, what is lost outside landings, what a second process gains, what ending at rest moves.

    python benchmarks/campaign.py                      500 landings of apollo11_scatter by two workers, then 60 by one and by two
    python benchmarks/campaign.py --landings 100 --speed-up 0
    python benchmarks/campaign.py --landings 0 --speed-up 0 --whole 20       20 landings with and without the campaign's [until]

On a machine that does something else the seconds say little; CPU seconds a landing say what they can.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pyarrow.compute as pc
import pyarrow.parquet as pq

from orchestrator.campaign.campaign import Campaign
from orchestrator.campaign.crew import Crew
from orchestrator.campaign.landing import Base, Landing
from orchestrator.campaign.outputs import NOT_FLOWN

CAMPAIGNS = Path(__file__).parents[1] / "scenarios" / "campaigns"
GROUPS = ("failure.tip_over.least_angle_deg", "failure.primary_stroke.peak_m", "failure.secondary_tension.peak_m", "strokes_m", "skid_m",
          "penetration_m", "peak_rates_deg_s", "final_attitude_deg")  # fmt: skip


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--campaign", default="apollo11_scatter")
    asked.add_argument("--landings", type=int, default=500)
    asked.add_argument("--workers", type=int, default=2)
    asked.add_argument("--speed-up", type=int, default=60, help="landings flown once by one worker and once by two; 0: not")
    asked.add_argument("--whole", type=int, default=0, help="landings flown with and without the campaign's [until]")
    given = asked.parse_args()
    path = CAMPAIGNS / f"{given.campaign}.toml"
    plan = Campaign.read(path)
    if given.landings:
        flown(plan, given.landings, given.workers)
    if given.speed_up:
        one, two = flown(plan, given.speed_up, 1), flown(plan, given.speed_up, 2)
        print(f"two processes over one: {one / two:.2f} times as fast")
    if given.whole:
        compare_ends(plan, path, given.whole, given.workers)


def flown(plan: Campaign, count: int, workers: int) -> float:
    """s of wall time for the first landings of the campaign; prints what they cost."""
    few = replace(plan, inputs=plan.inputs.slice(0, count))
    with tempfile.TemporaryDirectory() as scratch, Crew(workers) as crew:
        rows, cost = few.fly(Path(scratch) / "flown", crew)
        cpu = pc.mean(pq.read_table(Path(scratch) / "flown" / "cost.parquet")["cpu_seconds"]).as_py()
    failed = pc.sum(pc.equal(rows["outcome"], NOT_FLOWN)).as_py()
    print(f"{count} landings, {failed} not flown, by {workers} in {cost.seconds:.1f} s: {60 * count / cost.seconds:.0f} a minute,"
          f" {cost.lost:.1%} of the workers' time outside landings, {cpu:.2f} CPU s a landing", flush=True)  # fmt: skip
    return cost.seconds


def compare_ends(plan: Campaign, path: Path, count: int, workers: int) -> None:
    """The greatest difference of each group of outputs between landings ended at rest and flown to the stop time."""
    whole = {key: value for key, value in plan.table.changes.items() if key != "until"}
    base = Base.read((path.parent / plan.table.scenario).resolve(), plan.table.set, whole)
    asked = [plan.overrides(index) for index in range(count)]
    with Crew(workers) as crew:
        ended, to_the_end = crew.fly_all(plan.base, asked), crew.fly_all(base, asked)
    print(f"{count} landings, ended at rest against flown to the stop time:")
    print(f"  outcome: {sum(a.outcome != b.outcome for a, b in zip(ended, to_the_end, strict=True))} differ")
    print(f"  CPU s a landing: {mean_cpu(ended):.2f} against {mean_cpu(to_the_end):.2f}")
    for group in GROUPS:
        print(f"  {group}: at most {greatest_difference(ended, to_the_end, group):.3g}")


def mean_cpu(landings: Sequence[Landing]) -> float:
    return sum(landing.cpu_seconds for landing in landings) / len(landings)


def greatest_difference(ones: Sequence[Landing], others: Sequence[Landing], group: str) -> float:
    both = zip(ones, others, strict=True)
    pairs = [(value, b.outputs.get(name)) for a, b in both for name, value in a.outputs.items() if name.startswith(group)]
    return max(abs(a - b) for a, b in pairs if isinstance(a, float) and isinstance(b, float))


if __name__ == "__main__":
    main()
