"""Units: one file an FMU."""
