"""A unit that does not come back from a call. In one process a hung C call cannot be ended: someone else must say so and leave."""

from __future__ import annotations

import threading
from collections.abc import Callable
from time import monotonic

OnHang = Callable[[str], None]
"""Called from the watchdog's own thread while the unit still hangs; it writes out what there is and leaves the process."""


class Watchdog:
    """Two assignments a call; a thread looks at them a few times per timeout. Without `on_hang` nothing is watched."""

    def __init__(self, timeout: float) -> None:
        """s of wall time; 0: wait for ever."""
        self._timeout = timeout
        self.on_hang: OnHang | None = None
        self.where: Callable[[], str] = str
        """What to add to the message: the time the run has reached."""
        self._unit = ""
        self.wall_time = 0.0
        """When the present call was made."""
        self._done = threading.Event()

    def enter(self, unit: str) -> None:
        self.wall_time = monotonic()
        self._unit = unit

    def leave(self) -> None:
        self._unit = ""

    def accused(self, signal: str) -> str:
        """After a crash of the process: who was in doStep, and when; empty where nobody was."""
        unit, self._unit = self._unit, ""
        what = f"crashed in doStep{self.where()} ({signal}); mend the unit, or give it isolate = true, a process of its own"
        return f"{unit}: {what}" if unit else ""

    def __enter__(self) -> Watchdog:
        self._done = threading.Event()
        if self._timeout > 0.0 and self.on_hang is not None:
            threading.Thread(target=self._watch, args=(self._done, self.on_hang), name="watchdog", daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._done.set()

    def _watch(self, done: threading.Event, on_hang: OnHang) -> None:
        while not done.wait(min(1.0, 0.25 * self._timeout)):
            unit, since = self._unit, self.wall_time
            if unit and monotonic() - since > self._timeout and self.wall_time == since:
                on_hang(
                    f"{unit}: has not come back from doStep{self.where()} for {self._timeout:g} s and is taken to hang;"
                    " raise master.step_timeout if it needs longer, or mend the unit"
                )
                return
