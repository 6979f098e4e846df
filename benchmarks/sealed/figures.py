"""The psychometric curve: what is answered against how much there is to see."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

from sealed.scoring import Score
from sealed.targets import CEILING
from sealed.wilson import wilson

BINS = (0.0, 18.0, 35.0, 70.0, 150.0, 1e9)
UNNAMED = ("set", "wrong set", "abstained", "refused", "nothing")
SHOWN = (("right name", ("right",), "#1a7f37", "o"), ("a set, or no name", UNNAMED, "#0b5394", "s"),
         ("wrong name", ("wrong",), "#c1272d", "v"))


def psychometric(scores: Sequence[Score], path: Path) -> None:
    """Single effects and twins, binned by λ, with Wilson's bounds and the information ceiling."""
    mine = [s for s in scores if s.energy > 0.0 and (s.kind.startswith("single") or s.kind == "twin")]
    groups = [[s for s in mine if low <= s.energy < high] for low, high in pairwise(BINS)]
    groups = [group for group in groups if group]
    figure, axis = plt.subplots(figsize=(6.5, 4.2), layout="constrained")
    axis.plot(*zip(*CEILING, strict=True), color="0.5", linestyle="--", label="a perfect judge, right name")
    for text, answers, colour, mark in SHOWN:
        for group in groups:
            hits = sum(s.answer in answers for s in group)
            share, (low, high) = hits / len(group), wilson(hits, len(group))
            middle = _middle([s.energy for s in group])
            axis.errorbar(middle, share, yerr=[[max(share - low, 0.0)], [max(high - share, 0.0)]], color=colour, marker=mark, capsize=3,
                          label=text if group is groups[0] else None)  # fmt: skip
    axis.set(xscale="log", xlabel="signature energy after nuisances λ, σ²", ylabel="share of cases", ylim=(-0.03, 1.03))
    axis.grid(visible=True, color="0.9", linewidth=0.6)
    axis.spines[["top", "right"]].set_visible(False)
    axis.legend(frameon=False, fontsize=8)
    figure.savefig(path, dpi=130)
    plt.close(figure)


def _middle(values: Sequence[float]) -> float:
    product = 1.0
    for value in values:
        product *= value ** (1.0 / len(values))
    return product
