"""Save, step, restore, step: the same bits, near and far, and through bytes into another instance. A claim that is not true is found."""

from __future__ import annotations

from collections.abc import Iterator

from orchestrator.check.bench import Bench
from orchestrator.check.driven import Driven
from orchestrator.check.finding import Finding, Verdict
from orchestrator.master.trials import Serialises

_AHEAD = 5
"""Steps past the saved point before the unit goes back."""


def rollback(bench: Bench) -> None:
    if not bench.interface.claims("canGetAndSetFMUstate"):
        bench.find(Finding("rollback", Verdict.NOTE, "not claimed: not tried"))
        return
    unit = bench.fresh()
    bench.start(unit)
    places = _places(bench.course.count)
    done = 0
    for place in places:
        bench.go_on(unit, done, place)
        done = min(place + _AHEAD, bench.course.count)
        if lie := _goes_back(bench, unit, place, done):
            do = "save every state the unit has, hidden ones too, or set canGetAndSetFMUstate to false"
            bench.find(Finding("rollback", Verdict.FAIL, f"canGetAndSetFMUstate is true, but {lie}", do=do))
            return
    told = f"the same bits after going back {_AHEAD} steps, twice, after steps {', '.join(map(str, places))}"
    bench.find(Finding("rollback", Verdict.PASS, told))
    _serialise(bench, unit)


def _places(count: int) -> list[int]:
    """Steps after which the state is saved, none that the unit has already gone past."""
    places = [0]
    for place in (count // 3, (2 * count) // 3):
        if places[-1] + _AHEAD <= place < count:
            places.append(place)
    return places


def _goes_back(bench: Bench, unit: Driven, place: int, end: int) -> str:
    """Where the bits differ, in words; or nothing."""
    bench.tell(f"saving the state after step {place}")
    unit.slave.save()
    first = bench.go_on(unit, place, end)
    for _ in range(2):
        bench.tell(f"restoring the state saved after step {place}")
        unit.slave.restore()
        for n, (one, other) in enumerate(zip(first, bench.go_on(unit, place, end), strict=True), place + 1):
            if one != other:
                return f"step {n} gives other bits after going back to step {place}: {next(_differences(unit, one, other))}"
    return ""


def _differences(unit: Driven, one: bytes, other: bytes) -> Iterator[str]:
    import numpy as np

    for variable, before, after in zip(unit.outputs, np.frombuffer(one), np.frombuffer(other), strict=True):
        if before != after:
            yield f"{variable.name} was {before!s}, is {after!s}"
    yield "in bits only"


def _serialise(bench: Bench, unit: Driven) -> None:
    check = "serialisation"
    if not bench.interface.claims("canSerializeFMUstate") or not isinstance(unit.slave, Serialises):
        bench.find(Finding(check, Verdict.NOTE, "not claimed: no checkpoints with it"))
        return
    bench.start(unit)
    middle, end = bench.course.count // 2, min(bench.course.count // 2 + _AHEAD, bench.course.count)
    bench.go_on(unit, 0, middle)
    unit.slave.save()
    bench.tell("serialising the state")
    data = unit.slave.serialised_state()
    first = bench.go_on(unit, middle, end)
    other = unit if bench.interface.claims("canBeInstantiatedOnlyOncePerProcess") else bench.fresh()
    bench.start(other)
    bench.tell("deserialising the state in another instance")
    assert isinstance(other.slave, Serialises)
    other.slave.adopt_state(data)
    other.slave.restore()
    again = bench.go_on(other, middle, end)
    do = "write every state into the bytes, or set canSerializeFMUstate to false"
    if first != again:
        n = next(n for n, (one, two) in enumerate(zip(first, again, strict=True), middle + 1) if one != two)
        bench.find(Finding(check, Verdict.FAIL, f"step {n} gives other bits from the {len(data)} bytes of the state", do=do))
    else:
        bench.find(Finding(check, Verdict.PASS, f"{len(data)} bytes carry on in another instance with the same bits"))
