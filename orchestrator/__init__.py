"""What runs around FMUs: scenario, master, results, command line."""
