"""Where trials run: in a process of their own, telling after each action how far they came, because the unit may take the process down."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TextIO

from orchestrator.check.contract import Contract, contract_of
from orchestrator.check.course import Course, course_of
from orchestrator.check.driven import Driven
from orchestrator.check.finding import Finding
from orchestrator.errors import StepError
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.load import load
from orchestrator.fmi.structure import read_structure
from orchestrator.master.slave import Status, Value


class Bench:
    """One unit, its course, and a file to which findings and progress go, a line each."""

    def __init__(self, job: Mapping[str, Any], said: TextIO) -> None:
        self.path = Path(job["fmu"])
        self.interface, self.structure = read_interface(self.path), read_structure(self.path)
        self.contract: Contract | None = contract_of(job["kind"]) if job["kind"] else None
        course = course_of(self.interface, self.structure, self.contract)
        share = float(job.get("share", 1.0))
        self.course = Course(course.step * share, course.stop * share, course.knots)
        self.values: dict[str, Value] = dict(job.get("values", {}))
        self.skip: set[str] = set(job.get("skip", ()))
        """Probes that an earlier process did not survive."""
        self._said = said
        self._made = 0

    def tell(self, at: str) -> None:
        """What is about to be done: if nothing more is heard, that is where it went wrong."""
        self._write({"at": at})

    def find(self, finding: Finding) -> None:
        self._write({"finding": finding.as_json()})

    def keep(self, name: str, value: Any) -> None:
        """Something for the other process to compare."""
        self._write({"kept": [name, value]})

    def _write(self, line: Mapping[str, Any]) -> None:
        self._said.write(json.dumps(line) + "\n")
        self._said.flush()

    def fresh(self) -> Driven:
        """A new instance."""
        self.tell("instantiation")
        self._made += 1
        return Driven(load(f"{self.path.stem}{self._made}", self.interface))

    def start(self, unit: Driven, course: Course | None = None) -> None:
        self.tell("initialisation")
        unit.start(course or self.course, self.values)

    def run(self, unit: Driven, course: Course | None = None) -> list[bytes]:
        """From start to stop; the outputs' bits after each step. StepError where a step is refused or gives no number."""
        course = course or self.course
        self.start(unit, course)
        return [unit.y.tobytes(), *self.go_on(unit, 0, course.count, course)]

    def go_on(self, unit: Driven, first: int, last: int, course: Course | None = None) -> list[bytes]:
        """Steps first + 1 to last of the course."""
        course, rows = course or self.course, []
        for n in range(first, last):
            time = n * course.step
            where = f"step {n + 1} of {course.count}, {course.step:g} s from t = {time:.6g} s"
            self.tell(where)
            unit.follow(course, time, course.step)
            if unit.step(time, course.step) is Status.DISCARD:
                raise StepError(f"{where}: refused with Discard: {unit.last_word}")
            if bad := unit.not_finite():
                raise StepError(f"{where}: {bad}")
            rows.append(unit.y.tobytes())
        return rows
