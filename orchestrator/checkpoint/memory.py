"""What an object remembers, taken out and put back: its class names the attributes in MEMORY.

An attribute that is an object with a MEMORY of its own is followed; arrays and plain values are copied. Names are paths from
the top: "recorder.rows".
"""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass
class Memory:
    plain: dict[str, Any] = field(default_factory=dict)
    """Numbers, texts, lists of these: what JSON knows."""
    arrays: dict[str, NDArray[Any]] = field(default_factory=dict)


def recall(owner: Any) -> Memory:
    """A copy of everything the object remembers."""
    memory = Memory()
    for path, holder, name in _places(owner, ""):
        value = getattr(holder, name)
        if isinstance(value, np.ndarray):
            memory.arrays[path] = value.copy()
        else:
            memory.plain[path] = copy.deepcopy(value)
    return memory


def adopt(owner: Any, memory: Memory) -> None:
    """Put it back. Arrays are overwritten in place, because others may look at them; a property sets itself."""
    for path, holder, name in _places(owner, ""):
        if path not in memory.arrays:
            setattr(holder, name, copy.deepcopy(memory.plain[path]))
        elif isinstance(getattr(type(holder), name, None), property):
            setattr(holder, name, memory.arrays[path])
        else:
            getattr(holder, name)[...] = memory.arrays[path]


def _places(owner: Any, prefix: str) -> list[tuple[str, Any, str]]:
    """(path, object, attribute) of everything remembered."""
    found = []
    for name in owner.MEMORY:
        value = getattr(owner, name)
        if hasattr(value, "MEMORY"):
            found += _places(value, f"{prefix}{name}.")
        else:
            found.append((f"{prefix}{name}", owner, name))
    return found
