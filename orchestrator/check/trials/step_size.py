"""Halving the step must bring the outputs together: compared at the instants that H, H/2 and H/4 share."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from orchestrator.check.bench import Bench
from orchestrator.check.course import Course
from orchestrator.check.finding import Finding, Verdict
from orchestrator.master.slave import Kind

CLOSE = 1e-2
"""Of an output's largest value: closer than this between H/2 and H/4 is converged: a unit may hold a tolerance of its own."""
SHRINKS = 0.8
"""The second difference may be this share of the first; first order gives a half."""
_VARIABLE_STEP = "canHandleVariableCommunicationStepSize"
_SUFFIXES = ("_mean", "_slope")


def step_size(bench: Bench) -> None:
    if not bench.interface.capabilities.get(_VARIABLE_STEP, True):
        bench.find(Finding("step size", Verdict.NOTE, "takes one step size only: not tried"))
        return
    unit = bench.fresh()
    judged = [place for place, v in enumerate(unit.outputs) if v.kind is Kind.REAL and _is_judged(v.name)]
    if not judged:
        bench.find(Finding("step size", Verdict.NOTE, "no output in a port: not tried"))
        return
    runs = []
    for parts in (1, 2, 4):
        course = Course(bench.course.step / parts, bench.course.stop, bench.course.knots)
        bench.tell(f"steps of H/{parts}")
        rows = bench.run(unit, course)[::parts]
        runs.append(np.array([np.frombuffer(row) for row in rows])[:, judged])
    _judge(bench, [unit.outputs[place].name for place in judged], runs)


def _is_judged(name: str) -> bool:
    stem = name.partition("[")[0]
    return "." in stem and not stem.endswith(_SUFFIXES)


def _judge(bench: Bench, names: list[str], runs: list[NDArray[np.float64]]) -> None:
    """Mean differences over the course, so that one jump on a sampling instant does not count more than its share."""
    scale = np.maximum(np.abs(runs[2]).max(axis=0), 1e-9)
    first, second = (np.abs(one - other).mean(axis=0) / scale for one, other in ((runs[0], runs[1]), (runs[1], runs[2])))
    apart = (second > CLOSE) & (second > SHRINKS * first)
    worst = int(np.argmax(np.where(apart, second, -1.0))) if apart.any() else int(np.argmax(second))
    what = f"{names[worst]}: {first[worst]:.2g} of its size between H = {bench.course.step:g} s and H/2, {second[worst]:.2g} to H/4"
    if apart.any():
        do = "integrate in time, not in calls: the step is told by doStep"
        bench.find(Finding("step size", Verdict.FAIL, f"does not converge; {what}", names[worst], do))
    else:
        bench.find(Finding("step size", Verdict.PASS, f"halving the step converges; {what}"))
