"""Benchmarks: side by side with other masters, convergence, overhead, scaling, profile.

    python benchmarks/run.py NAME --out DIR      NAME: quarter-vehicle, full-vehicle, convergence, overhead, legs, profile, ssp, all

Writes NAME.json, tables (Markdown and CSV) and figures into DIR, and, with --docs, renews those of docs/benchmarks.md and docs/ssp.md.
The other masters come from the package index into environments of their own under build/peers; one that cannot be
installed or run here has a row that says why.
"""

import argparse
import importlib
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

MODULES = {"quarter-vehicle": "quarter", "full-vehicle": "full", "convergence": "convergence", "overhead": "overhead", "legs": "legs",
           "profile": "profiling", "ssp": "exported"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", choices=[*MODULES, "all"])
    parser.add_argument("--out", type=Path, required=True, help="folder for tables, figures and NAME.json")
    parser.add_argument("--docs", action="store_true", help="renew docs/benchmarks.md and docs/ssp.md from DIR afterwards")
    options = parser.parse_args()
    out = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    for name in MODULES if options.name == "all" else [options.name]:
        importlib.import_module(MODULES[name]).run(out)
    if options.docs:
        importlib.import_module("document").renew(out)
    sys.stdout.flush()
    os._exit(0)  # a Python runtime embedded in a unit may crash while the interpreter is taken down, after correct results


if __name__ == "__main__":
    main()
