"""How a leg's mean wrench on the body answers the body's motion: the leg eliminated, for Newton's step on the body's interface.

Over an interval h the ball joint's velocity relative to the body changes by y, the body's twist by β (6). The leg's equations, each term in
kg: A y + (M_b + C J) β = 0 with A = M + S + C, S = h D + h² K of the struts, C = h C_g + h² K_g of the ground, M_b the inertia
coupling and J = [1, -[p x]]. The body gets -Z β/h with Z = Jᵀ C J - (Jᵀ C + M_bᵀ) A⁻¹ (M_b + C J). With the pad stuck Z is the struts' own
impedance; with the pad free it takes the pad's mass away again, which the body carries as part of the rigid leg. B throughout.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .blocks import matrix, vector
from .compiled import jit
from .linear import put, solve_many
from .vectors import Matrix, Vector, plus, product, skew, times, transpose

Array = NDArray[np.float64]
NUMBERS = 66  # of a model: lever (3), then seven matrices


class MountModel(NamedTuple):
    """One leg about B's origin."""

    lever: Vector  # p, m
    mass: Matrix  # M, kg
    straight: Matrix  # M_b for pull, kg
    turning: Matrix  # M_b for angular acceleration, kg m
    stiffness: Matrix  # K, N/m
    damping: Matrix  # D, N s/m
    ground_stiffness: Matrix  # K_g, N/m
    ground_damping: Matrix  # C_g, N s/m


@jit
def read_mount(row: Array) -> MountModel:
    """A model from the numbers of a port."""
    return MountModel(
        vector(row, 0), matrix(row, 3), matrix(row, 12), matrix(row, 21), matrix(row, 30), matrix(row, 39), matrix(row, 48), matrix(row, 57)
    )


@jit
def impedance(model: MountModel, h: float, out: Array) -> None:
    """Z (6, 6), kg, kg m and kg m2, into out."""
    out[:, :] = 0.0
    ground = plus(times(h, model.ground_damping), times(h * h, model.ground_stiffness))
    struts = plus(times(h, model.damping), times(h * h, model.stiffness))
    arm = skew(model.lever)
    left, right = np.zeros((3, 3)), np.zeros((3, 6))
    put(left, 0, 0, plus(model.mass, plus(struts, ground)))
    first = plus(model.straight, ground)
    second = plus(model.turning, times(-1.0, product(ground, arm)))
    put(right, 0, 0, first)
    put(right, 0, 3, second)
    back = np.zeros((6, 3))
    put(back, 0, 0, plus(transpose(model.straight), ground))
    put(back, 3, 0, plus(transpose(model.turning), product(arm, ground)))
    if not solve_many(left, right):
        return
    put(out, 0, 0, ground)
    put(out, 0, 3, times(-1.0, product(ground, arm)))
    put(out, 3, 0, product(arm, ground))
    put(out, 3, 3, times(-1.0, product(arm, product(ground, arm))))
    for i in range(6):
        for j in range(6):
            for k in range(3):
                out[i, j] -= back[i, k] * right[k, j]


@jit
def corrections(models: Array, mass: float, inertia: Matrix, difference: Vector, turn: Vector, h: float) -> Array:
    """Change of each leg's mean wrench (n, 6), N and N m, when the body's twist differs from the one the wrenches answered.

    models      (n, NUMBERS), zero rows for ports without a model
    difference  of the velocity (m/s, B) and `turn` of the angular velocity (rad/s) with the wrenches uncorrected
    """
    n = models.shape[0]
    z = np.zeros((n, 6, 6))
    total, beta = np.zeros((6, 6)), np.zeros((6, 1))
    put(total, 0, 0, ((mass, 0.0, 0.0), (0.0, mass, 0.0), (0.0, 0.0, mass)))
    put(total, 3, 3, inertia)
    for i in range(3):
        beta[i, 0] = mass * difference[i]
        beta[3 + i, 0] = inertia[i][0] * turn[0] + inertia[i][1] * turn[1] + inertia[i][2] * turn[2]
    for k in range(n):
        if models[k, 3] > 0.0:
            impedance(read_mount(models[k]), h, z[k])
            total += z[k]
    wrenches = np.zeros((n, 6))
    if not solve_many(total, beta):
        return wrenches
    for k in range(n):
        for i in range(6):
            for j in range(6):
                wrenches[k, i] -= z[k, i, j] * beta[j, 0] / h
    return wrenches
