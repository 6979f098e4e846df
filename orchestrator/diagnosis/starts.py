"""Start values as numbers."""

from __future__ import annotations


def number_of(start: object) -> float:
    """A start value as a model description or a scenario writes it; 0 where there is none."""
    text = str(start or 0.0).lower()
    return float({"true": "1", "false": "0"}.get(text, text))
