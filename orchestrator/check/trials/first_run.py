"""Once through the course: it starts, takes its steps, and gives numbers."""

from __future__ import annotations

import hashlib

from orchestrator.check.bench import Bench
from orchestrator.check.finding import Finding, Verdict


def first_run(bench: Bench) -> None:
    rows = bench.run(bench.fresh())
    bench.keep("digest", hashlib.sha256(b"".join(rows)).hexdigest())
    course = bench.course
    moved = any(row != rows[0] for row in rows)
    what = f"{course.count} steps of {course.step:g} s, all outputs finite"
    if not moved and bench.interface.of("output"):
        bench.find(Finding("runs", Verdict.NOTE, f"{what}, and none of them ever changes", do="its defaults may do nothing; try --set"))
    else:
        bench.find(Finding("runs", Verdict.PASS, what))
