"""What a unit does when it is driven; each trial runs in a process of its own and finds what it finds."""

from __future__ import annotations

from collections.abc import Callable

from orchestrator.check.bench import Bench
from orchestrator.check.trials.bad_input import bad_inputs
from orchestrator.check.trials.bad_parameters import bad_parameters
from orchestrator.check.trials.determinism import determinism
from orchestrator.check.trials.feedthrough import feedthrough
from orchestrator.check.trials.first_run import first_run
from orchestrator.check.trials.rollback import rollback
from orchestrator.check.trials.step_size import step_size

Trial = Callable[[Bench], None]

TRIALS: dict[str, Trial] = {
    "runs": first_run,
    "determinism": determinism,
    "step size": step_size,
    "rollback": rollback,
    "feedthrough": feedthrough,
    "bad input": bad_inputs,
    "bad parameters": bad_parameters,
}
