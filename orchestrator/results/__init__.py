"""What a run is turned into: tables, figures, a comparison with published numbers, and all that is needed to repeat it."""

from orchestrator.results.terminal import terminal_table
from orchestrator.results.writer import write

__all__ = ["terminal_table", "write"]
