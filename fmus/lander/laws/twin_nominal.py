"""A nominal run of the twin, kept so that runs of values a little different can be flown beside it.

A run beside takes the nominal's steps, begins each stage at what solved the nominal's and corrects it with the nominal's inverted Newton
matrix, so that a stage costs two evaluations where a run of its own costs four and three eliminations. More than that: two runs that choose
their own steps differ by what the integrator leaves to chance, and a difference of them is worth no more than that over its length; runs of
the same steps differ by the values alone. This is internal numerical differentiation (Bock 1983; Hairer, Norsett, Wanner, Solving ODEs I,
II.6). Where a run beside leaves the nominal too far it is on its own, as finely as any.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .compiled import jit
from .linear import put, solve_many
from .twin import GYRATION, Flight, Newton, Stage, Trial, Vehicle, leg_blocks, missing_at, trial_at
from .vectors import identity, plus, product, times, transpose

Array = NDArray[np.float64]
ALONE, KEPT, BESIDE = 0, 1, 2  # modes
ROOM = 2000  # steps kept of a run; past them a run beside is on its own
SAME = 1e-11  # s: instants nearer than this are one
CORRECTIONS = 6  # of a stage beside before it is solved on its own
SLOW = 0.25  # of the last correction's weighted square: one that is larger does not converge
LEAST, FORGETS = 1e-12, 0.8  # of shares: the smallest believed, and the power by which it is believed less a stage later
LENIENT = 4.0  # times the tolerance that the nominal's steps may leave beside it


class Nominal(NamedTuple):
    """Steps of a run in order. Row and column 6 i + j: unknown j of the body (i = 0) and of leg i."""

    use: NDArray[np.int64]  # (2,): mode, steps kept
    share: Array  # (1,): of a correction's weighted square that the next one had, in the last stage beside
    begun: Array  # (m,) s
    steps: Array  # (m,) s
    solved: Array  # (m, 2, n + 1, 6): the accelerations of both stages
    inverse: NDArray[np.float32]  # (m, 2, 6 n + 6, 6 n + 6): of Newton's matrices there, transposed


class Ahead(NamedTuple):
    """The nominal's step that an instant lies in."""

    place: int  # -1: none
    whole: bool  # the instant is its begin
    left: float  # s to its end


@jit
def nominal_room(legs: int, steps: int) -> Nominal:
    """Room for a run; for none with steps = 0."""
    size = 6 * (legs + 1)
    return Nominal(
        np.zeros(2, np.int64),
        np.ones(1),
        np.zeros(steps),
        np.zeros(steps),
        np.zeros((steps, 2, legs + 1, 6)),
        np.zeros((steps, 2, size, size), np.float32),
    )


@jit
def ahead_at(nominal: Nominal, now: float) -> Ahead:
    """Where the nominal was at an instant."""
    kept = nominal.use[1]
    k = int(np.searchsorted(nominal.begun[:kept], now + SAME)) - 1
    left = nominal.begun[k] + nominal.steps[k] - now if k >= 0 else 0.0
    if left <= SAME:
        return Ahead(-1, False, 0.0)
    return Ahead(k, abs(nominal.begun[k] - now) < SAME, left)


@jit
def guess_first(nominal: Nominal, place: int, a: Array, guess: Array) -> None:
    """The first stage of a step beside the nominal's: solved as there, and as far off as the last step's end; a: (n + 1, 6) there."""
    guess[:, :] = nominal.solved[place, 0]
    if place > 0 and abs(nominal.begun[place - 1] + nominal.steps[place - 1] - nominal.begun[place]) < SAME:
        guess += a - nominal.solved[place - 1, 1]


