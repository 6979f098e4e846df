"""Quasi-Newton for z = g(z) at the end of an interval, with the Jacobian kept from one interval to the next.

    z ← z + (1 − G)⁻¹ (g(z) − z),   [G; M] ← [G; M] + ([Δg; Δm] − [G; M] Δz) Δz⁺      (Δz⁺: pseudo-inverse)

Δz, Δg, Δm are the differences between the iterates of this interval; in one dimension that is the secant. z are values at the interface,
g what the units answer to them, m the motion that results; M measures z in metres per second. Known as IQN-IMVJ: Bogaers, Kok, Reddy and
Franz (2014), Comput. Methods Appl. Mech. Eng. 279, 113.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
_NEW = 0.3
"""A correction of which more than this share points where no iterate ever differed cannot be weighed by M."""


class InterfaceNewton:
    """Knows numbers only. `nominal` gives each z a least size; larger values of accepted instants (`note`) replace it.

    Iterates do not: one that shot away would loosen what is asked of all later ones. What they met serves the present attempt's learning.
    """

    def __init__(self, nominal: Vector, motions: int) -> None:
        self.size = len(nominal)
        self._scale = nominal.copy()
        self._met, self._latest = nominal.copy(), np.zeros(len(nominal))
        self._kept = np.zeros((self.size + motions, self.size))
        self._kept_interval = 1.0
        self._explored = np.zeros((self.size, self.size))
        self._directions = 0
        self._now = self._kept

    def note(self, z: Vector) -> None:
        """z at an accepted instant."""
        np.maximum(self._scale, np.abs(z), out=self._scale)

    def begin(self, interval: float) -> None:
        """A new attempt. Answers grow with the interval, to first order: so do G and M."""
        self._base = self._kept * (interval / self._kept_interval)
        self._now = self._base
        self._interval = interval
        self._met = self._scale.copy()
        self._z: list[Vector] = []
        self._answers: list[Vector] = []

    def correct(self, z: Vector, g: Vector, motion: Vector) -> Vector:
        """What to add to z, having learnt what it led to."""
        self._latest = np.abs(g)
        np.maximum(self._met, self._latest, out=self._met)
        answer = np.concatenate([g, motion])
        if self._z and not np.array_equal(z, self._z[-1]):
            self._learn(z, answer)
        self._z.append(z.copy())
        self._answers.append(answer)
        if self.size == 1:
            rest = 1.0 - float(self._now[0, 0])
            return (g - z) / rest if rest else g - z
        try:
            return np.asarray(np.linalg.solve(np.eye(self.size) - self._now[: self.size], g - z))
        except np.linalg.LinAlgError:
            return g - z

    def keep(self) -> None:
        """What was learnt in this attempt serves the next."""
        self._kept, self._kept_interval = self._now, self._interval

    def motion(self, change: Vector) -> Vector:
        """How far a change of z moves the units."""
        return np.asarray(self._now[self.size :] @ change)

    def share(self, change: Vector) -> float:
        """The largest change, as a share of the largest value at any accepted instant, or of the present answer."""
        return float(np.max(np.abs(change) / np.maximum(self._scale, self._latest)))

    def can_weigh(self, change: Vector) -> bool:
        """Whether M knows the direction of this change."""
        if self._directions == self.size:
            return True
        scaled = change / self._met
        rest = scaled - self._explored @ (self._explored.T @ scaled)
        return bool(rest @ rest <= _NEW**2 * (scaled @ scaled))

    def _learn(self, z: Vector, answer: Vector) -> None:
        """Least change of [G; M] that explains all differences of this interval, in z measured by its scale."""
        steps = np.array([(z - old) / self._met for old in self._z]).T
        rises = np.array([answer - old for old in self._answers]).T
        self._explore(steps[:, -1])
        scaled_base = self._base * self._met
        missing = rises - scaled_base @ steps
        if steps.shape[1] == 1:
            step = steps[:, 0]
            update = np.outer(missing[:, 0], step) / (step @ step)
        elif self.size == 1:
            update = missing[:, -1:] / steps[0, -1]
        else:
            update = missing @ np.linalg.pinv(steps, rcond=1e-6)
        self._now = (scaled_base + update) / self._met

    def _explore(self, step: Vector) -> None:
        if self._directions == self.size:
            return
        rest = step - self._explored @ (self._explored.T @ step)
        length = float(np.linalg.norm(rest))
        if length > _NEW * float(np.linalg.norm(step)):
            self._explored[:, self._directions] = rest / length
            self._directions += 1

    @property
    def memory(self) -> Vector:
        """What passes from one interval to the next, for checkpoints."""
        head = np.array([self._kept_interval, float(self._directions)])
        return np.concatenate([head, self._scale, self._explored.ravel(), self._kept.ravel()])

    @memory.setter
    def memory(self, values: Vector) -> None:
        n, at = self.size, 2
        self._kept_interval, self._directions = float(values[0]), int(values[1])
        self._scale, at = values[at : at + n].copy(), at + n
        self._explored, at = values[at : at + n * n].reshape(n, n).copy(), at + n * n
        self._kept = values[at:].reshape(-1, n).copy()
