"""Parameters below their stated minimum, and masses below zero: refused by name before the first step, or at the first step."""

from __future__ import annotations

from collections.abc import Iterator

from orchestrator.check.bench import Bench
from orchestrator.check.driven import Driven
from orchestrator.check.finding import Finding, Verdict
from orchestrator.errors import StepError
from orchestrator.master.slave import Kind, Status, Variable, stem

MOST = 12


def bad_parameters(bench: Bench) -> None:
    unit, refused, taken = bench.fresh(), 0, []
    for variable, value in _probes(bench):
        label = f"{variable.name} = {value:g}"
        if label in bench.skip:
            continue
        bench.tell(f"probe {label}")
        try:
            outcome = _probe(bench, unit, variable.name, value)
        except StepError as error:
            outcome = "refused"
            unit = bench.fresh() if "Error" in str(error) or "Fatal" in str(error) else unit
        if outcome == "refused":
            refused += 1
        elif outcome:
            do = "refuse it with a message that names it"
            bench.find(Finding("bad parameters", Verdict.FAIL, f"is accepted, and {outcome}", label, do))
        else:
            taken.append(label)
    if taken:
        what = f"{len(taken)} values out of their range are accepted: {', '.join(taken[:4])}"
        bench.find(Finding("bad parameters", Verdict.WARN, what, do="refuse them with a message that names the parameter"))
    else:
        what = f"{refused} values out of their range refused" if refused else "none has a range"
        bench.find(Finding("bad parameters", Verdict.PASS, what))


def _probes(bench: Bench) -> Iterator[tuple[Variable, float]]:
    """Below what is stated; a mass below zero."""
    seen: set[str] = set()
    for variable in bench.interface.of("parameter"):
        if variable.kind is not Kind.REAL or stem(variable.name) in seen or len(seen) >= MOST:
            continue
        low = 0.0 if variable.minimum is None and variable.unit == "kg" else variable.minimum
        if low is not None:
            seen.add(stem(variable.name))
            yield variable, low - max(1.0, abs(low))


def _probe(bench: Bench, unit: Driven, name: str, value: float) -> str:
    """"refused", or what is wrong with the outputs, or nothing."""
    unit.start(bench.course, {**bench.values, name: value})
    unit.follow(bench.course, 0.0, bench.course.step)
    if unit.step(0.0, bench.course.step) is Status.DISCARD:
        return "refused"
    return unit.not_finite()
