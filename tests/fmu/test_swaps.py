"""Each kind of unit replaced once by a foreign one, and landed: guidance in C of FMI 2.0 and 3.0, a soil in C without rollback,
a leg of another version beside ours.
"""

import re
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hosted import PACKAGE, package_with, packed_from

from orchestrator.master.result import RunResult
from orchestrator.simulation import run_scenario

ROOT = Path(__file__).resolve().parents[2]
LEGS = ("+Z", "+Y", "-Z", "-Y")
Run = Callable[..., RunResult]


@pytest.fixture(scope="module")
def run(fmus: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Run:
    """`run(scenario, *overrides, **changes)`: a scenario with the units in C beside ours, each built once."""
    build = ROOT / "examples" / "c_units" / "build.py"
    done = subprocess.run([sys.executable, str(build)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    ours, made = str(fmus["GearLeg"].parent), dict[str, RunResult]()

    def result(scenario: str, *overrides: str, **changes: Any) -> RunResult:
        key = repr((scenario, overrides, changes))
        if key not in made:
            made[key] = run_scenario(ROOT / "scenarios" / f"{scenario}.toml", overrides, {"fmus": ours} | changes)
        return made[key]

    return result


def touchdown(result: RunResult) -> int:
    """The first row in which a pad touches."""
    touching = np.max([result.columns[f"soil{leg}.contact"] for leg in LEGS], axis=0)
    return int(np.argmax(touching > 0.0))


def record_of(result: RunResult, unit: str) -> Any:
    return {record.name: record for record in result.unit_records}[unit]


CONTROLLERS = [("gnc2", "2.0"), ("gnc3", "3.0")]


@pytest.mark.slow
@pytest.mark.parametrize(("overlay", "version"), CONTROLLERS)
def test_a_controller_in_c_holds_descent_rate_and_attitude_cuts_the_engine_and_lands(run: Run, overlay: str, version: str) -> None:
    """Tolerances: 0.05 m/s is what one sample of full acceleration error makes (0.3 m/s over 0.5 s, by 0.05 s, twice); the jets' deadband
    of 0.005 rad at up to 0.5 deg/s of limit cycle gives 0.5 deg; cut-off takes the rest of a sample, an interval and one sample to fall.
    """
    result = run(f"apollo11_descent_{overlay}")
    assert result.trusted, result.message
    guidance = record_of(result, "guidance")
    assert (guidance.fmi_version, guidance.stepped, guidance.steps) == (version, "once per accepted step", result.accepted)
    contact, times = touchdown(result), result.times
    held = (times > 1.0) & (times < times[contact])
    assert np.abs(result.columns["body.body.velocity[1]"][held] + 0.9).max() < 0.05
    for axis, command in (("yaw", 0.263370), ("pitch", 0.0), ("roll", 0.0)):
        assert np.degrees(np.abs(result.columns[f"body.attitude.{axis}"][held] - command).max()) < 0.5
    thrust = result.columns["guidance.engine.thrust"]
    falling = times[contact:][thrust[contact:] < thrust[contact] - 1.0]
    assert falling[0] - times[contact] < 0.11
    assert not thrust[times > falling[0] + 0.5].any()
    assert np.abs([result.columns[f"body.body.velocity[{i}]"][-1] for i in (1, 2, 3)]).max() < 1e-3
    assert all(result.columns[f"soil{leg}.contact"][-1] for leg in LEGS)


@pytest.mark.slow
def test_the_controller_does_the_same_to_the_bit_in_both_versions_of_fmi(run: Run) -> None:
    two, three = (run(f"apollo11_descent_{overlay}") for overlay, _ in CONTROLLERS)
    assert two.columns.keys() == three.columns.keys()
    assert all((column == three.columns[name]).all() for name, column in two.columns.items())


@pytest.mark.slow
def test_our_guidance_lands_from_the_same_descent_but_tilts(run: Run) -> None:
    result = run("apollo11_descent")
    assert result.trusted, result.message
    assert np.degrees(abs(result.columns["body.attitude.roll"][touchdown(result)])) > 2.0


@pytest.mark.slow
def test_a_soil_in_c_without_rollback_lands_much_as_ours_without_plowing(run: Run) -> None:
    """Both are rate-independent with friction; one point a pad against five. Tolerances, as measured with a margin of a half: the rim
    reaches the slope before the centre does, which moves depths by 3.5 mm and strokes by 6 mm.
    """
    foreign = run("apollo11_soil_c")
    ours = run("apollo11_zupp", "soil*.law=2", "soil*.plowing=0", stop_time=1.5)
    assert foreign.trusted, foreign.message
    assert record_of(foreign, "soil+Z").stepped == "once per accepted step"
    assert foreign.rejected == 0
    for leg in LEGS:
        for name, tolerance in ((f"soil{leg}.penetration", 5e-3), (f"leg{leg}.primary.stroke", 9e-3), (f"leg{leg}.left.stroke", 9e-3)):
            assert foreign.columns[name][-1] == pytest.approx(ours.columns[name][-1], abs=tolerance), name


@pytest.mark.slow
def test_a_soil_without_rollback_at_too_long_intervals_is_stopped_with_a_line(run: Run) -> None:
    result = run("apollo11_soil_c", master={"max_interval": 1e-3})
    assert not result.complete
    assert "explicit coupling is beyond its stability limit" in result.message
    assert "\n" not in result.message


@pytest.mark.slow
def test_a_leg_of_another_version_stands_beside_ours(run: Run, tmp_path: Path) -> None:
    """The other version's struts crush at twice the load, by its code: its own stroke shrinks, and ours do not run its code."""
    source = (PACKAGE / "units" / "gear_leg.py").read_text()
    stiff = source.replace('("primary_load", (20017.0, 42358.0)', '("primary_load", (40034.0, 84716.0)')
    assert stiff != source
    other = packed_from(package_with(tmp_path, gear_leg=stiff), "gear_leg")
    changed = {"units": {"leg-Y": {"fmu": str(other), "parameters": {"azimuth": -np.pi / 2}}}}
    plain, mixed = run("apollo11_zupp", stop_time=1.0), run("apollo11_zupp", stop_time=1.0, **changed)
    assert mixed.trusted, mixed.message
    assert record_of(mixed, "leg-Y").sha256 != record_of(mixed, "leg+Y").sha256
    stroke = {leg: (mixed.columns[f"leg{leg}.primary.stroke"][-1], plain.columns[f"leg{leg}.primary.stroke"][-1]) for leg in LEGS}
    assert stroke["-Y"][0] < 0.3 * stroke["-Y"][1]
    assert stroke["-Z"][0] == pytest.approx(stroke["-Z"][1], rel=0.5)
    assert stroke["-Z"][0] > 0.01


@pytest.mark.slow
def test_a_sensor_in_c_that_knows_degrees_receives_what_ours_does(run: Run) -> None:
    """The same lag; rad/s and rad/s2 of the body become deg/s and deg/s2 on the way. Tolerance: rounding."""
    gyro = {"units": {"sensor": {"fmu": str(ROOT / "build" / "foreign" / "Sensor3.fmu"), "parameters": {"time_constant": 0.05}}}}
    foreign, ours = run("apollo11_zupp", stop_time=1.0, **gyro), run("apollo11_zupp", "sensor.time_constant=0.05", stop_time=1.0)
    assert foreign.trusted, foreign.message
    assert foreign.units["sensor.telemetry.yaw"] == "deg/s"
    for axis in ("yaw", "pitch", "roll"):
        name = f"sensor.telemetry.{axis}"
        assert np.radians(foreign.columns[name]) == pytest.approx(ours.columns[name], abs=1e-13)


@pytest.mark.slow
def test_a_body_of_another_version_flies_on_our_legs(run: Run, tmp_path: Path) -> None:
    """Nothing of the base's table stays: with its own gravity of 1.0 m/s2, stated nowhere, it lands softer."""
    source = (PACKAGE / "units" / "vehicle_body.py").read_text()
    light = source.replace('parameter("gravity", 1.63', 'parameter("gravity", 1.0')
    assert light != source
    other = packed_from(package_with(tmp_path, vehicle_body=light), "vehicle_body")
    start = {"velocity_start": [-0.573, -0.6147, -0.213], "yaw_start": 0.26337, "pitch_start": 0.016459, "roll_start": 0.044419}
    changed = {"units": {"body": {"fmu": str(other), "parameters": start | {"rates_start": [-0.0108, 0.0, -0.05]}}}}
    plain, swapped = run("apollo11_zupp", stop_time=1.0), run("apollo11_zupp", stop_time=1.0, **changed)
    assert swapped.trusted, swapped.message
    depth = {name: [r.columns[f"soil{leg}.penetration"][-1] for leg in LEGS] for name, r in (("plain", plain), ("light", swapped))}
    assert sum(depth["light"]) < 0.9 * sum(depth["plain"])


def altered(fmu: Path, into: Path, pattern: str, replacement: str) -> Path:
    """The FMU with another modelDescription."""
    with zipfile.ZipFile(fmu) as old, zipfile.ZipFile(into, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name == "modelDescription.xml":
                content, count = re.subn(pattern.encode(), replacement.encode(), content)
                assert count
            new.writestr(name, content)
    return into


FAULTY = {
    "wrong units": (
        r'(name="engine.force\[\d\]"[^>]*>\s*<Real )unit="N"',
        r'\1unit="N.m"',
        "guidance.engine.force[1] -> body.engine.force[1]: sends N.m, expects N;",
    ),
    "missing port": (r'name="engine\.', r'name="motor.', 'guidance.engine: unit guidance has no port "engine"; known here: '),
    "missing input": (r'name="contact3"', r'name="touch3"', 'guidance.contact3: unit guidance has no input "contact3"; did you mean'),
}


@pytest.mark.parametrize("fault", FAULTY)
def test_a_unit_that_does_not_fit_is_one_line_that_names_unit_and_variable(run: Run, tmp_path: Path, fault: str) -> None:
    pattern, replacement, message = FAULTY[fault]
    fmu = altered(ROOT / "build" / "foreign" / "Gnc2.fmu", tmp_path / "faulty.fmu", pattern, replacement)
    overlay = tmp_path / "swap.toml"
    base = (ROOT / "scenarios" / "apollo11_zupp.toml").as_posix()
    overlay.write_text(f'extends = "{base}"\n[units.guidance]\nfmu = "{fmu.as_posix()}"\n')
    command = [sys.executable, "-m", "orchestrator", "run", str(overlay), "--out", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, timeout=900, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: swap.toml: {message}")
    assert len(done.stderr.splitlines()) == 1
