"""Whether a value lies outside its bounds: one pass over the slots of a memory, at each step, so it is compiled."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..laws.compiled import COMPILED, jit

Floats = NDArray[np.float64]
Slots = NDArray[np.intp]
LARGEST = float(np.finfo(np.float64).max)  # a finite bound for all: neither infinity nor nan is within it


@jit
def first_outside_compiled(memory: Floats, slots: Slots, low: Floats, high: Floats) -> int:
    """The first slot whose value is not within [low, high] (nan is not), or -1."""
    for i in range(slots.size):
        value = memory[slots[i]]
        if not (low[i] <= value <= high[i]):
            return int(slots[i])
    return -1


def first_outside_plain(memory: Floats, slots: Slots, low: Floats, high: Floats) -> int:
    """The same in numpy, for a machine without numba."""
    values = memory[slots]
    outside = ~((values >= low) & (values <= high))
    return int(slots[outside.argmax()]) if outside.any() else -1


first_outside: Callable[[Floats, Slots, Floats, Floats], int] = first_outside_compiled if COMPILED else first_outside_plain
