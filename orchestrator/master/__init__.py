"""The master: it steps units that know nothing of each other, judges each step and undoes what it rejects."""
