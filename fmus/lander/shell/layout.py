"""Layout: which slot of the memory each variable has. Made once per unit class; a slot's number is its value reference."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .bounds import LARGEST, Floats, Slots
from .records import Record

SHELL_STATES = ("shell.phase", "shell.stale", "shell.start_time")  # the shell's own hidden states, at the end of the memory
UNEVEN = 0.1  # of a quaternion's length: laws normalise it; what is further off is no attitude that was meant
MOST_ACCESSES = 1000  # a host asks for the same few sets of variables all the time; one that does not is not to fill the memory

Access = tuple[Slots | slice, bool]  # where, and whether all of it are inputs


@dataclass(frozen=True)
class Scalar:
    """One element of a variable: what FMI calls a scalar variable."""

    name: str
    slot: int
    start: float
    record: Record


@dataclass(frozen=True)
class Checked:
    """Slots with the bounds their values must keep."""

    slots: Slots
    low: Floats
    high: Floats


class Layout:
    """Places of all variables of a unit in one array of float64."""

    def __init__(self, records: Sequence[Record]) -> None:
        self.records = [one for declared in records for one in declared.expanded()]
        self.slices: dict[str, slice] = {}
        self.scalars: list[Scalar] = []
        for one in self.records:
            if one.name in self.slices:
                raise ValueError(f"variable {one.name} is declared twice")
            self.slices[one.name] = slice(len(self.scalars), len(self.scalars) + len(one.start))
            for i, start in enumerate(one.start, 1):
                name = f"{one.name}[{i}]" if one.vector else one.name
                self.scalars.append(Scalar(name, len(self.scalars), start, one))
        self.visible = [scalar for scalar in self.scalars if scalar.record.causality != "state"]
        self.size = len(self.scalars) + len(SHELL_STATES)
        self.template = np.array([scalar.start for scalar in self.scalars] + [0.0] * len(SHELL_STATES))
        self.parameters = self.checked("parameter")
        self.inputs = self.checked("input")
        self.results = self.checked("output", "local", bounded=False)
        self.computed = np.array([s.slot for s in self.scalars if s.record.causality in ("output", "local", "state")], dtype=np.intp)
        self.rotations = [self.slices[r.name] for r in self.records if r.causality == "input" and r.name.endswith("quaternion")]
        self.accesses: dict[tuple[int, ...], Access] = {}

    def checked(self, *causalities: str, bounded: bool = True) -> Checked:
        """The slots of some causalities; without declared bounds a value must be finite."""
        chosen = [scalar for scalar in self.scalars if scalar.record.causality in causalities]
        low = [s.record.minimum if bounded and s.record.minimum is not None else -LARGEST for s in chosen]
        high = [s.record.maximum if bounded and s.record.maximum is not None else LARGEST for s in chosen]
        return Checked(np.array([s.slot for s in chosen], dtype=np.intp), np.array(low), np.array(high))

    def no_rotation(self, memory: Floats) -> str | None:
        """A complaint about the first input quaternion that is none of a rotation."""
        for where in self.rotations:
            w, x, y, z = memory[where].tolist()
            if not abs((w * w + x * x + y * y + z * z) ** 0.5 - 1.0) <= UNEVEN:
                name = self.scalars[where.start].record.name
                return f"{name} is ({w:g}, {x:g}, {y:g}, {z:g}), expects length 1, to {UNEVEN:g}"
        return None

    def access(self, references: Sequence[int]) -> Access:
        """Where a set of value references lies, remembered; IndexError names one that is unknown."""
        key = tuple(references)
        found = self.accesses.get(key)
        if found is None:
            unknown = [vr for vr in key if not self.is_number(vr)]
            if unknown:
                raise IndexError(f"value reference {unknown[0]} is unknown")
            if len(self.accesses) >= MOST_ACCESSES:
                self.accesses.clear()
            run = bool(key) and key == tuple(range(key[0], key[0] + len(key)))
            where = slice(key[0], key[0] + len(key)) if run else np.array(key, dtype=np.intp)
            found = self.accesses[key] = (where, all(self.scalars[vr].record.causality == "input" for vr in key))
        return found

    def is_number(self, reference: int) -> bool:
        """Whether a value reference is that of a visible Real, Integer or Boolean."""
        if not 0 <= reference < len(self.scalars):
            return False
        record = self.scalars[reference].record
        return record.causality != "state" and record.kind != "String"

    def is_text(self, reference: int) -> bool:
        """Whether a value reference is that of a String parameter."""
        return 0 <= reference < len(self.scalars) and self.scalars[reference].record.kind == "String"

    def complaint(self, memory: Floats, slot: int) -> str:
        """What is wrong with the value in a slot: `pad.force[1] is nan N, expects a finite number`."""
        scalar, value = self.scalars[slot], float(memory[slot])
        low, high, unit = scalar.record.minimum, scalar.record.maximum, scalar.record.unit
        text = "" if unit in ("", "1") else f" {unit}"
        if not np.isfinite(value):
            return f"{scalar.name} is {value}, expects a finite number"
        shown = f"{value:.0f}" if scalar.record.kind == "Integer" else repr(value)
        rule = f"at least {low!r}" if low is not None and value < low else f"at most {high!r}"
        return f"{scalar.name} is {shown}{text}, expects {rule}{text}"
