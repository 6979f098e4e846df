"""Our FMUs in hosts that other people wrote, each installed from PyPI into an environment of its own: libcosim and ecos (both C++), and
the FMU Manipulation Toolbox's container. FMPy is what most tests here use. Nothing is mocked; a host that is missing fails its test."""

import csv
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
import tomli_w
from hosted import OK, Hosted

from orchestrator.blueprint import draw_up, read_scenario

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

import hosts  # noqa: E402  # they stand with the benchmarks, which measure these hosts
import task as tasks  # noqa: E402

Host = Callable[..., Hosted]
STEP, STOP = 1e-3, 0.03
OUTPUTS_WATCHED = 12
AS = {"Real": float, "Integer": int, "Boolean": bool, "String": str}


def first_row(fmu: Path) -> tuple[dict[str, float], dict[str, float]]:
    """Parameters of an FMU's reference experiment, and its inputs at the start."""
    with zipfile.ZipFile(fmu) as archive:
        lines = archive.read("documentation/reference.csv").decode().splitlines()
    parameters = {name: float(value) for name, _, value in (line[2:].partition(" = ") for line in lines if line.startswith("# "))}
    return parameters, {name: float(x) for name, x in next(csv.DictReader(line for line in lines if line[0] != "#")).items()}


def experiment(name: str, fmu: Path) -> tuple[dict[str, float], list[Any]]:
    """Constant inputs and parameters for one unit, and some of its outputs to watch."""
    variables = {v.name: v for v in fmpy.read_model_description(str(fmu)).modelVariables}
    parameters, row = first_row(fmu)
    inputs = {key: value for key, value in row.items() if key in variables and variables[key].causality == "input"}
    outputs = [v for v in variables.values() if v.causality == "output" and v.type == "Real"]
    return parameters | inputs, outputs[:: max(1, len(outputs) // OUTPUTS_WATCHED)]


@pytest.fixture(scope="module")
def task(fmus: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """A job for benchmarks/peers: all units beside each other, each on its own, in an .ssp."""
    units, watch = {}, []
    for name, fmu in fmus.items():
        values, outputs = experiment(name, fmu)
        kinds = {v.name: AS[v.type] for v in fmpy.read_model_description(str(fmu)).modelVariables}
        units[name] = {"fmu": str(fmu), "parameters": {key: kinds[key](value) for key, value in values.items()}}
        watch += [f"{name}.{v.name}" for v in outputs]
    scenario = tmp_path_factory.mktemp("hosts") / "units.toml"
    scenario.write_text(tomli_w.dumps({"title": "Units beside each other", "stop_time": STOP, "units": units}), "utf-8")
    return tasks.task_of(draw_up(read_scenario(scenario), scenario), watch) | {"step": STEP}


@pytest.fixture(scope="module")
def expected(fmus: dict[str, Path], unpacked: Callable[[Path], Path]) -> dict[str, np.ndarray]:
    """The same in FMPy: "unit.variable" → its values after each step."""
    found = {}
    for name, fmu in fmus.items():
        values, outputs = experiment(name, fmu)
        one = Hosted(unpacked(fmu), **values)
        rows = []
        for n in range(round(STOP / STEP)):
            assert one.step(n * STEP, STEP) == OK, one.log
            rows.append([one[v.name] for v in outputs])
        found |= {f"{name}.{v.name}": column for v, column in zip(outputs, np.array(rows).T, strict=True)}
        one.slave.freeInstance()
    return found


@pytest.mark.parametrize("peer", ["libcosim", "ecos"])
def test_every_unit_gives_in_a_cpp_host_what_it_gives_in_fmpy(peer: str, task: dict[str, Any], expected: dict[str, np.ndarray]) -> None:
    """To 1e-9 of each course's size: the hosts count time otherwise, in nanoseconds or by adding up, and a last bit of it may differ."""
    outcome = hosts.run_peer(peer, task, timeout=1800.0)
    assert outcome.message == ""
    steps = np.rint(np.array(outcome.times) / STEP).astype(int)
    assert steps[-1] >= round(STOP / STEP) - 1      # libcosim stops short of a time it would overstep
    moving = 0
    for name, course in expected.items():
        got = np.array(outcome.values[name])[steps > 0]
        assert got == pytest.approx(course[steps[steps > 0] - 1], abs=1e-9 * float(np.abs(course).max()) + 1e-12), name
        moving += bool(np.ptp(course) > 0.0)
    assert moving > 40      # so that it is not all standing still


@pytest.fixture(scope="module")
def container(fmus: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Leg and soil in one FMU. The toolbox links what bears the same name: the whole contract of the pad's port, both ways."""
    folder = tmp_path_factory.mktemp("container")
    for name in ("GearLeg", "RegolithContact"):
        (folder / f"{name}.fmu").write_bytes(fmus[name].read_bytes())
    wrench = [f"GearLeg.fmu;mount.{member}[{i}]" for member in ("force", "torque") for i in (1, 2, 3)]
    shown = [*wrench, "GearLeg.fmu;primary.stroke", "RegolithContact.fmu;gap", "RegolithContact.fmu;penetration"]
    rules = ["rule;from_fmu;from_port;to_fmu;to_port", "FMU;GearLeg.fmu;;;", "FMU;RegolithContact.fmu;;;"]
    rules += [f"OUTPUT;{one};;{one.partition(';')[2]}" for one in shown]
    (folder / "leg_on_soil.csv").write_text("\n".join(rules) + "\n")
    python, complaint = hosts.environment("toolbox")
    assert python is not None, complaint
    command = [str(python.parent / "fmucontainer"), "-container", "leg_on_soil.csv:0.0001", "-fmu-directory", ".", "-no-auto-output"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert (folder / "leg_on_soil.fmu").exists(), done.stdout + done.stderr
    return folder / "leg_on_soil.fmu"




def test_leg_and_soil_in_a_container_press_on_each_other_in_fmpy(container: Path, host: Host) -> None:
    """The body sinks at 0.3 m/s: what the mount feels is K_n times the pad's depth, to 3 %, for the leg's own inertia and weight."""
    sink, step = 0.3, 5e-4
    one = host(container, **{"body.position[1]": 3.62, "body.velocity[1]": -sink})
    for n in range(100):
        one["body.position[1]"] = 3.62 - sink * n * step
        assert one.step(n * step, step) == OK, one.log
    assert one["penetration"] == pytest.approx(sink * 100 * step, abs=2e-3)      # the struts give a little
    assert one["mount.force[1]"] == pytest.approx(350254.0 * one["penetration"], rel=0.03)


def test_the_container_runs_in_our_master_with_the_same_result(container: Path, host: Host, tmp_path: Path) -> None:
    from orchestrator.simulation import run_scenario

    scenario = tmp_path / "pressed.toml"
    scenario.write_text(f"""
stop_time = 0.02
fmus = "{container.parent.as_posix()}"
[units.leg]
fmu = "leg_on_soil"
[units.leg.parameters]
"body.position" = [3.615, 0.0, 0.0]
[master]
max_interval = 1e-3
""")
    result = run_scenario(scenario)
    assert result.message == ""
    one = host(container, **{"body.position[1]": 3.615})
    for n in range(20):
        assert one.step(n * 1e-3, 1e-3) == OK, one.log
    for name in ("mount.force[1]", "mount.torque[2]", "primary.stroke", "penetration"):
        assert result.columns[f"leg.{name}"][-1] == one[name], name
