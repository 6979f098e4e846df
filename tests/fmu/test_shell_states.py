"""The FMU state of a built unit: saved, restored and serialised to the last bit, through FMI alone."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from hosted import OK, Hosted

Host = Callable[..., Hosted]


def stepped(one: Hosted, first: int, last: int) -> list[list[float]]:
    """All variables after each of some steps."""
    rows = []
    for n in range(first, last):
        one["end.force[1]"] = 0.1 * n
        assert one.step(n * 1e-2, 1e-2) == OK
        rows.append(one.everything())
    return rows


def test_a_restored_state_repeats_to_the_last_bit_although_velocity_is_hidden(toy: Path, host: Host) -> None:
    one = host(toy)
    stepped(one, 0, 5)
    state, content = one.slave.getFMUState(), one.bytes_of_state()
    once = stepped(one, 5, 9)
    one.slave.setFMUState(state)
    assert one.bytes_of_state() == content
    assert stepped(one, 5, 9) == once


def test_a_state_outlives_its_instance_as_bytes_parameters_included(toy: Path, host: Host) -> None:
    one, other = host(toy, mass=4.0), host(toy)
    stepped(one, 0, 5)
    content = one.slave.serializeFMUState(one.slave.getFMUState())
    once = stepped(one, 5, 9)
    other.slave.setFMUState(other.slave.deSerializeFMUstate(content))
    assert other["mass"] == 4.0
    assert stepped(other, 5, 9) == once


def test_a_state_of_another_size_is_refused_and_the_host_lives(toy: Path, host: Host) -> None:
    one = host(toy)
    one.slave.setFMUState(one.slave.deSerializeFMUstate(b"12345678"))
    assert "the state restored has 1 numbers" in one["message"]
    assert one.step(0.0, 1e-2) != OK


def test_a_state_whose_parameters_cannot_be_prepared_is_refused_every_time(toy: Path, host: Host) -> None:
    one = host(toy, mass=4.0)
    numbers = np.frombuffer(one.slave.serializeFMUState(one.slave.getFMUState())).copy()
    numbers[numbers == 4.0] = -4.0
    broken = one.slave.deSerializeFMUstate(numbers.tobytes())
    for _ in range(2):
        one.slave.setFMUState(broken)
        assert "the state restored: ValueError" in one["message"]
        assert one.step(0.0, 1e-2) != OK


def test_reset_gives_a_new_instance(toy: Path, host: Host) -> None:
    one = host(toy, mass=4.0)
    once = stepped(one, 0, 3)
    one.slave.reset()
    one.begin(mass=4.0)
    assert stepped(one, 0, 3) == once


def test_every_unit_repeats_a_step_to_the_last_bit(fmus: dict[str, Path], host: Host) -> None:
    for name, fmu in fmus.items():
        one = host(fmu)
        assert one.step(0.0, 1e-3) == OK, (name, one.log)
        state = one.slave.getFMUState()
        assert one.step(1e-3, 1e-3) == OK, (name, one.log)
        once, content = one.everything(), one.bytes_of_state()
        one.slave.setFMUState(state)
        assert one.step(1e-3, 1e-3) == OK, (name, one.log)
        assert one.everything() == once, name
        assert one.bytes_of_state() == content, name
