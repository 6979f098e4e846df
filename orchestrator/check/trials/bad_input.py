"""Not a number, infinity, huge numbers, a step of no length: to be refused or borne, never passed on, never a crash."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf, nan

from orchestrator.check.bench import Bench
from orchestrator.check.driven import Driven
from orchestrator.check.finding import Finding, Verdict
from orchestrator.errors import StepError
from orchestrator.master.slave import Kind, Status, Variable, stem

MOST = 12
"""Inputs that are tried; one element of each vector."""
HUGE = 1e30


def bad_inputs(bench: Bench) -> None:
    """Each probe on a unit set up anew; a unit that answered Error is left alone and another made."""
    unit, refused, borne = bench.fresh(), 0, 0
    for name, value in _probes(bench, unit):
        label = f"{name} = {value}"
        if label in bench.skip:
            continue
        bench.tell(f"probe {label}")
        try:
            outcome = _probe(bench, unit, name, value)
        except StepError as error:
            outcome = f"refused: {error}"
        if outcome.startswith("refused"):
            refused += 1
            unit = bench.fresh() if "Error" in outcome or "Fatal" in outcome else unit
        elif outcome:
            do = "answer Discard or Error with a message that names the variable"
            bench.find(Finding("bad input", Verdict.FAIL, f"doStep is OK, but {outcome}", label, do))
        else:
            borne += 1
    bench.find(Finding("bad input", Verdict.PASS, f"{refused} of {refused + borne} probes refused, the others borne with finite outputs"))


def _probes(bench: Bench, unit: Driven) -> Iterator[tuple[str, float]]:
    chosen = _chosen(unit.inputs, [member.name for member in bench.contract.required] if bench.contract else [])
    for variable in chosen:
        yield from ((variable.name, bad) for bad in (nan, inf, HUGE))
    yield "step", 0.0
    yield "step", -bench.course.step


def _chosen(inputs: Sequence[Variable], required: Sequence[str]) -> list[Variable]:
    """The first element of each vector, required ones first."""
    stems: dict[str, Variable] = {}
    for variable in inputs:
        if variable.kind is Kind.REAL:
            stems.setdefault(stem(variable.name), variable)
    return sorted(stems.values(), key=lambda v: stem(v.name) not in required)[:MOST]


def _probe(bench: Bench, unit: Driven, name: str, value: float) -> str:
    """"refused: ...", or what is wrong with the outputs, or nothing."""
    course, interval = bench.course, bench.course.step
    unit.start(course, bench.values)
    unit.follow(course, 0.0, interval)
    if name == "step":
        interval = value
    else:
        unit[name] = value
    if unit.step(0.0, interval) is Status.DISCARD:
        return f"refused: {unit.last_word}"
    return unit.not_finite()
