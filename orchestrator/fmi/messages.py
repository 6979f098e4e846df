"""What a unit logs, kept so that its own words reach the user's one line."""

from __future__ import annotations

import ctypes
from typing import Any
from weakref import WeakValueDictionary

from fmpy import calloc, free
from fmpy.fmi2 import (
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.logging import addLoggerProxy

_KEPT = 1000
_ERROR = 3
_LOGS: WeakValueDictionary[bytes, MessageLog] = WeakValueDictionary()


class MessageLog:
    """The last `_KEPT` messages of one instance."""

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self.messages: list[str] = []
        self.taken = 0
        self._worst = ""
        self.complaint = ""
        """The last message with status error since `forget`."""
        _LOGS[unit.encode()] = self

    def take(self, status: int, message: bytes) -> None:
        """One message of this instance."""
        text = " ".join((message or b"").decode("utf-8", "replace").split())
        if text:
            self.messages.append(text)
            self.taken += 1
            del self.messages[:-_KEPT]
            if status > 0:
                self._worst = text
            if status >= _ERROR:
                self.complaint = text

    def forget(self) -> None:
        """Before a new start: what went wrong at the last one does not count."""
        self.complaint = self._worst = ""
        self.messages.clear()

    def last(self) -> str:
        """The last thing worth telling: a warning or worse if there was one."""
        return self._worst or (self.messages[-1] if self.messages else "")


def fmi2_callbacks(log: MessageLog) -> Any:
    """For one instance of FMI 2.0.

    fmpy's logger proxy has one target for the whole process, the callback registered last: a message is handed on by the
    instance's name it carries.
    """

    def keep(_environment: Any, name: bytes, status: int, _category: bytes, message: bytes) -> None:
        _LOGS.get(name, log).take(status, message)

    callbacks: Any = fmi2CallbackFunctions()
    callbacks.logger = fmi2CallbackLoggerTYPE(keep)
    callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
    callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
    # C loggers are variadic; the proxy formats the message before Python sees it.
    addLoggerProxy(ctypes.byref(callbacks))
    return callbacks
