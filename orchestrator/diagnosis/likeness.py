"""Signatures of effects and how alike they are, nuisances taken out: numbers only, no landings.

A signature is the change of the white prediction by one prior sigma of an effect along one direction of its parameters. Two signatures
a and b are compared in the metric of what nuisances with their priors leave, a'(1 + JJ')⁻¹b: λ = |a|², cosine = a·b/(|a||b|).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.linalg import null_space
from scipy.spatial.distance import squareform

from orchestrator.diagnosis.report.distinction import ENOUGH
from orchestrator.diagnosis.signatures import UNSEEN, projected

Array = NDArray[np.float64]
ALIKE = 0.8
"""Cosine from which two effects cannot be told apart at λ = 25: the other one leaves 25 (1 - 0.8²) = 9 of it, three standard deviations."""
SIZES = (0.02, 1.0)  # z of the smallest signature flown and of the widest


@dataclass(frozen=True)
class Flown:
    """What was flown of an effect, white."""

    name: str
    slopes: Array
    """(n, m): at its null, one column a parameter, per unit of z."""
    changes: Array
    """(n, k): from its null to each of its starts, and to where it just shows."""
    starts: Array
    """(k, m): their z."""
    one_sided: bool = False
    """Whether every parameter has one sign only."""

    def part(self, rows: Array) -> Flown:
        return Flown(self.name, self.slopes[rows], self.changes[rows], self.starts, self.one_sided)

    @property
    def sizing(self) -> NDArray[np.bool_]:
        """Parameters that say how large the effect is; the others (when, how deep) mean nothing at its null, where their slopes are 0."""
        felt = np.asarray(self.slopes.any(axis=0))
        return felt if felt.any() else np.ones(len(felt), dtype=bool)


@dataclass(frozen=True)
class Signature:
    """An effect as the data would see it."""

    name: str
    energy: float
    """λ at one prior sigma, σ²."""
    shows: float
    """|z| at which λ = ENOUGH."""
    direction: Array
    """Of the parameters, |direction| = 1."""
    visible: Array
    """(n,): the column at the size whose λ is nearest ENOUGH."""
    span: Array
    """(n, m): all that the effect can do there: the visible column, and its slopes in the directions across."""
    one_sided: bool = False


def signature(flown: Flown, jacobian: Array) -> Signature:
    """Of all sizes flown, the one whose λ is nearest ENOUGH says how the effect looks when it just shows, the one nearest |z| = 1 its λ."""
    candidates = _candidates(flown, jacobian)
    if not candidates:
        none = np.zeros(flown.slopes.shape[0])
        return Signature(flown.name, 0.0, np.inf, np.eye(flown.slopes.shape[1])[0], none, none[:, None], flown.one_sided)
    lambdas = [float(projected(jacobian, column[:, None])[0, 0]) for _, _, column in candidates]
    sizes = [size for size, _, _ in candidates]
    near_one = int(np.argmin([abs(np.log(size)) for size in sizes]))
    shows = int(np.argmin([abs(np.log(max(x, 1e-12) * size * size / ENOUGH)) for x, size in zip(lambdas, sizes, strict=True)]))
    several = flown.slopes.shape[1] > 1
    energy = max(lambdas) if several else lambdas[near_one]
    _, direction, visible = candidates[shows]
    span = np.column_stack([visible, flown.slopes @ null_space(direction[None, :])])
    shown = float(np.sqrt(ENOUGH / lambdas[shows])) if lambdas[shows] > 0.0 else np.inf
    return Signature(flown.name, energy, shown, direction, visible, span, flown.one_sided)


def just_shows(slopes: Array, jacobian: Array, one_sided: bool) -> Array | None:
    """z (m,) in the most visible direction, where λ = ENOUGH by the slopes at the null; None where nothing is felt there.

    To be flown: soil damping's slope at its null has a cosine of 0.44 with momentum transfer as that just shows, the two as they
    both just show one of 0.91.
    """
    energies, directions = np.linalg.eigh(projected(jacobian, slopes))
    if energies[-1] <= 0.0:
        return None
    direction = np.abs(directions[:, -1]) if one_sided else directions[:, -1]
    return direction * float(np.clip(np.sqrt(ENOUGH / energies[-1]), *SIZES))


def _candidates(flown: Flown, jacobian: Array) -> list[tuple[float, Array, Array]]:
    """(|z|, direction, column) of all that was flown; of the slopes at the null where none of it can be."""
    starts = np.where(flown.sizing, flown.starts, 0.0)
    sizes = np.linalg.norm(starts, axis=1)
    found = [(float(s), z / s, flown.changes[:, k] / s) for k, (s, z) in enumerate(zip(sizes, starts, strict=True)) if s > 0.0]
    found = [one for one in found if np.isfinite(one[2]).all() and one[2].any()]
    small = None if found else just_shows(flown.slopes, jacobian, flown.one_sided)
    if small is not None:
        size = float(np.linalg.norm(small))
        found.append((size, small / size, flown.slopes @ small / size))
    return found


def cosines(signatures: Sequence[Signature], jacobian: Array) -> Array:
    """How much of one effect's visible signature the other can imitate, the larger of both ways; sign where both have one parameter.

    cos(a, B) = sqrt(a'P_B a / a'a). Two effects of one sign each that pull opposite ways are not alike: 0.
    """
    widths = np.cumsum([0, *(1 + s.span.shape[1] for s in signatures)])
    gram = projected(jacobian, np.column_stack([np.column_stack([s.visible, s.span]) for s in signatures]))
    found = np.eye(len(signatures))
    for i in range(len(signatures)):
        for j in range(i):
            a, b = int(widths[i]), int(widths[j])
            both = (a, slice(a + 1, int(widths[i + 1]))), (b, slice(b + 1, int(widths[j + 1])))
            found[i, j] = found[j, i] = _cosine(gram, *both, signatures[i].one_sided and signatures[j].one_sided)
    return found


def _cosine(gram: Array, first: tuple[int, slice], second: tuple[int, slice], one_sided: bool) -> float:
    (a, span_a), (b, span_b) = first, second
    plain = float(gram[a, b])
    if gram[a, a] <= 0.0 or gram[b, b] <= 0.0 or (one_sided and plain <= 0.0):
        return 0.0
    size = max(_imitated(gram, a, span_b), _imitated(gram, b, span_a))
    return float(np.copysign(min(size, 1.0), plain))


def _imitated(gram: Array, a: int, span: slice) -> float:
    inside, across = gram[span, span], gram[span, a]
    return float(np.sqrt(max(across @ np.linalg.pinv(inside, rcond=1e-6, hermitian=True) @ across, 0.0) / gram[a, a]))


def groups(names: Sequence[str], cosine: Array, energies: Sequence[float]) -> list[list[str]]:
    """Effects that cannot be told apart, by average linkage; those that hardly show (λ < UNSEEN) are in none."""
    shown = [i for i, energy in enumerate(energies) if energy >= UNSEEN]
    if len(shown) < 2:
        return []
    distance = np.clip(1.0 - np.abs(cosine[np.ix_(shown, shown)]), 0.0, 1.0)
    np.fill_diagonal(distance, 0.0)
    label = fcluster(linkage(squareform(distance, checks=False), "average"), 1.0 - ALIKE + 1e-9, "distance")
    found = [[names[i] for i, mine in zip(shown, label.tolist(), strict=True) if mine == one] for one in sorted(set(label.tolist()))]
    return [group for group in found if len(group) > 1]
