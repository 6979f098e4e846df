"""All checks on one FMU: what it states, then what it does."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from orchestrator.check.contract import Contract, contract_of
from orchestrator.check.finding import Finding, Verdict
from orchestrator.check.guess import guessed
from orchestrator.check.stated import statements
from orchestrator.check.trials import TRIALS
from orchestrator.check.watch import Heard, watched
from orchestrator.check.written import against
from orchestrator.errors import UserError, nearest
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.structure import read_structure
from orchestrator.master.slave import Interface, Value

_NEEDED = "runs"
"""The trial without which no other makes sense."""
_AT_ONCE = 2


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


def checked(
    path: Path, kind: str | None, values: Mapping[str, Value], timeout: float, told: Callable[[str], None], only: Collection[str] = ()
) -> Checked:
    """`kind` None: guessed from the ports; `told` hears what is being tried; `only`: names of trials, empty: all.

    UnitError where the file is no FMU this master can step.
    """
    for name in only:
        if name not in TRIALS:
            raise UserError(f"--only {name}: no such trial; {nearest(name, TRIALS)}")
    interface, structure = read_interface(path), read_structure(path)
    contract: Contract | None = contract_of(kind) if kind else guessed(interface, structure.kind)
    result = Checked(path, interface, contract.kind if contract else "", kind is None)
    told("description")
    result.findings += statements(path, interface, structure)
    if contract:
        result.findings += against(interface, contract)
    job = {"fmu": str(path), "kind": result.kind, "values": dict(values)}
    wanted = [name for name in TRIALS if name != _NEEDED and (name in only or not only)]
    heard = _trials(wanted, job, timeout, told)
    result.findings += [finding for one in heard for finding in one.findings]
    if len(heard) <= len(wanted):
        untried = f"not tried: {', '.join(wanted)}"
        result.findings.append(Finding("other trials", Verdict.NOTE, untried, do="mend the first run, then check again"))
    digests = [one.kept["digest"] for one in heard if "digest" in one.kept]
    if len(set(digests)) > 1:
        what = "other bits in another process"
        result.findings.append(Finding("determinism", Verdict.FAIL, what, do="leave out addresses, clocks and random numbers"))
    return result


def _trials(wanted: Sequence[str], job: Mapping[str, object], timeout: float, told: Callable[[str], None]) -> list[Heard]:
    """The first run, and if it went well those wanted, two at a time."""

    def tried(trial: str) -> Heard:
        told(trial)
        return watched(trial, job, timeout)

    first = tried(_NEEDED)
    if any(finding.verdict is Verdict.FAIL for finding in first.findings):
        return [first]
    with ThreadPoolExecutor(_AT_ONCE) as pool:
        return [first, *pool.map(tried, wanted)]
