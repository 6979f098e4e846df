"""Compiled and plain Python are the same laws."""

import json
import os
import subprocess
import sys
from pathlib import Path

import plain_run
import pytest
from lander.laws.compiled import COMPILED
from lander.laws.twin import CRUSH, crush_of
from lander.laws.twin_stepping import empty_flight


@pytest.mark.skipif(not COMPILED, reason="numba is not here: nothing to compare with")
def test_compiled_and_plain_python_agree() -> None:
    """Verifies: numba changes nothing, not a bit.
    Setup: leg (10 ms), soil (20 ms), twin (30 ms) here, compiled, and in a process with LANDER_PLAIN_PYTHON=1: 350 numbers.
    Tolerance: none: no fused operations, no reordering, and the same library functions.
    """
    script = Path(__file__).with_name("plain_run.py")
    environment = {**os.environ, "LANDER_PLAIN_PYTHON": "1"}
    run = subprocess.run([sys.executable, str(script)], env=environment, capture_output=True, text=True, check=True, timeout=1800)
    plain, compiled = json.loads(run.stdout), plain_run.results()
    for name, ours in compiled.items():
        different = [(i, a, b) for i, (a, b) in enumerate(zip(ours, plain[name], strict=True)) if a != b]
        assert not different, f"{name}: compiled and plain differ at {different[:3]}"


@pytest.mark.skipif(not COMPILED, reason="numba is not here: every law is plain Python")
def test_a_law_for_compiled_callers_alone_says_so_when_python_calls_it() -> None:
    """Verifies: an error, where numba would end the process; py_func is the law."""
    with pytest.raises(TypeError, match="crush_of is for compiled laws alone; its py_func is plain Python"):
        crush_of(None, 0)  # type: ignore[arg-type]
    flight = empty_flight(4)
    flight.legs[2, CRUSH] = 0.1
    assert crush_of.py_func(flight, 2).primary == 0.1  # type: ignore[attr-defined]
