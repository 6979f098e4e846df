"""Compiled and plain Python are the same laws."""

import json
import os
import subprocess
import sys
from pathlib import Path

import plain_run
import pytest
from lander.laws.compiled import COMPILED


@pytest.mark.skipif(not COMPILED, reason="numba is not here: nothing to compare with")
def test_compiled_and_plain_python_agree() -> None:
    """Verifies: numba changes nothing, not a bit.
    Setup: leg (10 ms), soil (20 ms), twin (30 ms) here, compiled, and in a process with LANDER_PLAIN_PYTHON=1: 350 numbers.
    Tolerance: none: no fused operations, no reordering, and the same library functions.
    """
    script = Path(__file__).with_name("plain_run.py")
    environment = {**os.environ, "LANDER_PLAIN_PYTHON": "1"}
    run = subprocess.run([sys.executable, str(script)], env=environment, capture_output=True, text=True, check=True, timeout=300)
    plain, compiled = json.loads(run.stdout), plain_run.results()
    for name, ours in compiled.items():
        different = [(i, a, b) for i, (a, b) in enumerate(zip(ours, plain[name], strict=True)) if a != b]
        assert not different, f"{name}: compiled and plain differ at {different[:3]}"
