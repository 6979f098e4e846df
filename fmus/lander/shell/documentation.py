"""documentation/index.html of a unit: its docstring, its ports, all variables, all messages it can give by itself."""

import inspect
from html import escape
from typing import TYPE_CHECKING

from .records import Record
from .terminals import ports

if TYPE_CHECKING:
    from .unit import Unit

STYLE = "body{font-family:sans-serif;max-width:70em;margin:2em auto}td,th{text-align:left;padding:0 1em 0 0;vertical-align:top}"
PROMISES = """Every quantity is in SI. An input holds at the start of the coming interval, with x_slope it runs linearly through it;
an output holds at its end, x_mean and x_slope are its mean and slope over it. The FMU state is saved and restored to the last bit.
A value that is not a number or out of its bounds is named in the log and in the String variable message; a parameter's is
found at the end of initialisation, and each doStep after that is discarded. reference.csv, where it is, holds an experiment
with its inputs and results: to be repeated with the default experiment's steps."""


def documentation(unit: "type[Unit]") -> str:
    """The page."""
    records = [record for record in unit.layout.records if record.causality != "state"]
    head = f"<head><meta charset='utf-8'><title>{unit.__name__}</title><style>{STYLE}</style></head>"
    parts = [
        f"<!DOCTYPE html><html lang='en'>{head}<body>",
        f"<h1>{unit.__name__}</h1><p>{escape(unit.description)}</p><pre>{escape(inspect.getdoc(unit) or '')}</pre>",
        f"<p>{escape(PROMISES)}</p>",
    ]
    named = ports(unit.layout)
    if named:
        parts.append(f"<h2>Ports</h2><p>{', '.join(escape(port) for port in named)}</p>")
    for causality in ("parameter", "input", "output", "local"):
        chosen = [record for record in records if record.causality == causality]
        if chosen:
            parts.append(f"<h2>{causality.capitalize()}s</h2>{table(chosen)}")
    return "\n".join([*parts, "</body></html>\n"])


def table(records: list[Record]) -> str:
    """One row a variable; a vector is one row."""
    rows = "".join(
        f"<tr><td><code>{escape(shape(r))}</code></td><td>{escape(r.unit)}</td><td>{value(r)}</td><td>{limits(r)}</td>"
        f"<td>{escape(r.description)}</td></tr>\n"
        for r in records
    )
    return f"<table><tr><th>name</th><th>unit</th><th>start</th><th>range</th><th>meaning</th></tr>\n{rows}</table>"


def shape(record: Record) -> str:
    """The name with its range of indices."""
    return f"{record.name}[1..{len(record.start)}]" if record.vector else record.name


def value(record: Record) -> str:
    """The start value, where it is one that the user may set."""
    if record.causality not in ("parameter", "input"):
        return ""
    numbers = [f"{number:g}" for number in record.start]
    return numbers[0] if len(set(numbers)) == 1 else ", ".join(numbers)


def limits(record: Record) -> str:
    """The bounds, where there are any."""
    low = "" if record.minimum is None else f"{record.minimum:g}"
    high = "" if record.maximum is None else f"{record.maximum:g}"
    return f"{low} .. {high}" if low or high else ""
