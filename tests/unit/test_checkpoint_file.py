"""A checkpoint's file: bits in, bits out; never half-written, never read when damaged."""

from pathlib import Path

import numpy as np
import pytest

from orchestrator.checkpoint import file
from orchestrator.checkpoint.file import CheckpointError, DamageError

ABOUT = {"time": 150_000_000, "estimate": float("nan"), "log": [[0.1 + 0.2, True, "soil+Z.pad"]], "unit": "°"}
ARRAYS = {"recorder.rows": np.array([[-0.0, np.inf], [5e-324, 1 / 3]]), "state leg+Z": np.frombuffer(b"\0\1\xff", dtype=np.uint8)}


def test_every_bit_comes_back(tmp_path: Path) -> None:
    about, arrays = file.read(file.write(tmp_path / "new", 0, ABOUT, ARRAYS))
    assert repr(about) == repr(ABOUT)
    assert {key: value.tobytes() for key, value in arrays.items()} == {key: value.tobytes() for key, value in ARRAYS.items()}


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 0.999])
def test_a_truncated_file_is_damaged(tmp_path: Path, share: float) -> None:
    path = file.write(tmp_path, 0, ABOUT, ARRAYS)
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(DamageError, match=r"^checkpoint_000000.bin: is truncated or damaged"):
        file.read(path)


def test_any_flipped_bit_is_found(tmp_path: Path) -> None:
    path = file.write(tmp_path, 0, ABOUT, ARRAYS)
    content = path.read_bytes()
    for place in range(0, len(content), 7):
        path.write_bytes(content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :])
        with pytest.raises((DamageError, CheckpointError)):
            file.read(path)


def test_a_file_of_another_format_says_which(tmp_path: Path) -> None:
    path = file.write(tmp_path, 0, ABOUT, ARRAYS)
    path.write_bytes(path.read_bytes().replace(b"lander-checkpoint-1", b"lander-checkpoint-2"))
    with pytest.raises(CheckpointError, match="has the format lander-checkpoint-2, this version reads lander-checkpoint-1"):
        file.read(path)


def test_three_are_kept_and_none_of_a_time_that_is_undone(tmp_path: Path) -> None:
    for number in range(6):
        file.write(tmp_path, number, ABOUT, ARRAYS)
    (tmp_path / "checkpoint_000009.part").touch()      # left by a killed process
    assert list(file.numbered(tmp_path)) == [5, 4, 3]
    file.write(tmp_path, 4, ABOUT, ARRAYS)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["checkpoint_000003.bin", "checkpoint_000004.bin"]
    file.clear(tmp_path)
    assert list(tmp_path.iterdir()) == []
