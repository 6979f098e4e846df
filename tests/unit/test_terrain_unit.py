"""RegolithContact on a height map: the map is a constant beside the state, and the state knows which one it belongs to."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lander.units.regolith_contact import RegolithContact

STEP = 2e-3


def on_map(path: Path | None, **values: Any) -> RegolithContact:
    """A pad above a map of 0.5 m pixels with L's origin in its middle, initialised."""
    unit = RegolithContact(instance_name="soil")
    if path is not None:
        unit.set_string([unit.layout.slices["terrain.map"].start], [str(path)])
    unit["terrain.map_corner"], unit["terrain.map_step"] = (-2.5, -2.5), (0.5, 0.5)
    for name, value in values.items():
        unit[name.replace("__", ".")] = value
    push(unit, 0.0)
    unit.setup_experiment(0.0, None, None)
    unit.enter_initialization_mode()
    unit.exit_initialization_mode()
    return unit


def push(unit: RegolithContact, time: float) -> None:
    unit["pad.position"], unit["pad.velocity"] = (0.13 - 0.4 * time, 0.2 * time, 0.0), (-0.4, 0.2, 0.0)


def step(unit: RegolithContact, first: int, count: int) -> None:
    for k in range(first, first + count):
        push(unit, k * STEP)
        assert unit.do_step(k * STEP, STEP), unit.message


@pytest.fixture
def tile(tmp_path: Path) -> Path:
    np.save(tmp_path / "tile.npy", 0.02 * np.random.default_rng(4).standard_normal((11, 11)))
    return tmp_path / "tile.npy"


def test_a_state_taken_to_another_instance_on_the_same_map_goes_on_to_the_same_bits(tile: Path) -> None:
    one, other = on_map(tile), on_map(tile)
    step(one, 0, 20)
    kept = RegolithContact._fmu_state_to_bytes(one._get_fmu_state())
    step(one, 20, 10)
    other._set_fmu_state(RegolithContact._fmu_state_from_bytes(kept))
    step(other, 20, 10)
    assert other.memory.tobytes() == one.memory.tobytes()
    assert len(kept) == 8 * one.memory.size, "the map is not in the state"


def test_going_back_in_one_instance_gives_the_same_bits(tile: Path) -> None:
    unit = on_map(tile)
    step(unit, 0, 20)
    kept = unit._get_fmu_state()
    step(unit, 20, 10)
    once = unit.memory.tobytes()
    unit._set_fmu_state(kept)
    step(unit, 20, 10)
    assert unit.memory.tobytes() == once


def test_a_state_is_refused_on_another_map(tile: Path, tmp_path: Path) -> None:
    kept = RegolithContact._fmu_state_to_bytes(on_map(tile)._get_fmu_state())
    np.save(tmp_path / "other.npy", np.zeros((11, 11)))
    for path, told in ((tmp_path / "other.npy", "this is a map with digest"), (None, "this is no map")):
        unit = on_map(path)
        unit._set_fmu_state(RegolithContact._fmu_state_from_bytes(kept))
        assert told in unit.message
        assert not unit.do_step(0.0, STEP)


def test_the_map_is_read_back_and_fixed_after_initialisation(tile: Path) -> None:
    unit = on_map(tile)
    reference = [unit.layout.slices["terrain.map"].start]
    unit.set_string(reference, ["elsewhere.npy"])
    assert unit.get_string(reference) == [str(tile)]
    assert "fixed after initialisation" in unit.message


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"terrain__craters": (0.0, 0.0, 1.0, 2.0, 0.0) + (0.0,) * 35}, "expects 0 < depth <= diameter"),
        ({"terrain__boulders": (0.0, 0.0, 1.0, 3.0) + (0.0,) * 28}, "expects more than 0 and at most 2 m"),
        ({"terrain__map_corner": (-0.5, -2.5)}, "m inside the edge of what the height map covers, expects at least 1 m"),
        ({"terrain__map_corner": (50.0, -2.5)}, "m beyond the edge of what the height map covers"),
    ],
)
def test_a_relief_that_cannot_be_is_refused_at_initialisation(tile: Path, values: dict[str, Any], told: str) -> None:
    assert told in on_map(tile, **values).message


@pytest.mark.parametrize("content", [None, b"no array", np.zeros(7), np.zeros((3, 9))])
def test_a_file_that_is_no_map_is_refused_at_initialisation(tmp_path: Path, content: Any) -> None:
    path = tmp_path / "bad.npy"
    if isinstance(content, bytes):
        path.write_bytes(content)
    elif content is not None:
        np.save(path, content)
    told = "no such file" if content is None else "cannot be read" if isinstance(content, bytes) else "at least 4 by 4"
    assert told in on_map(path).message


def test_a_pad_that_slides_off_the_map_ends_the_step_with_the_reason(tile: Path) -> None:
    unit = on_map(tile)
    unit["pad.position"], unit["pad.velocity"] = (0.05, 1.5, 0.0), (0.0, 2000.0, 0.0)
    assert not unit.do_step(0.0, STEP)
    assert "what the height map covers" in unit.message
