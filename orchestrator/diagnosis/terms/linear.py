"""What the slopes at one point promise: every term's ln evidence beside the nuisances, all at once.

With J the white slopes of the nuisances, g a term's, r the residual and z the nuisances there, the nuisances are projected out by
Λ = 1 - J (J'J + 1)^-1 J'. A term of prior N(0, 1) then gains b²/(2 (1 + λ)) - ln(1 + λ)/2 over the nuisances alone, where
λ = g'Λ g is its signature energy and b = g'r - g'J (J'J + 1)^-1 (J'r - z); its estimate is b/(1 + λ).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.problem import Landings, Model, Nobody

Array = NDArray[np.float64]


@dataclass
class View:
    """A point of the nuisances without any effect: prediction, slopes of the nuisances, slopes of the terms by name."""

    z: Array
    predicted: Array
    slopes: Array
    columns: dict[str, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class White:
    """A view as the present noise sees it."""

    names: tuple[str, ...]
    jacobian: Array
    columns: Array
    residual: Array
    z: Array


@dataclass(frozen=True)
class Linear:
    """By term: ln evidence (less the constant that all hypotheses share), z of the coefficient, λ."""

    evidence: Array
    estimate: Array
    energy: Array
    null: float
    """ln evidence of the nuisances alone."""


def whitened(landings: Landings, nuisances: Sequence[Coordinate], view: View) -> White:
    model = Model(landings, nuisances, Nobody())
    names = tuple(view.columns)
    columns = np.column_stack([view.columns[n] for n in names]) if names else np.zeros((len(view.predicted), 0))
    jacobian = model.whitened(view.slopes, view.predicted)
    return White(names, jacobian, model.whitened(columns, view.predicted), model.residual(view.predicted), view.z)


def linear(white: White) -> Linear:
    """The formulas above."""
    return linear_of(white, white.residual)


def linear_of(white: White, residual: Array) -> Linear:
    """The same for another residual: of a bootstrap."""
    jacobian, columns, z = white.jacobian, white.columns, white.z
    hessian = jacobian.T @ jacobian + np.eye(len(z))
    slope = jacobian.T @ residual - z
    shared = jacobian.T @ columns
    absorbed = np.linalg.solve(hessian, np.column_stack([slope, shared]))
    energy = np.maximum(np.square(columns).sum(axis=0) - (shared * absorbed[:, 1:]).sum(axis=0), 0.0)
    pull = columns.T @ residual - shared.T @ absorbed[:, 0]
    null = -0.5 * float(residual @ residual + z @ z) + 0.5 * float(slope @ absorbed[:, 0]) - 0.5 * float(np.linalg.slogdet(hessian)[1])
    gain = 0.5 * np.square(pull) / (1.0 + energy) - 0.5 * np.log1p(energy)
    return Linear(null + gain, pull / (1.0 + energy), energy, null)


def explained(white: White, place: int) -> Array:
    """The white signal that nuisances and one term together make of the residual."""
    both = np.column_stack([white.jacobian, white.columns[:, place]])
    z = np.concatenate([white.z, [0.0]])
    return np.asarray(both @ np.linalg.solve(both.T @ both + np.eye(len(z)), both.T @ white.residual - z))


def port_evidence(evidence: Mapping[str, float], ports: Mapping[str, str]) -> dict[str, float]:
    """ln evidence of a port: the mean over its terms of their evidences, so that no port gains by having more terms; highest first."""
    found: dict[str, list[float]] = {}
    for name, value in evidence.items():
        found.setdefault(ports[name], []).append(value)
    total = {port: float(np.logaddexp.reduce(values) - np.log(len(values))) for port, values in found.items()}
    return dict(sorted(total.items(), key=lambda pair: -pair[1]))
