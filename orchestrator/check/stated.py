"""What any FMU should state, whatever its kind: a valid description, dependencies, capabilities, units of measure."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from orchestrator.check.finding import Finding, Verdict
from orchestrator.fmi.structure import Structure, known_of
from orchestrator.master.slave import Interface, Kind, stem

_ROLLBACK = "canGetAndSetFMUstate"
_VARIABLE_STEP = "canHandleVariableCommunicationStepSize"


def statements(path: Path, interface: Interface, structure: Structure) -> list[Finding]:
    return [*_description(path), *_dependencies(interface, structure), *_capabilities(interface), *_bounds(interface)]


def _description(path: Path) -> Iterator[Finding]:
    """What FMPy's validation has to say."""
    from fmpy.validation import validate_fmu

    complaints = [" ".join(str(complaint).split()) for complaint in validate_fmu(str(path))]
    if not complaints:
        yield Finding("description", Verdict.PASS, "valid")
    for complaint in complaints[:10]:
        yield Finding("description", Verdict.WARN, complaint[:300], do="mend modelDescription.xml")


def _dependencies(interface: Interface, structure: Structure) -> Iterator[Finding]:
    outputs = [v.name for v in interface.of("output")]
    listed = [name for name in outputs if name in structure.outputs or stem(name) in structure.outputs]
    known = {(v.type, v.reference) for v in map(interface.variables.__getitem__, listed)}      # another name needs no line of its own
    unlisted = [v.name for v in interface.of("output") if (v.type, v.reference) not in known]
    silent = [name for name in listed if known_of(structure.outputs, name) is None]
    if unlisted:
        what = f"ModelStructure does not list {len(unlisted)} of {len(outputs)} outputs"
        yield Finding("dependencies stated", Verdict.WARN, what, unlisted[0], "list every output")
    elif silent:
        what = f"{len(silent)} of {len(outputs)} outputs do not say what they depend on: on everything, then"
        yield Finding("dependencies stated", Verdict.WARN, what, silent[0], 'state dependencies="" where no input feeds through')
    else:
        yield Finding("dependencies stated", Verdict.PASS, f"for all {len(outputs)} outputs")


def _capabilities(interface: Interface) -> Iterator[Finding]:
    if not interface.claims(_ROLLBACK):
        what = f"{_ROLLBACK} is false"
        yield Finding("capabilities", Verdict.WARN, what, do="the master steps it once an accepted step and must take shorter ones")
    if not interface.capabilities.get(_VARIABLE_STEP, True):
        yield Finding("capabilities", Verdict.WARN, f"{_VARIABLE_STEP} is false", do="its step is forced on all other units")
    if interface.claims("needsExecutionTool"):
        yield Finding("capabilities", Verdict.NOTE, "needs a tool on the machine that runs it", do="see docs/hosts.md for ours")
    if interface.claims(_ROLLBACK) and interface.capabilities.get(_VARIABLE_STEP, True):
        yield Finding("capabilities", Verdict.PASS, "takes steps of any length and says it goes back")


def _bounds(interface: Interface) -> Iterator[Finding]:
    """A parameter that is a mass or a length takes no negative value, and says so."""
    silent = [v.name for v in interface.of("parameter") if v.kind is Kind.REAL and v.unit == "kg" and v.minimum is None]
    if silent:
        what = f"no min stated for a mass: {', '.join(silent[:4])}"
        yield Finding("bounds", Verdict.WARN, what, silent[0], "state min, and refuse what is below")
