"""The port contract as pages, docs/ports/*.md, from the built FMUs themselves: `python docs/make_ports.py` after `python build_fmus.py`."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from orchestrator.check.contract import Contract, Member
from orchestrator.check.drawing import drawn
from orchestrator.fmi.description import read_interface
from orchestrator.fmi.structure import read_structure
from orchestrator.master.slave import Interface, Variable

ROOT = Path(__file__).resolve().parents[1]
FMUS = ROOT / "build" / "fmus"
FOLDER = ROOT / "docs" / "ports"
MADE = "<!-- Made by docs/make_ports.py from the built FMU; change the unit, not this page. -->\n"
HEAD = "| variable | | unit | frame | range | nominal | start | companions | meaning |\n|---|---|---|---|---|---|---|---|---|\n"
PARAMETERS = "| parameter | unit | range | start | meaning |\n|---|---|---|---|---|\n"
ARROW = {"input": "in", "output": "out"}
ABOUT = """# The units' ports

What each unit takes and gives, page by page, as its FMU says it. A unit of yours that keeps a page's **bold** variables takes that unit's
place; the others are optional. `orchestrator check my.fmu --as KIND` holds it against the page.

- A vector is one row, `pad.force[1..3]`; its elements are FMI variables of their own, indices from 1, matrices by rows.
- *in*: the value at the start of the coming interval. *out*: the value at the end of the last one, or at initialisation.
- Companions: `_slope` of an input: how it runs through the interval; `_added`: a socket for an effect, default zero; `_mean` and
  `_slope` of an output: over the last interval. All optional.
- Frames: L is local, +X up; B is the body's, +X up, +Y right, +Z forward. Quaternions are (w, x, y, z).
- Everything is in SI. No range: any finite number.

| unit | kind of contract | what it is |
|---|---|---|
"""


def pages() -> dict[str, str]:
    """Name of a file in docs/ports -> its text."""
    fmus = sorted(FMUS.glob("*.fmu"))
    made = {f"{fmu.stem}.md": page(fmu) for fmu in fmus}
    rows = [f"| [{fmu.stem}]({fmu.stem}.md) | {read_structure(fmu).kind} | {read_interface(fmu).description} |" for fmu in fmus]
    return {"README.md": MADE + ABOUT + "\n".join(rows) + "\n", **made}


def page(fmu: Path) -> str:
    interface, kind = read_interface(fmu), read_structure(fmu).kind
    contract = next(iter(drawn([fmu]).values()))
    parts = [f"{MADE}# {fmu.stem}\n\n{interface.description} Contract: `{kind}`.\n"]
    for title, members in _by_port(contract):
        parts.append(f"## {title}\n\n{HEAD}{''.join(_row(m, contract, interface) for m in members)}")
    parameters = [elements for elements in interface.vectors.values() if elements[0].causality == "parameter"]
    if parameters:
        parts.append(f"## Parameters\n\n{PARAMETERS}{''.join(map(_parameter, parameters))}")
    return "\n".join(parts)


def _by_port(contract: Contract) -> Iterator[tuple[str, list[Member]]]:
    """Ports in the order declared, those that differ by their number only as one, what is in no port last."""
    ports: dict[str, list[Member]] = {}
    for member in contract.members:
        if not member.companion:
            ports.setdefault(member.name.rpartition(".")[0], []).append(member)
    alone = [member for member in ports.pop("", []) if not _is_repeated(member, contract)]
    shown: dict[tuple[str, ...], list[str]] = {}
    for port, members in ports.items():
        shown.setdefault((re.sub(r"\d+", "", port), *(m.name.removeprefix(port) for m in members)), []).append(port)
    for alike in shown.values():
        yield f"Port `{alike[0]}`" + (f" .. `{alike[-1]}`" if len(alike) > 1 else ""), ports[alike[0]]
    if alone:
        yield "Without a port", alone


def _is_repeated(member: Member, contract: Contract) -> bool:
    """contact2 .. contact8 are as contact1."""
    first = re.sub(r"\d+$", "1", member.name)
    return first != member.name and any(other.name == first for other in contract.members)


def _row(member: Member, contract: Contract, interface: Interface) -> str:
    first = interface.vectors[member.name][0]
    own = [m.name.removeprefix(member.name) for m in contract.members if m.companion and m.name.startswith(f"{member.name}_")]
    companions = ", ".join(f"`{suffix}`" for suffix in own if suffix in ("_slope", "_mean", "_added"))
    name = f"`{member.name}{f'[1..{member.size}]' if member.size else ''}`"
    start = _starts(interface.vectors[member.name]) if member.causality == "input" else ""
    unit = member.unit or member.kind.value
    cells = (f"**{name}**" if member.required else name, ARROW[member.causality], unit, member.frame, _range(first),
             f"{member.nominal:g}" if member.unit else "", start, companions, member.description)  # fmt: skip
    return _cells(cells)


def _parameter(elements: list[Variable]) -> str:
    first = elements[0]
    name = first.name.partition("[")[0] + (f"[1..{len(elements)}]" if first.name.endswith("]") else "")
    return _cells((f"`{name}`", first.unit or first.kind.value, _range(first), _starts(elements), first.description))


def _cells(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def _starts(elements: Iterable[Variable]) -> str:
    values = [_short(v.start) for v in elements]
    return values[0] if len(set(values)) == 1 else ", ".join(values)


def _short(start: str | None) -> str:
    try:
        return "" if start is None else f"{float(start):g}"
    except ValueError:
        return f"`{start}`"


def _range(variable: Variable) -> str:
    low, high = (None if bound is None else f"{bound:g}" for bound in (variable.minimum, variable.maximum))
    if low is None and high is None:
        return ""
    return f"{low} .. {high}" if low and high else f"≥ {low}" if low else f"≤ {high}"


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    made = pages()
    if len(made) == 1:
        sys.exit("build/fmus: holds no FMU; run python build_fmus.py first")
    for name, text in made.items():
        (FOLDER / name).write_text(text, "utf-8")


if __name__ == "__main__":
    main()
