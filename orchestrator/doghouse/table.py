"""doghouse.md: the boundary landings as a table, for a document."""

from __future__ import annotations

from typing import Any

from orchestrator.doghouse.landing import BOUNDARIES, Inputs
from orchestrator.doghouse.outcome import Outcome, words

HEAD = "| boundary | horizontal, m/s | vertical, m/s | times certified | left | beyond | units: left, beyond | at rest | landing | where |"


def markdown(outcome: Outcome) -> str:
    """A row a boundary point: the last landing that held, what it had left, and what the first beyond it lacked."""
    points = outcome.as_dict()["boundaries"]
    rows = [_row(name, point) for name in BOUNDARIES for point in points[name]]
    return "\n".join([HEAD, "|---|" + "---:|" * 6 + "---|---|---|", *rows]) + "\n"


def _row(name: str, point: dict[str, Any]) -> str:
    unit, check = point["unit"], point["check"]
    separate = "–" if check is None else f"{_left(check['margin'], unit)}, {_left(check['beyond_margin'], unit)}"
    if check is not None and not check["agrees"]:
        separate = f"**{separate}**"
    cells = [
        name.replace("_", " "),
        f"{point['horizontal_m_s']:.3f}",
        f"{point['vertical_m_s']:.3f}",
        f"{point['times_certified']:.2f}",
        _left(point["margin"], unit),
        _left(point["beyond"]["margin"], unit),
        separate,
        "yes" if point["at_rest"] else "no",
        words(Inputs(**point["inputs"])),
        point["where"].replace(" | ", " and "),
    ]
    return "| " + " | ".join(cells) + " |"


def _left(margin: float | None, unit: str) -> str:
    if margin is None:
        return "not flown"
    return f"{margin:.1f} deg" if unit == "deg" else f"{margin * 1e3:.1f} mm"
