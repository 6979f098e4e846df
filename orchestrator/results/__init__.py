"""What a run is turned into: tables, figures, a comparison with published numbers, and all that is needed to repeat it.

The scenario loader checks `[results]` with `orchestrator.results.schema.read`; that alone loads no plotting library.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import RenderableType

    from orchestrator.master.result import RunResult

__all__ = ["terminal_table", "write"]


def write(result: "RunResult", out: Path, figures: bool = True) -> dict[str, Any]:
    """Write everything the run has, complete or not, into `out` and return what summary.json holds; figures: the pictures, too."""
    from orchestrator.results import writer

    return writer.write(result, out, figures)


def terminal_table(summary: Mapping[str, Any]) -> "RenderableType":
    """The summary of `write` on one screen, for `rich.print`."""
    from orchestrator.results import terminal

    return terminal.terminal_table(summary)
