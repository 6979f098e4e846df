"""All checks on one FMU: what it states, then what it does."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from orchestrator.check.contract import Contract, contract_of
from orchestrator.check.finding import Finding, Verdict
from orchestrator.check.guess import guessed
from orchestrator.check.stated import statements
from orchestrator.check.trials import TRIALS
from orchestrator.check.watch import watched
from orchestrator.check.written import against
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.structure import read_structure
from orchestrator.master.slave import Interface, Value

_NEEDED = "runs"
"""The trial without which no other makes sense."""


@dataclass
class Checked:
    """What came of it."""

    path: Path
    interface: Interface
    kind: str
    """Of contract; empty: held against none."""
    guessed: bool
    findings: list[Finding] = field(default_factory=list)

    @property
    def failed(self) -> list[Finding]:
        return [finding for finding in self.findings if finding.verdict is Verdict.FAIL]


def checked(path: Path, kind: str | None, values: Mapping[str, Value], timeout: float, told: Callable[[str], None]) -> Checked:
    """`kind` None: guessed from the ports; `told` hears what is being tried. UnitError where the file is no FMU this master can step."""
    interface, structure = read_interface(path), read_structure(path)
    contract: Contract | None = contract_of(kind) if kind else guessed(interface, structure.kind)
    result = Checked(path, interface, contract.kind if contract else "", kind is None)
    told("description")
    result.findings += statements(path, interface, structure)
    if contract:
        result.findings += against(interface, contract)
    job = {"fmu": str(path), "kind": result.kind, "values": dict(values)}
    digests = []
    for trial in TRIALS:
        told(trial)
        heard = watched(trial, job, timeout)
        result.findings += heard.findings
        digests.append(heard.kept.get("digest"))
        if trial == _NEEDED and any(finding.verdict is Verdict.FAIL for finding in heard.findings):
            others = ", ".join(name for name in TRIALS if name != _NEEDED)
            result.findings.append(Finding("other trials", Verdict.NOTE, f"not tried: {others}", do="mend the first run, then check again"))
            break
    first, second = (*digests, None, None)[:2]
    if first and second and first != second:
        what = "other bits in another process"
        result.findings.append(Finding("determinism", Verdict.FAIL, what, do="leave out addresses, clocks and random numbers"))
    return result
