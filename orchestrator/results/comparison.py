"""A run's strokes, penetration, skid and attitude beside the published ones: numbers first, then Markdown."""

import math
from collections.abc import Mapping
from typing import Any

from orchestrator.results.references import References

Strokes = Mapping[str, float | None]


def rms_difference(ours: Strokes, theirs: Strokes) -> tuple[float | None, int]:
    """√(mean (ours − theirs)²) over the struts both have a number for, in their unit, and how many those are."""
    pairs = [(a, b) for strut, a in ours.items() if a is not None and (b := theirs.get(strut)) is not None]
    if not pairs:
        return None, 0
    return math.sqrt(sum((a - b) ** 2 for a, b in pairs) / len(pairs)), len(pairs)


def compare(summary: Mapping[str, Any], references: References, chosen: str | None, measured: str | None) -> dict[str, Any]:
    """Everything the run and the references have in common; lengths in m, angles in deg.

    `rms_m` gives the distance of the run's strokes to every column, `rms_to_measured_m` that of every column to the
    first one of the file (the photographs), which is the paper's measure of merit.
    """
    strokes: Strokes = summary["strokes_m"]
    rms = {column: rms_difference(strokes, theirs) for column, theirs in references.strokes.items()}
    yardstick = next(iter(references.strokes), None)
    among = {
        column: rms_difference(theirs, references.strokes[yardstick])[0]
        for column, theirs in references.strokes.items()
        if yardstick is not None and column != yardstick
    }
    return {
        "chosen": chosen,
        "rms_m": {column: value for column, (value, _) in rms.items()},
        "rms_struts": {column: number for column, (_, number) in rms.items()},
        "rms_to_measured_m": among,
        "strokes_m": {strut: {column: theirs.get(strut) for column, theirs in references.strokes.items()} for strut in strokes},
        "observables": {
            "ours": _observables(summary),
            "published": references.section(chosen),
            "measured": references.section(measured),
        },
        "source": references.source,
    }


def _observables(summary: Mapping[str, Any]) -> dict[str, Any]:
    """The run's numbers under the names the reference sections use."""
    depths = [depth for depth in summary["penetration_m"].values() if depth is not None]
    skids = [skid for skid in summary["skid_m"].values() if skid is not None]
    touched = {leg: t for leg, t in summary["contact_times_s"].items() if t is not None}
    first = min(touched.values(), default=0.0)
    order = sorted(touched, key=touched.__getitem__)
    return {
        "penetration_range_m": [min(depths), max(depths)] if depths else None,
        "max_skid_m": max(skids, default=None),
        "contact_order": ", ".join(f"{leg} ({touched[leg] - first:.3f} s)" for leg in order) or None,
        "final_attitude_deg": summary["final_attitude_deg"],
    }


def markdown(title: str, summary: Mapping[str, Any], comparison: Mapping[str, Any], references: References) -> str:
    """`comparison.md`: the table of strokes in cm with the distances to every column, then the other observables."""
    chosen = comparison["chosen"]
    columns = list(references.strokes)
    names = ["**this run**" if c is None else _title(references, c, chosen) for c in [None, *columns]]
    lines = [f"# {title}: beside the published results", "", "Crush strokes, cm.", "", _row(["Strut", *names]), _rule(len(names) + 1)]
    for strut, ours in summary["strokes_m"].items():
        theirs = comparison["strokes_m"][strut]
        lines.append(_row([strut, _cm(ours), *(_cm(theirs[c]) for c in columns)]))
    distances, among = comparison["rms_m"], comparison["rms_to_measured_m"]
    if columns:
        lines.append(_row(["RMS to this run", "", *(_cm(distances[c]) for c in columns)]))
        lines.append(_row([f"RMS to {references.titles[columns[0]]}", _cm(distances[columns[0]]), *(_cm(among.get(c)) for c in columns)]))
    lines += ["", f"Source: {references.source}. Where a column has no number a strut is left out of its RMS.", ""]
    return "\n".join([*lines, *_observable_lines(comparison, references)]) + "\n"


def _observable_lines(comparison: Mapping[str, Any], references: References) -> list[str]:
    """The second table: penetration, skid, order of contact, attitude."""
    found = comparison["observables"]
    ours, published, measured = found["ours"], found["published"], found["measured"]
    title = references.titles.get(comparison["chosen"] or "", "published")
    lines = [_row(["", "**this run**", title, "measured"]), _rule(4)]
    lines.append(_row(["penetration, cm", *(_range(section.get("penetration_range_m")) for section in (ours, published, measured))]))
    lines.append(_row(["largest skid, cm", *(_cm(section.get("max_skid_m")) for section in (ours, published, measured))]))
    lines.append(_row(["order of contact", *(section.get("contact_order") or "–" for section in (ours, published, measured))]))
    lines.append(_row(["final attitude, deg", *(_angles(section.get("final_attitude_deg")) for section in (ours, published, measured))]))
    sources = [section["source"] for section in (published, measured) if "source" in section]
    return [*lines, "", "Sources: " + "; ".join(sources) + "."] if sources else lines


def _title(references: References, column: str, chosen: str | None) -> str:
    title = references.titles[column]
    return f"**{title}**" if column == chosen else title


def _row(cells: list[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def _rule(width: int) -> str:
    return _row(["---", *["---:"] * (width - 1)])


def _cm(metres: float | None) -> str:
    return "–" if metres is None else f"{metres * 100:.2f}"


def _range(pair: list[float] | None) -> str:
    return "–" if not pair else f"{pair[0] * 100:.2f} to {pair[1] * 100:.2f}"


def _angles(angles: Mapping[str, float | None] | None) -> str:
    if not angles:
        return "–"
    return ", ".join(f"{name} {value:+.1f}" for name, value in angles.items() if value is not None) or "–"
