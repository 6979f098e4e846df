"""Sealed cases: make them, diagnose them, score the diagnoses.

    python benchmarks/sealed/run.py make  --set SET --keys KEYS --cases 100 --seed 12345
    python benchmarks/sealed/run.py run   --set SET --results RESULTS --jobs 2
    python benchmarks/sealed/run.py score --keys KEYS --results RESULTS --out DIR
    python benchmarks/sealed/run.py pool  A/score.json B/score.json --out DIR

`run` is not told where the keys are; the seed belongs to the keys, since it makes the same cases again.
Each command goes on where it stopped.
"""

from __future__ import annotations

import argparse
import os
import shlex
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from sealed import diagnoses
from sealed.kinds import SHARES
from sealed.make import UnmadeError, complete, make
from sealed.pool import pooled
from sealed.report import UnsealedError, report, scores_of
from sealed.sealing import COMMAND, Diagnosis
from sealed.vehicle import ZUPP

Told = Callable[[], None]


def main() -> None:
    options = _parser().parse_args()
    try:
        code = {"make": _make, "run": _run, "score": _score, "pool": _pool}[options.command](options)
    except (UnmadeError, UnsealedError, ValueError) as error:
        print(error, file=sys.stderr)
        code = 2
    sys.stdout.flush()
    os._exit(code)  # a Python runtime embedded in a unit may crash while the interpreter is taken down, after correct results


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog="README.md beside this file says what a case is.")
    commands = parser.add_subparsers(dest="command", required=True)
    making = commands.add_parser("make", help="write cases and keys")
    making.add_argument("--set", type=Path, required=True, help="folder of the public side")
    making.add_argument("--keys", type=Path, required=True, help="folder of the keys, outside the set")
    making.add_argument("--cases", type=int, default=100, help="of the whole set")
    making.add_argument("--from", dest="first", type=int, default=0, metavar="NUMBER", help="make a part: from this case on")
    making.add_argument("--until", type=int, metavar="NUMBER", help="and those before this one")
    making.add_argument("--seed", type=int, required=True, help="secret: it makes the same cases again")
    making.add_argument("--jobs", type=int, default=2, help="cases at a time, one process each")
    making.add_argument("--kind", action="append", choices=list(SHARES), help="only these kinds, in turn")
    running = commands.add_parser("run", help="diagnose all cases")
    running.add_argument("--set", type=Path, required=True)
    running.add_argument("--results", type=Path, required=True)
    running.add_argument("--jobs", type=int, default=2, help="cases at a time, one process each")
    running.add_argument("--seed", type=int, default=0, help="of the diagnosis")
    running.add_argument("--diagnose", default=shlex.join(COMMAND), help="command; {scenario} and {seed} are filled in")
    running.add_argument("--limit", type=float, default=7200.0, help="s of wall time a case may take")
    scoring = commands.add_parser("score", help="join diagnoses and keys")
    scoring.add_argument("--keys", type=Path, required=True)
    scoring.add_argument("--set", type=Path, help="folder of the public side: its digests are asked whether a key was changed")
    scoring.add_argument("--results", type=Path, required=True)
    scoring.add_argument("--out", type=Path, required=True)
    scoring.add_argument("--stated-closure", action="store_true", help="take the gap's closure as each diagnosis states it")
    pooling = commands.add_parser("pool", help="the table of several sets' scores, all by one method")
    pooling.add_argument("scores", type=Path, nargs="+", metavar="SCORE.json", help="what `score` wrote")
    pooling.add_argument("--out", type=Path, required=True)
    return parser


def _make(options: argparse.Namespace) -> int:
    part = range(options.cases)[options.first : options.until]
    if not part:
        asked = f"--from {options.first} --until {options.until or options.cases}"
        raise ValueError(f"{asked}: none of the {options.cases} cases, which are numbered from 0")
    with _bar("cases", len(part)) as told:
        chosen = slice(part.start, part.stop)
        make(options.set, options.keys, options.cases, options.seed, tuple(options.kind or ()), lambda _: told(), options.jobs, chosen)
    return 0


def _run(options: argparse.Namespace) -> int:
    diagnosis = Diagnosis(ZUPP, options.seed, tuple(shlex.split(options.diagnose)), options.limit)
    with _bar("diagnoses", len(diagnoses.missing(options.set, options.results))) as told:
        failed = diagnoses.run(options.set, options.results, diagnosis, options.jobs, lambda _: told())
    if failed:
        print(f"{', '.join(failed)}: ended without a diagnosis; see said.txt in {options.results}", file=sys.stderr)
    return 1 if failed else 0


def _score(options: argparse.Namespace) -> int:
    if options.set is not None:
        if not (options.set / "set.json").is_file():
            raise ValueError(f"{options.set}: holds no set.json; give the folder that `make` wrote")
        complete(options.keys, options.set / "set.json")
    with _bar("scores", len(list(options.keys.glob("[0-9]*.json")))) as told:
        scores = scores_of(options.keys, options.results, not options.stated_closure, lambda _: told())
    if not scores:
        raise ValueError(f"{options.results}: holds no result of a case of {options.keys}; diagnose the set first")
    left = len(list(options.keys.glob("[0-9]*.json"))) - len(scores)
    print(f"{left} cases have no result yet and are left out\n" if left else "", end="")
    print(report(scores, options.out))
    return 0


def _pool(options: argparse.Namespace) -> int:
    if options.out.resolve() in {path.resolve().parent for path in options.scores}:
        raise ValueError(f"{options.out}: holds scores to be pooled, which the table's would replace; give another --out")
    print(report(pooled(options.scores), options.out))
    return 0


@contextmanager
def _bar(title: str, count: int) -> Iterator[Told]:
    """A progress bar on a terminal, nothing elsewhere."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(title, total=count)
        yield lambda: bar.advance(task)


if __name__ == "__main__":
    main()