@jit(inner=True)
def keep_step(
    vehicle: Vehicle, nominal: Nominal, now: float, h: float, f: Flight, stages: tuple[Stage, Stage], one: Array, two: Array
) -> None:
    """Keep a step of h (s) from an instant with its two solved stages; what was kept from there on is forgotten."""
    kept = nominal.use[1]
    while kept > 0 and nominal.begun[kept - 1] > now - SAME:
        kept -= 1
    nominal.use[1] = kept
    if kept == nominal.steps.shape[0]:
        return
    nominal.begun[kept], nominal.steps[kept] = now, h
    nominal.solved[kept, 0], nominal.solved[kept, 1] = one, two
    invert(vehicle, trial_at(vehicle, f, stages[0], one), stages[0].h, nominal.inverse[kept, 0])
    invert(vehicle, trial_at(vehicle, f, stages[1], two), stages[1].h, nominal.inverse[kept, 1])
    nominal.use[1] = kept + 1


@jit(inner=True)
def invert(vehicle: Vehicle, at: Trial, h: float, inverse: NDArray[np.float32]) -> None:
    """Newton's matrix at a trial (`twin.eliminate` has its blocks), inverted, transposed."""
    n = len(vehicle.legs)
    size = 6 * (n + 1)
    m, unit, r = np.zeros((size, size)), np.eye(size), at.body.turned
    put(m, 0, 0, identity(vehicle.body.mass))
    put(m, 3, 3, product(r, product(vehicle.body.inertia, transpose(r))))
    for i in range(n):
        b, k = leg_blocks(vehicle.legs[i], at.body, at.legs[i], h), 6 * (i + 1)
        back = times(-1.0, b.arm)
        k_back = product(b.k_xx, back)
        put(m, k, k, plus(b.mass, b.k_xx))
        put(m, k, k + 3, b.k_xr)
        put(m, k + 3, k, b.k_rx)
        put(m, k + 3, k + 3, b.k_rr)
        put(m, k, 0, plus(b.straight, b.k_xx))
        put(m, k, 3, plus(b.spinning, k_back))
        put(m, k + 3, 0, b.k_rx)
        put(m, k + 3, 3, product(b.k_rx, back))
        put(m, 0, 0, b.k_xx)
        put(m, 0, 3, k_back)
        put(m, 3, 0, product(b.arm, b.k_xx))
        put(m, 3, 3, product(b.arm, k_back))
        put(m, 0, k, plus(b.k_xx, transpose(b.straight)))
        put(m, 0, k + 3, b.k_xr)
        put(m, 3, k, plus(product(b.arm, b.k_xx), transpose(b.spinning)))
        put(m, 3, k + 3, product(b.arm, b.k_xr))
    if solve_many(m, unit):
        inverse[:, :] = unit.T
    else:
        inverse[:, :] = np.nan  # a run beside then finds that nothing converges, and is on its own


@jit(inner=True)
def stage_beside(
    vehicle: Vehicle, newton: Newton, start: Flight, given: Stage, a: Array, inverse: NDArray[np.float32], share: Array
) -> tuple[bool, Array]:
    """`twin.stage` by the nominal's inverse from the guess in a (n + 1, 6): whether the corrections converged, and the powers.

    Corrections fall by one share each: what the last one leaves is known before it is looked at, after a first one by the share of the
    stage before (Hairer, Wanner, Solving ODEs II, IV.8).
    """
    n = a.shape[0]
    missing, step, power = np.zeros(6 * n), np.zeros(6 * n), np.zeros((n, 4))
    before, bound = 1e300, newton.tolerance * newton.tolerance
    falls = max(share[0], LEAST) ** FORGETS
    for k in range(CORRECTIONS):
        missing_at(vehicle, start, given, a, missing, power)
        step[:] = 0.0
        for j in range(6 * n):
            for i in range(6 * n):
                step[i] += inverse[j, i] * missing[j]
        size = 0.0
        for i in range(n):
            for j in range(6):
                a[i, j] += step[6 * i + j]
                size += ((1.0 if j < 3 else GYRATION) * step[6 * i + j]) ** 2
        size *= given.h * given.h
        if not size < SLOW * before:
            break
        if k > 0:
            falls = size / before
        if size < bound or size * falls < bound:
            share[0] = falls
            return True, power
        before = size
    share[0] = 1.0
    return False, power
