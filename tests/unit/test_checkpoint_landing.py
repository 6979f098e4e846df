"""The whole Apollo 11 vehicle, eleven FMUs, killed in mid-run and resumed through touchdown: the same bits."""

import signal
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from checkpoint_runs import checkpoint, content, resumed, run, stop_a_run

ROOT = Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "scenarios" / "apollo11_zupp.toml"


@pytest.mark.skipif(not (ROOT / "build" / "fmus" / "GearLeg.fmu").exists(), reason="python build_fmus.py first")
def test_a_landing_killed_at_half_time_resumes_to_the_same_bits(tmp_path: Path) -> None:
    whole, out = run(SCENARIO, tmp_path / "whole", "--stop-time", 0.3), tmp_path / "out"
    ended = stop_a_run(SCENARIO, out, 1, signal.SIGKILL, "--stop-time", 0.3, "--checkpoint-every", 0.15)
    assert ended == -signal.SIGKILL
    assert checkpoint(out, 1).stat().st_size < 1_000_000
    done = resumed(out)
    assert (done.returncode, done.stderr) == (0, "")
    ours, theirs = (pq.read_table(folder / "history.parquet") for folder in (out, whole))
    assert ours.column_names == theirs.column_names
    assert theirs.num_rows > 100  # one row an accepted interval: through the touchdown of two feet, not a free flight
    assert theirs["soil+Z.penetration"].to_numpy()[-1] > 0.0        # it has touched down
    for name in theirs.column_names:
        assert ours[name].to_numpy().tobytes() == theirs[name].to_numpy().tobytes(), name
    assert content(out) == content(whole)
