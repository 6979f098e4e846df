"""What runs inside an FMU: laws, shell, units."""
