"""What an object remembers, taken out and put back: its class names the attributes in MEMORY.

An attribute that is an object with a MEMORY of its own is followed; arrays and plain values are copied. Names are paths from
the top: "recorder.rows". Properties take part with their setters, and what is named first is put back first, so that a setter can
make what the later ones fill.
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
    _recall(owner, "", memory)
    return memory


def adopt(owner: Any, memory: Memory) -> None:
    """Put it back. Arrays are overwritten in place, because others may look at them; a property sets itself."""
    _adopt(owner, "", memory)


def _recall(owner: Any, prefix: str, memory: Memory) -> None:
    for name in owner.MEMORY:
        value = getattr(owner, name)
        if hasattr(value, "MEMORY"):
            _recall(value, f"{prefix}{name}.", memory)
        elif isinstance(value, np.ndarray):
            memory.arrays[prefix + name] = value.copy()
        else:
            memory.plain[prefix + name] = copy.copy(value)


def _adopt(owner: Any, prefix: str, memory: Memory) -> None:
    for name in owner.MEMORY:
        present, path = getattr(owner, name), prefix + name
        if hasattr(present, "MEMORY"):
            _adopt(present, f"{path}.", memory)
        elif path in memory.plain:
            setattr(owner, name, copy.copy(memory.plain[path]))
        elif isinstance(getattr(type(owner), name, None), property):
            setattr(owner, name, memory.arrays[path])
        else:
            present[...] = memory.arrays[path]
