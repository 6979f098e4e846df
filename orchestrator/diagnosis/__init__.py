"""Where simulation and measured data disagree, which effect is missing, and what the scenario gains by it."""
