"""Which outputs answer an input at once: seen, held against ModelStructure. Another dependence than stated breaks a master's order."""

from __future__ import annotations

import numpy as np

from orchestrator.check.bench import Bench
from orchestrator.check.driven import Driven
from orchestrator.check.finding import Finding, Verdict
from orchestrator.fmi.structure import Dependencies, known_of
from orchestrator.master.slave import Kind, stem

Pairs = list[tuple[str, str]]


def feedthrough(bench: Bench) -> None:
    unit = bench.fresh()
    bench.tell("initialisation")
    unit.prepare(bench.course.stop, bench.values)
    unit.follow(bench.course, 0.0, bench.course.step)
    bench.tell("inputs moved in initialisation mode")
    _report(bench, "feedthrough at the start", "InitialUnknowns", observed(unit), bench.structure.initially)
    unit.begin()
    bench.go_on(unit, 0, 3)
    bench.tell("inputs moved at a communication point")
    _report(bench, "feedthrough", "Outputs", observed(unit), bench.structure.outputs)


def observed(unit: Driven) -> Pairs:
    """(output, input) where moving the input by a hundredth of its nominal value moves the output."""
    unit.slave.exchange()
    before, found = unit.y.copy(), []
    for place, variable in enumerate(unit.inputs):
        if variable.kind is not Kind.REAL:
            continue
        value = unit.u[place]
        unit.u[place] = value + 1e-2 * abs(variable.nominal)
        unit.slave.exchange()
        found += [(unit.outputs[moved].name, variable.name) for moved in np.flatnonzero(unit.y != before)]
        unit.u[place] = value
    unit.slave.exchange()
    return found


def _report(bench: Bench, check: str, where: str, seen: Pairs, stated: Dependencies) -> None:
    undeclared = [(output, source) for output, source in seen if not _is_stated(stated, output, source)]
    if undeclared:
        output, source = undeclared[0]
        more = f", and {len(undeclared) - 1} more pairs" if len(undeclared) > 1 else ""
        what = f"{output} answers {source} at once, {where} does not say so{more}"
        bench.find(Finding(check, Verdict.FAIL, what, output, f"name {source} among its dependencies in {where}"))
    else:
        outputs = len({output for output, _ in seen})
        what = f"{outputs} outputs answer an input at once, all as {where} says" if seen else "no output answers an input at once"
        bench.find(Finding(check, Verdict.PASS, what))


def _is_stated(stated: Dependencies, output: str, source: str) -> bool:
    """An output that is not listed, or does not say, depends on everything."""
    known = known_of(stated, output)
    return known is None or source in known or stem(source) in known
