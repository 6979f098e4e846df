"""A random generator that starts alike in every test."""

import numpy as np
import pytest


@pytest.fixture
def random() -> np.random.Generator:
    """Seeded, so that a failure can be repeated."""
    return np.random.default_rng(1969)
