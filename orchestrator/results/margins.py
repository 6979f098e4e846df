"""The failure measures of a landing as a person reads them: what was reached, what was allowed, what was left."""

from collections.abc import Mapping
from typing import Any

from rich.table import Table
from rich.text import Text

Measures = Mapping[str, Any]
TITLES = {
    "primary_stroke": "primary stroke",
    "secondary_compression": "secondary compression",
    "secondary_tension": "secondary tension",
}
NONE = "–"


def margins(failure: Measures) -> Table:
    """A row a measure; red where the margin is used up."""
    table = Table(box=None, header_style="bold", pad_edge=False, padding=(0, 2, 0, 0))
    for heading in ("margin", "left", "reached", "limit", "where"):
        table.add_column(heading, justify="right" if heading in ("left", "reached", "limit") else "left")
    for name, cells in rows(failure):
        table.add_row(*cells, style="red" if name in failure["failed"] else "")
    return table


def rows(failure: Measures) -> list[tuple[str, tuple[str | Text, ...]]]:
    """(measure's key, its cells); a measure that was not known is left out."""
    found: list[tuple[str, tuple[str | Text, ...]]] = []
    if tip := failure["tip_over"]:
        found.append(("tip_over", _tip_over(tip)))
    for name, title in TITLES.items():
        if row := failure[name]:
            found.append((name, (title, _cm(row["margin_m"]), _cm(row["peak_m"]), _cm(row["limit_m"]), row["strut"])))
    if row := failure["clearance"]:
        found.append(("clearance", ("nozzle above ground", _cm(row["margin_m"]), "", "", f"at {row['at_s']:.2f} s")))
    loads = failure["peak_loads"]
    for kind, title in (("primary", "load of a primary"), ("secondary", "load of a secondary"), ("pad", "force on a pad")):
        if row := loads[kind]:
            found.append((kind, (title, "", f"{row['load_N'] / 1e3:.1f} kN", "", row["at"])))
    return found


def _tip_over(tip: Measures) -> tuple[str, ...]:
    """Energy at the end stands behind the angle: what it would take to push the vehicle over where it has come to rest."""
    words = "TIPPED OVER" if tip["tipped"] else "" if tip["decided"] else "not decided at the end"
    energy = tip["final_energy_margin_J"]
    rest = "" if energy is None else f"{energy / 1e3:.1f} kJ at the end"
    where = ", ".join(word for word in (f"{tip['edge']} at {tip['at_s']:.2f} s", rest, words) if word)
    return ("tip-over", f"{tip['least_angle_deg']:.1f} deg", "", "", where)


def _cm(length: float | None) -> str:
    return NONE if length is None else f"{length * 100.0:.1f} cm"
