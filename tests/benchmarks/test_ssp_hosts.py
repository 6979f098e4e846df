"""The exported Apollo 11 vehicle in the hosts of others, from the file alone, each in an environment of its own."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))

import full
import hosts
import packs
import task

from orchestrator.simulation import draw_up, read_scenario

STOP = 0.02  # s: two feet touch down in it
built = pytest.mark.skipif(not (packs.ROOT / "build" / "fmus" / "GearLeg.fmu").exists(), reason="python build_fmus.py first")


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    task.FOLDER = tmp_path_factory.mktemp("ssp")
    blueprint = draw_up(read_scenario(full.SCENARIO, (), {"stop_time": STOP}), full.SCENARIO)
    return task.task_of(blueprint, [*full.BODY, *full.STROKES]) | {"step": 1e-4}


@pytest.fixture(scope="module")
def ours(job: dict[str, Any]) -> hosts.Outcome:
    """Our own run of the same file, at most 0.2 ms a step: between rows 5 ms apart the straight line alone is 5e-6 m off."""
    changes = {"master": {"max_interval": 2e-4}, "record": {"interval": 0.0, "variables": ["body.body.position", "leg*.*.stroke"]}}
    asked = {"scenario": job["ssp"], "changes": changes, "watch": [*full.BODY, *full.STROKES]}
    return hosts.run_script(Path(sys.executable), hosts.HERE / "peers" / "run_ours.py", asked)


@built
@pytest.mark.parametrize("peer", ["libcosim", "ecos", "fmpy"])
def test_the_landing_runs_from_the_file_and_begins_as_ours(peer: str, job: dict[str, Any], ours: hosts.Outcome) -> None:
    assert ours.message == ""
    outcome = hosts.run_peer(peer, job)
    assert outcome.message == ""
    assert len(outcome.times) >= 200
    named = {name: np.asarray(values) for name, values in ours.values.items()}
    body, stroke = full.errors(outcome.times, outcome.values, (np.asarray(ours.times), named))
    assert abs(named["body.body.position[1]"][-1] - named["body.body.position[1]"][0]) > 0.01        # m: it has moved
    assert body < 2e-6           # m: 1e-7 seen with fixed steps of 0.1 ms; a wrong start or a lost connection is above 1e-4
    assert stroke < 2e-6         # m
