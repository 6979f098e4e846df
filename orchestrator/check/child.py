"""The process a trial runs in: `python -m orchestrator.check.child TRIAL JOB.json SAID.jsonl`."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

from orchestrator.check.bench import Bench
from orchestrator.check.finding import Finding, Verdict
from orchestrator.check.trials import TRIALS
from orchestrator.errors import OrchestratorError

_WHAT_TO_DO = "run it alone and mend it; the unit's own words stand in the message"


def main(trial: str, job: Path, said: Path) -> None:
    """Leaves by os._exit: a Python runtime inside a unit may crash while the interpreter is taken down, after correct results."""
    with said.open("a", encoding="utf-8") as file:
        bench = Bench(json.loads(job.read_text("utf-8")), file)
        try:
            TRIALS[trial](bench)
        except OrchestratorError as error:
            bench.find(Finding(trial, Verdict.FAIL, str(error), do=_WHAT_TO_DO))
        bench.tell("")
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
