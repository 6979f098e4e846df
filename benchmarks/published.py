"""Makes the tables of docs/results.md from runs, so that no number in it is typed by hand.

    python benchmarks/published.py --runs build/published --out docs/results.md

Runs every case below through the command line (a run directory that is there already is kept: delete --runs to run anew) and replaces
what stands between `<!-- begin: NAME -->` and `<!-- end: NAME -->` in the document by the table NAME of published_tables.py.
"""

import argparse
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import published_tables

ROOT = Path(__file__).resolve().parents[1]
LANDINGS = ("zupp", "adams")
WEIGHT = {"zupp": 7063.5 * 1.63, "adams": 4932.0 * 1.63}  # N
ASSUMED = {"zupp": 5000.0, "adams": 3491.0}  # N, the scenarios' own
WIDTHS = (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4, 1e-4)  # m

Case = tuple[str, tuple[str, ...]]


def decaying(thrust: float) -> tuple[str, ...]:
    """Thrust (N) until first contact, then to zero in the scenario's decay time."""
    return ("--set", f"guidance.thrust_start={thrust}", "--set", f"guidance.thrust_before_contact={thrust}")


def held(thrust: float) -> tuple[str, ...]:
    """Thrust (N) held for 1.5 s after first contact, then cut: the crew's shutdown taken literally."""
    table = {"table_points": 2, "table_time[1]": 0.0, "table_time[2]": 1.5, "table_thrust[1]": thrust, "table_thrust[2]": thrust}
    pairs = table | {"thrust_before_contact": thrust}
    settings = (word for name, value in pairs.items() for word in ("--set", f"guidance.{name}={value}"))
    return (*settings, "--stop-time", "6")


def cases() -> dict[str, Case]:
    """Every run by its folder: scenario and further arguments."""
    runs: dict[str, Case] = {name: (name, ()) for name in ("apollo11_lm5", "flat_symmetric", "footpad_drop")}
    runs["flat_tight"] = ("flat_symmetric", ("--tolerance", "1e-7"))
    for c in LANDINGS:
        scenario = f"apollo11_{c}"
        runs |= {scenario: (scenario, ()), f"{scenario}_twin": (f"{scenario}_twin", ())}
        runs[f"{c}_law2"] = (scenario, ("--set", "soil*.law=2"))
        runs[f"{c}_thrust_none"] = (scenario, decaying(0.0))
        runs[f"{c}_thrust_weight"] = (scenario, decaying(WEIGHT[c]))
        runs[f"{c}_thrust_held"] = (scenario, held(ASSUMED[c]))
        runs[f"{c}_thrust_weight_held"] = (scenario, held(WEIGHT[c]))
    for s in WIDTHS:
        for zeta in (1, 0):
            settings = ("--set", f"leg.transition_width={s}", "--set", f"leg.damping_ratio={zeta}", "--set", "leg.longest_substep=2e-5")
            runs[f"honeycomb_{s * 1e6:.0f}_{zeta}"] = ("honeycomb_drop", settings)
    return runs


def run(folder: Path, case: Case) -> str:
    """One run by the command line; its last words where it did not end well."""
    if (folder / "summary.json").is_file():
        return ""
    scenario, arguments = case
    command = [sys.executable, "-m", "orchestrator", "run", f"scenarios/{scenario}.toml", "--quiet", "--out", str(folder), *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else f"{folder.name}: exit code {done.returncode}: {done.stderr.strip()}"


def filled(text: str, tables: dict[str, str]) -> str:
    """The document with every marked table renewed; a marker without a table, or the reverse, is a mistake."""
    marked = set(re.findall(r"<!-- begin: (\S+) -->", text))
    if marked != set(tables):
        raise SystemExit(f"markers and tables differ: {sorted(marked ^ set(tables))}")
    for name, table in tables.items():
        block = f"<!-- begin: {name} -->\n\n{table}\n\n<!-- end: {name} -->"
        text = re.sub(rf"<!-- begin: {name} -->.*?<!-- end: {name} -->", lambda _, new=block: new, text, flags=re.DOTALL)
    return text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=Path, default=ROOT / "build" / "published", help="folder of the run directories")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "results.md", help="document whose tables are renewed")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time")
    options = parser.parse_args()
    runs = options.runs.resolve()
    with ThreadPoolExecutor(options.jobs) as pool:
        complaints = pool.map(lambda item: run(runs / item[0], item[1]), cases().items())
        for complaint in filter(None, complaints):
            print(complaint, file=sys.stderr)
    options.out.write_text(filled(options.out.read_text(encoding="utf-8"), published_tables.tables(runs)), encoding="utf-8")


if __name__ == "__main__":
    main()
