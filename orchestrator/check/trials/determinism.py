"""The same inputs give the same bits: after a reset, beside another instance, and in another process (compared by the caller)."""

from __future__ import annotations

import hashlib

from orchestrator.check.bench import Bench
from orchestrator.check.finding import Finding, Verdict

_ONLY_ONCE = "canBeInstantiatedOnlyOncePerProcess"


def determinism(bench: Bench) -> None:
    unit = bench.fresh()
    first = bench.run(unit)
    bench.keep("digest", hashlib.sha256(b"".join(first)).hexdigest())
    bench.tell("reset")
    again = {"after a reset": bench.run(unit)}
    if not bench.interface.claims(_ONLY_ONCE):
        again["in a second instance"] = bench.run(bench.fresh())
    for where, rows in again.items():
        for n, (one, other) in enumerate(zip(first, rows, strict=True)):
            if one != other:
                what = f"other bits {where} from step {n} on" if n else f"other bits {where} at the start"
                bench.find(Finding("determinism", Verdict.FAIL, what, do="start from declared values only; no clock, no shared state"))
                return
    bench.find(Finding("determinism", Verdict.PASS, f"the same bits {' and '.join(again)}"))
