"""What `orchestrator distinguish` finds: which effects some data could show, which of them look alike, and what would part them."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import leaves_list, linkage
from scipy.spatial.distance import squareform

Array = NDArray[np.float64]
ENOUGH = 25.0
"""λ, σ²: below it the honest answer is a set, not a name (docs/diagnosis.md)."""


@dataclass
class EffectSeen:
    """One effect: the energy of its signature at one prior sigma, nuisances taken out, and the smallest value that would show."""

    name: str
    title: str
    lambda_: float
    """σ²."""
    detectable: float
    """Of `parameter`, the size at which λ reaches ENOUGH."""
    unit: str
    parameter: str = ""


@dataclass
class MoreSensor:
    """A channel not measured so far: with what σ, which groups it would part, which effects it would make visible."""

    channel: str
    sigma: float
    unit: str
    splits: list[list[str]] = field(default_factory=list)
    """What becomes of each group that falls apart; names that stay together are one entry, "a + b"."""
    reveals: list[str] = field(default_factory=list)


@dataclass
class Distinction:
    """The table behind distinguish.html and distinguish.json. `cosine[i, j]`: of the signatures of effects i and j after nuisances."""

    scenario: str
    measured: list[str]
    effects: list[EffectSeen]
    cosine: Array
    groups: list[list[str]] = field(default_factory=list)
    """Names of effects that these data cannot tell apart; effects that stand alone are in none."""
    sensors: list[MoreSensor] = field(default_factory=list)
    simulations: int = 0
    seconds: float = 0.0

    @property
    def seen(self) -> list[EffectSeen]:
        """Those that would show at one prior sigma, the clearest first."""
        return sorted((e for e in self.effects if isfinite(e.lambda_) and e.lambda_ >= ENOUGH), key=lambda e: -e.lambda_)

    @property
    def unseen(self) -> list[EffectSeen]:
        """Those that would not, the nearest first."""
        others = [e for e in self.effects if e not in self.seen]
        return sorted(others, key=lambda e: -e.lambda_ if isfinite(e.lambda_) else np.inf)

    def title(self, name: str) -> str:
        """In words; of several that stay together ("a + b"), each."""
        titles = {e.name: e.title or e.name for e in self.effects}
        return " + ".join(titles.get(part, part) for part in name.split(" + "))

    def likeness(self) -> Array:
        """|cos|, symmetric, 1 on the diagonal, 0 where it is no number: the sign of an effect is free."""
        n = len(self.effects)
        matrix = np.nan_to_num(np.abs(np.asarray(self.cosine, dtype=np.float64).reshape(n, n)), nan=0.0, posinf=0.0)
        matrix = np.clip(np.maximum(matrix, matrix.T), 0.0, 1.0)
        np.fill_diagonal(matrix, 1.0)
        return np.asarray(matrix, dtype=np.float64)

    def order(self) -> list[int]:
        """Effects that look alike beside each other: leaves of an average linkage by 1 - |cos|."""
        if len(self.effects) < 3:
            return list(range(len(self.effects)))
        distance = squareform(1.0 - self.likeness(), checks=False)
        return [int(i) for i in leaves_list(linkage(distance, "average", optimal_ordering=True))]

    def write(self, folder: Path) -> Path:
        """distinguish.json; what is not a number becomes null."""
        tree: dict[str, Any] = asdict(self) | {"cosine": np.asarray(self.cosine).tolist()}
        for entry in tree["effects"]:
            entry["lambda"] = entry.pop("lambda_")
        path = folder / "distinguish.json"
        path.write_text(json.dumps(_finite(tree), indent=1, ensure_ascii=False) + "\n", "utf-8")
        return path


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not isfinite(value) else value
