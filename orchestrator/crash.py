"""A unit that crashes this process: its last moment is used to say who it was, and to write what there is.

The handler runs in the thread that crashed, in the middle of foreign code, and never returns. Where even that fails (a stack that is full,
a heap in pieces), the process ends without a word, as it would have: a unit with `isolate = true` cannot do that either.
"""

from __future__ import annotations

import ctypes
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

SIGNALS = (signal.SIGSEGV, signal.SIGABRT, signal.SIGFPE, signal.SIGILL)
_PATIENCE = 120
"""s after which a handler that is stuck is ended. Writing a result has taken more than 20 s where every import was compiled anew."""


@contextmanager
def last_words(say: Callable[[str], None]) -> Iterator[None]:
    """`say` is told the signal's name and has to leave the process."""
    if sys.platform == "win32":
        yield
        return
    libc = ctypes.CDLL(None)
    libc.signal.restype, libc.signal.argtypes = ctypes.c_void_p, (ctypes.c_int, ctypes.c_void_p)

    def crashed(number: int) -> None:
        libc.alarm(_PATIENCE)
        for each in SIGNALS:
            libc.signal(each, None)
        say(signal.Signals(number).name)

    handler = ctypes.CFUNCTYPE(None, ctypes.c_int)(crashed)
    caught = []
    for each in SIGNALS:
        if before := libc.signal(each, ctypes.cast(handler, ctypes.c_void_p)):
            libc.signal(each, before)  # a runtime inside a unit (Java, .NET) lives by its own
        else:
            caught.append(each)
    try:
        yield
    finally:
        for each in caught:
            libc.signal(each, None)
