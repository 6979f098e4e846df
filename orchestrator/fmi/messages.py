"""What a unit logs, kept so that its own words reach the user's one line."""

from __future__ import annotations

import ctypes
from typing import Any

from fmpy import calloc, free
from fmpy.fmi2 import (
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.logging import addLoggerProxy

_KEPT = 1000


class MessageLog:
    """Callbacks for one instance; the last `_KEPT` messages."""

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self.messages: list[str] = []
        self._worst = ""
        self.callbacks: Any = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(self._keep)
        self.callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
        self.callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        # C loggers are variadic; the proxy formats the message before Python sees it.
        addLoggerProxy(ctypes.byref(self.callbacks))

    def _keep(self, _environment: Any, _name: bytes, status: int, _category: bytes, message: bytes) -> None:
        text = " ".join((message or b"").decode("utf-8", "replace").split())
        if text:
            self.messages.append(text)
            del self.messages[:-_KEPT]
            if status > 0:
                self._worst = text

    def last(self) -> str:
        """The last thing worth telling: a warning or worse if there was one."""
        return self._worst or (self.messages[-1] if self.messages else "")
