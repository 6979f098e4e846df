"""Killed, interrupted and resumed as a user does it, with small FMUs."""

import shutil
import signal
import zipfile
from pathlib import Path

import pytest
from checkpoint_runs import checkpoint, content, orchestrator, resumed, run, stop_a_run
from fmi_samples import oscillator, sample_fmus

from orchestrator.checkpoint import origin
from orchestrator.checkpoint.checkpoint import newest
from orchestrator.checkpoint.file import CheckpointError

START = '\n[start]\nvary = "b.position_start"\nzero = "b.posit*"\nvalue = 0.7\n\n[record]\ninterval = 3e-3\n'
EVERY = ("--checkpoint-every", 0.15)


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("scenario")
    shutil.copytree(sample_fmus(), folder / "fmus")
    return oscillator(folder, START, **{sample_fmus().as_posix(): "fmus", "stop_time = 0.5": "stop_time = 3.0"})


@pytest.fixture(scope="module")
def whole(scenario: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run(scenario, tmp_path_factory.mktemp("whole") / "out")


@pytest.fixture(scope="module")
def watched(scenario: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run(scenario, tmp_path_factory.mktemp("watched") / "out", *EVERY)


@pytest.fixture
def kept(watched: Path, tmp_path: Path) -> Path:
    """A copy to do harm to, without results: they must come from the resumed run."""
    shutil.copytree(watched / "checkpoints", tmp_path / "out" / "checkpoints")
    return tmp_path / "out"


def test_checkpoints_change_no_result(whole: Path, watched: Path) -> None:
    assert content(watched) == content(whole)
    assert [checkpoint(watched, n).exists() for n in (16, 17, 18, 19, 20)] == [False, True, True, True, False]


def test_a_killed_run_resumes_to_the_same_bits(scenario: Path, whole: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert stop_a_run(scenario, out, 1, signal.SIGKILL, *EVERY) == -signal.SIGKILL
    assert not (out / "summary.json").exists()
    done = resumed(out)
    assert (done.returncode, done.stderr) == (0, "")
    assert content(out) == content(whole)


def test_an_interrupted_run_resumes_from_where_it_was_interrupted(scenario: Path, whole: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert stop_a_run(scenario, out, 1, signal.SIGINT, *EVERY) == 130
    assert content(out)["summary"]["interrupted"] is True
    assert checkpoint(out, 2).exists()
    assert resumed(out).returncode == 0
    assert content(out) == content(whole)


def test_a_resumed_run_can_be_killed_and_resumed_again(scenario: Path, whole: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    stop_a_run(scenario, out, 1, signal.SIGKILL, *EVERY)
    for number in (5, 6):
        checkpoint(out, number).unlink(missing_ok=True)
    assert resumed(out).returncode == 0
    checkpoint(out, max(n for n in range(40) if checkpoint(out, n).exists())).unlink()
    assert resumed(out).returncode == 0
    assert content(out) == content(whole)


@pytest.mark.parametrize("stop_time", [2.9, 4.0])
def test_another_stop_time_gives_the_bits_of_a_run_to_there(scenario: Path, kept: Path, stop_time: float, tmp_path: Path) -> None:
    run(scenario, tmp_path / "direct", "--stop-time", stop_time)
    done = resumed(kept, "--stop-time", stop_time)
    assert done.returncode == 0, done.stderr
    assert content(kept) == content(tmp_path / "direct")


def test_a_stop_time_before_all_checkpoints_is_one_line(kept: Path) -> None:
    done = resumed(kept, "--stop-time", 1.0)
    assert done.returncode == 2
    assert "no checkpoint is far enough before the stop times, 3 s then and 1 s now" in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_a_truncated_checkpoint_falls_back_to_the_one_before_and_says_so(kept: Path, whole: Path) -> None:
    path = checkpoint(kept, 19)
    path.write_bytes(path.read_bytes()[:-100])
    done = resumed(kept)
    assert done.returncode == 0, done.stderr
    assert done.stderr == (
        "warning: checkpoint_000019.bin: is truncated or damaged (its SHA-256 does not fit); going on from the one before\n"
    )
    assert content(kept) == content(whole)


def test_nothing_but_damaged_checkpoints_is_one_line(kept: Path) -> None:
    for path in (kept / "checkpoints").iterdir():
        path.write_bytes(b"")
    done = resumed(kept)
    assert done.returncode == 2
    assert done.stderr.endswith("out: all of its 3 checkpoints are truncated or damaged; run again\n")
    assert len(done.stderr.splitlines()) == 1


def test_a_folder_without_checkpoints_is_one_line(tmp_path: Path) -> None:
    done = resumed(tmp_path)
    assert done.returncode == 2
    assert "holds no checkpoint; give the folder of a run made with --checkpoint-every" in done.stderr


def test_a_changed_fmu_is_named(scenario: Path, kept: Path) -> None:
    fmu = scenario.parent / "fmus" / "SampleSpring.fmu"
    before = fmu.read_bytes()
    try:
        with zipfile.ZipFile(fmu, "a") as archive:
            archive.writestr("documentation/more.txt", "new")
        done = resumed(kept)
    finally:
        fmu.write_bytes(before)
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: spring: {fmu} has changed since the checkpoint (SHA-256 ")
    assert len(done.stderr.splitlines()) == 1


def test_another_version_is_named(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other = origin.made_with() | {"numpy": "9.9"}
    monkeypatch.setattr(origin, "made_with", lambda: other)
    with pytest.raises(CheckpointError, match=r"^checkpoint: made with numpy \S+, this is 9\.9, so the run would not go on"):
        newest(kept)


def test_a_new_run_in_the_folder_leaves_nothing_of_the_old_one_to_resume(scenario: Path, kept: Path) -> None:
    run(scenario, kept, "--stop-time", 0.1, "--checkpoint-every", 1.0)
    assert [path.name for path in (kept / "checkpoints").iterdir()] == ["checkpoint_000000.bin"]
    run(scenario, kept, "--stop-time", 0.1)
    assert list((kept / "checkpoints").iterdir()) == []


CANNOT = {
    "SampleStateless": "u (SampleStateless.fmu): cannot serialise its state (canSerializeFMUstate is false)",
    "SampleForgetful": "u: claims to serialise its state but does not go on from it with the same bits",
}


@pytest.mark.parametrize(("model", "message"), CANNOT.items(), ids=CANNOT)
def test_a_unit_that_cannot_be_kept_is_named_when_checkpoints_are_asked_for(tmp_path: Path, model: str, message: str) -> None:
    path = tmp_path / "one.toml"
    path.write_text(f'stop_time = 0.01\nfmus = "{sample_fmus().as_posix()}"\n[units.u]\nfmu = "{model}"\nonce = true\n')
    done = orchestrator("run", path, *EVERY, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: {message}")
    assert len(done.stderr.splitlines()) == 1
    assert orchestrator("run", path, cwd=tmp_path).returncode == 0


@pytest.mark.parametrize("every", ["0", "-1", "nan", "inf"])
def test_an_interval_between_checkpoints_is_positive(scenario: Path, every: str, tmp_path: Path) -> None:
    done = orchestrator("run", scenario, f"--checkpoint-every={every}", cwd=tmp_path)
    assert done.returncode == 2
    assert f"--checkpoint-every {every}: expects seconds of simulated time" in done.stderr
