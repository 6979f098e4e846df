"""FMI lives here and nowhere else in the orchestrator."""
