"""The evidence of the rivals, relative to nothing missing."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from orchestrator.diagnosis.outcome import Candidate
from orchestrator.diagnosis.report.numbers import chance, signed
from orchestrator.diagnosis.report.picture import AFTER, Picture, plain, sheet, shortened
from orchestrator.results.plot_style import FAINT, INK

MOST = 12


def ranked(candidates: Sequence[Candidate]) -> list[Candidate]:
    """By evidence, the largest first; those without a number last."""
    return sorted(candidates, key=lambda c: -c.log_evidence if np.isfinite(c.log_evidence) else np.inf)


def rivals_picture(candidates: Sequence[Candidate], named: Collection[str], name: str = "rivals") -> Picture | None:
    """Bars of ln evidence with probabilities; the named effects in colour."""
    best = [c for c in ranked(candidates) if np.isfinite(c.log_evidence)][:MOST]
    if not best:
        return None
    figure = sheet(0.55 + 0.25 * len(best))
    axes = figure.subplots()
    plain(axes, [shortened(c.title or c.name, 40) for c in best])
    axes.set_xlabel("ln evidence, relative to nothing missing", fontsize=9, color=INK)
    axes.axvline(0.0, color=INK, linewidth=0.8)
    for row, candidate in enumerate(best):
        colour = AFTER if candidate.name in named else FAINT
        axes.barh(row, candidate.log_evidence, height=0.62, color=colour, linewidth=0)
        right = max(candidate.log_evidence, 0.0)
        axes.annotate(
            signed(candidate.log_evidence), (right, row), (4, 0),
            textcoords="offset points", fontsize=8, color=INK, va="center", annotation_clip=False,
        )  # fmt: skip
        axes.annotate(
            chance(candidate.probability), (1.0, row), xycoords=("axes fraction", "data"), fontsize=8, color=INK, ha="right", va="center"
        )
    low, high = axes.get_xlim()
    axes.set_xlim(low, high + 0.3 * (high - low))
    told = "; ".join(f"{c.title or c.name} {signed(c.log_evidence)} ({chance(c.probability)})" for c in best[:5])
    more = f" The best {len(best)} of {len(candidates)}." if len(candidates) > len(best) else ""
    caption = f"Evidence of each candidate after a fit of its own, and its probability.{more}"
    return Picture(name, "Evidence of the candidates", figure, caption, f"Bars of log evidence relative to nothing missing. {told}.")
