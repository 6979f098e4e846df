"""A host in C, built here, runs our FMUs with the environment that `orchestrator host-env` tells, and says why it cannot without."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest
from c_library import compiler
from fmpy import read_model_description
from hosted import OK, Hosted

from orchestrator.host_environment import host_environment

ROOT = Path(__file__).resolve().parents[2]
Host = Callable[..., Hosted]
CASES = {      # unit: (start values, output)
    "RateSensor": ({"time_constant": 0.02, "rates.yaw": 0.3}, "telemetry.yaw"),
    "GearLeg": ({"pad.force[1]": 3000.0}, "mount.force[1]"),
    "RegolithContact": ({"pad.position[1]": 0.09, "pad.velocity[1]": -0.1}, "pad.force[1]"),
}


@pytest.fixture(scope="module")
def plain_host(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """examples/plain_host, compiled as its first lines say."""
    program = tmp_path_factory.mktemp("host") / "plain_host"
    headers, source = Path(fmpy.__file__).parent / "c-code", ROOT / "examples" / "plain_host" / "plain_host.c"
    subprocess.run([*compiler(), "-Wall", "-Werror", f"-I{headers}", "-o", str(program), str(source), "-ldl"], check=True)
    return program


def command(plain_host: Path, folder: Path, start: dict[str, float], output: str) -> list[str]:
    description = read_model_description(str(folder))
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    binary = folder / "binaries" / fmpy.platform / f"{description.coSimulation.modelIdentifier}{fmpy.sharedLibraryExtension}"
    given = [*(f"{reference[name]}={value!r}" for name, value in start.items()), str(reference[output])]
    return [str(plain_host), str(binary), (folder / "resources").as_uri(), description.guid, "0.02", "0.001", *given]


def stranger() -> dict[str, str]:
    """An environment that knows nothing of this Python."""
    return {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME", "LD_PRELOAD")}


@pytest.mark.parametrize("name", CASES)
def test_a_c_host_gets_the_bits_that_fmpy_gets(
    name: str, plain_host: Path, fmus: dict[str, Path], unpacked: Callable[[Path], Path], host: Host
) -> None:
    (start, output), folder = CASES[name], unpacked(fmus[name])
    done = subprocess.run(command(plain_host, folder, start, output), capture_output=True, text=True, check=False,
                          env=stranger() | host_environment())
    assert done.returncode == 0, done.stderr
    rows = [[float(number) for number in line.split()] for line in done.stdout.splitlines()]
    one = host(fmus[name], **start)
    for n, (time, value) in enumerate(rows):
        assert one.step(n * 0.001, 0.001) == OK
        assert (time, value) == ((n + 1) * 0.001, one[output])
    assert len(rows) == 20
    assert rows[-1][1] != 0.0


def test_the_command_prints_the_environment_and_starts_a_host_with_it(
    plain_host: Path, fmus: dict[str, Path], unpacked: Callable[[Path], Path]
) -> None:
    ours = [sys.executable, "-m", "orchestrator", "host-env"]
    printed = subprocess.run(ours, capture_output=True, text=True, check=True).stdout.splitlines()
    assert dict(line.split("=", 1) for line in printed) == host_environment()
    start, output = CASES["RateSensor"]
    wanted = command(plain_host, unpacked(fmus["RateSensor"]), start, output)
    done = subprocess.run([*ours, *wanted], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 20


def test_without_it_the_host_is_told_what_is_missing(plain_host: Path, fmus: dict[str, Path], unpacked: Callable[[Path], Path]) -> None:
    start, output = CASES["RateSensor"]
    wanted = command(plain_host, unpacked(fmus["RateSensor"]), start, output)
    done = subprocess.run(wanted, capture_output=True, text=True, check=False, env=stranger())
    assert done.returncode == 2
    assert "undefined symbol: _Py" in done.stderr or "undefined symbol: Py" in done.stderr


def test_a_program_that_is_not_there_is_told_in_one_line() -> None:
    ours = [sys.executable, "-m", "orchestrator", "host-env", "./no_such_host"]
    done = subprocess.run(ours, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "host-env ./no_such_host: cannot be started" in done.stderr
