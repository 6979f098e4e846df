"""What stands in the description, held against the contract: names, causality, shape, units of measure, frames, nominal values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from orchestrator.check.contract import Contract, Member, frame_in
from orchestrator.check.finding import Finding, Verdict
from orchestrator.errors import nearest
from orchestrator.master.slave import Interface, Kind, Variable

_FAR = 1e3
"""Factor between two nominal values of which one must be a mistake."""


def against(interface: Interface, contract: Contract) -> list[Finding]:
    """A line for each thing that is wrong, and one for each check that found nothing."""
    there = {member.name: interface.vectors.get(member.name, []) for member in contract.members}
    right = [member for member in contract.members if there[member.name] and there[member.name][0].causality == member.causality]
    pairs = [(member, there[member.name]) for member in right]
    checks = (
        ("names", _names(interface, contract), f"all {len(contract.required)} required variables of {contract.kind}"),
        ("causality", _causality(there, contract), "inputs are inputs, outputs are outputs"),
        ("type and size", _shape(pairs), f"{len(pairs)} variables as the contract has them"),
        ("units of measure", _units(pairs), "as the contract has them, SI"),
        ("frames", _frames(pairs), "stated in the descriptions, as the contract has them"),
        ("nominal values", _nominals(pairs), "of the contract's order of magnitude"),
    )
    found = []
    for check, wrong, well in checks:
        lines = list(wrong)
        if all(line.verdict is Verdict.NOTE for line in lines):
            found.append(Finding(check, Verdict.PASS, well))
        found += lines
    return found


def _names(interface: Interface, contract: Contract) -> Iterator[Finding]:
    missing = [member for member in contract.members if not interface.vectors.get(member.name)]
    for member in missing:
        if member.required:
            near = nearest(member.name, interface.vectors)
            what = f"{member.causality} is missing, the contract requires it{_of(member)}"
            yield Finding("names", Verdict.FAIL, what, member.name, f"add it; {near}" if near.startswith("did") else "add it")
    models = [member.name for member in missing if member.is_model and member.causality == "output" and not member.companion]
    if models:
        what = f"no reduced interface model ({', '.join(models[:3])}{', ...' if len(models) > 3 else ''})"
        yield Finding("names", Verdict.NOTE, what, do="none is needed; without it the master takes shorter steps")
    others = [m.name for m in missing if not (m.required or m.is_model or m.companion)]
    for causality, meaning in (("output", "what is not given cannot be recorded or connected"), ("input", "what is not taken is ignored")):
        names = [name for name in others if _causality_of(contract, name) == causality]
        if names:
            what = f"{len(names)} optional {causality}s are not there: {', '.join(names[:6])}{', ...' if len(names) > 6 else ''}"
            yield Finding("names", Verdict.NOTE, what, do=meaning)


def _causality_of(contract: Contract, name: str) -> str:
    return next(member.causality for member in contract.members if member.name == name)


def _causality(there: dict[str, list[Variable]], contract: Contract) -> Iterator[Finding]:
    for member in contract.members:
        variables = there[member.name]
        if variables and variables[0].causality != member.causality:
            what = f"is {variables[0].causality}, the contract has it as {member.causality}"
            verdict = Verdict.FAIL if member.required else Verdict.WARN
            yield Finding("causality", verdict, what, member.name, "declare the other causality or use another name")


def _shape(pairs: Sequence[tuple[Member, list[Variable]]]) -> Iterator[Finding]:
    for member, variables in pairs:
        if variables[0].kind is not member.kind:
            what = f"is {variables[0].kind}, the contract has {member.kind}"
            yield Finding("type and size", Verdict.FAIL, what, member.name, f"declare it {member.kind}")
        elif [v.name for v in variables] != member.elements:
            has, expected = f"{len(variables)} elements ({variables[0].name} ...)", f"{len(member.elements)} ({member.elements[0]} ...)"
            what = f"has {has}, the contract {expected}"
            yield Finding("type and size", Verdict.FAIL, what, member.name, "give as many, counted from 1")


def _units(pairs: Sequence[tuple[Member, list[Variable]]]) -> Iterator[Finding]:
    for member, variables in pairs:
        if member.kind is not Kind.REAL:
            continue
        first = next((v for v in variables if v.unit != variables[0].unit), variables[0])
        if not first.unit:
            if member.unit != "1" and not member.companion:
                what = f"states no unit of measure, the contract has {member.unit}"
                yield Finding("units of measure", Verdict.WARN, what, member.name, f"declare {member.unit}, or a mistake goes unseen")
        elif first.dimension is not None and first.dimension != member.dimension:
            what = f"is in {first.unit}{_size(first, member)}, the contract has {member.unit}"
            if first.dimension[:8] == (member.dimension or ())[:8]:
                do = f"our master converts it, others do not: give {member.unit}"
                yield Finding("units of measure", Verdict.WARN, what, member.name, do)
            else:
                yield Finding("units of measure", Verdict.FAIL, what, member.name, f"give and take {member.unit}")
        elif first.dimension is None and first.unit != member.unit:
            what = f"is in {first.unit}, which UnitDefinitions does not define, the contract has {member.unit}"
            yield Finding("units of measure", Verdict.FAIL, what, member.name, f"give and take {member.unit}, and define it")


def _size(variable: Variable, member: Member) -> str:
    """The factor to SI, where that is all the difference."""
    if variable.dimension is None or member.dimension is None or variable.dimension[:8] != member.dimension[:8]:
        return ""
    return f" ({variable.dimension[8]:g} SI)"


def _frames(pairs: Sequence[tuple[Member, list[Variable]]]) -> Iterator[Finding]:
    silent = []
    for member, variables in pairs:
        stated = frame_in(variables[0].description)
        if not member.frame or stated == member.frame:
            continue
        if stated:
            what = f'is in frame "{stated}" by its description, the contract has "{member.frame}"'
            yield Finding("frames", Verdict.FAIL, what, member.name, "give it in the contract's frame, or mend the description")
        else:
            silent.append(member)
    if silent:
        named = ", ".join(f'{member.name} ("{_words(member)}")' for member in silent[:4]) + (", ..." if len(silent) > 4 else "")
        yield Finding("frames", Verdict.WARN, f"{len(silent)} vectors state none: {named}", do="write the frame into the description")


def _words(member: Member) -> str:
    return f"frame {member.frame}" if len(member.frame) == 1 else member.frame


def _nominals(pairs: Sequence[tuple[Member, list[Variable]]]) -> Iterator[Finding]:
    for member, variables in pairs:
        ratio = abs(variables[0].nominal) / member.nominal
        if member.kind is Kind.REAL and not member.companion and not 1.0 / _FAR < ratio < _FAR:
            what = f"nominal is {variables[0].nominal:g}, the contract has {member.nominal:g} {member.unit}"
            yield Finding("nominal values", Verdict.WARN, what, member.name, "state one of that order: the step control weighs by it")


def _of(member: Member) -> str:
    size = f"[1..{member.size}]" if member.size else ""
    unit = f" in {member.unit}" if member.unit and member.unit != "1" else ""
    return f": {member.name}{size}{unit}" + (f", {member.description}" if member.description else "")
