"""`orchestrator` and `python -m orchestrator`: before anything slow is imported, so that Ctrl-C is answered then too."""

from __future__ import annotations

import os
import signal
from typing import Any

from orchestrator.errors import EXIT_INTERRUPTED


def main() -> None:
    """The command line; see orchestrator.cli."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:   # a job in the background ignores it
        signal.signal(signal.SIGINT, _nothing_yet)
    from orchestrator.cli import main as commands

    if signal.getsignal(signal.SIGINT) is _nothing_yet:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    commands()


def _nothing_yet(*_: Any) -> None:
    """As a KeyboardInterrupt it would be whatever the module that is being imported makes of it."""
    os.write(2, b"interrupted: nothing was computed\n")
    os._exit(EXIT_INTERRUPTED)


if __name__ == "__main__":
    main()
