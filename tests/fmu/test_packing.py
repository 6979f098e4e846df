"""The packed files: valid, the same bytes from the same sources, at home in any Python, never mixed with one another."""

import os
import subprocess
import sys
import venv
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest
from fmpy.validation import validate_fmu
from hosted import OK, Hosted, package_with, packed_from

TOY = Path(__file__).with_name("mass_spring.py")
Host = Callable[..., Hosted]

STRANGER = """
import sys
class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("lander", "orchestrator"):
            raise ImportError(name + " is not to be known here")
sys.meta_path.insert(0, Refuse())
for name in ("lander", "orchestrator"):
    try:
        __import__(name)
    except ImportError:
        continue
    raise SystemExit("the project is importable here: the test shows nothing")
from fmpy import simulate_fmu
result = simulate_fmu(sys.argv[1], stop_time=0.005, output_interval=0.001)
assert len(result) == 6 and abs(result["time"][-1] - 0.005) < 1e-12
assert not any(name.split(".")[0] in ("lander", "orchestrator") for name in sys.modules)
sys.stdout.flush()
import os; os._exit(0)
"""


def test_fmpy_finds_nothing_to_complain_of(fmus: dict[str, Path], toy: Path) -> None:
    assert {name: validate_fmu(str(fmu)) for name, fmu in (*fmus.items(), ("MassSpring", toy))} == {
        name: [] for name in (*fmus, "MassSpring")}


def test_every_unit_runs_in_a_python_that_has_never_heard_of_the_project(fmus: dict[str, Path], tmp_path: Path) -> None:
    for name, fmu in fmus.items():
        done = subprocess.run([sys.executable, "-I", "-c", STRANGER, str(fmu)], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, (name, done.stdout, done.stderr)


def test_every_unit_runs_where_only_fmpy_is_installed(fmus: dict[str, Path], tmp_path: Path) -> None:
    """No pythonfmu, no numba, no project: what a colleague's machine has. Plain Python then, from what the FMU carries."""
    venv.create(tmp_path / "bare", with_pip=True)
    python = tmp_path / "bare" / ("Scripts" if os.name == "nt" else "bin") / "python"
    subprocess.run([python, "-m", "pip", "install", "-q", "fmpy", "numpy"], check=True, capture_output=True)
    for name, fmu in fmus.items():
        done = subprocess.run([python, "-I", "-c", STRANGER, str(fmu)], cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, (name, done.stdout, done.stderr)


@pytest.mark.parametrize("cache", ["", "cache", "a file/below"])
def test_a_unit_runs_without_a_cache_with_one_and_with_one_that_cannot_be(toy: Path, tmp_path: Path, cache: str) -> None:
    (tmp_path / "a file").touch()
    environment = dict(os.environ, LANDER_UNITS_CACHE=str(tmp_path / cache) if cache else "")
    done = subprocess.run([sys.executable, "-I", "-c", STRANGER, str(toy)], cwd=tmp_path, capture_output=True, text=True, env=environment,
                          check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "cache").exists() == (cache == "cache")


def test_two_versions_of_one_unit_live_in_one_process(toy: Path, tmp_path: Path, host: Host) -> None:
    text = TOY.read_text().replace("0.1 * self.value", "0.2 * self.value")
    (tmp_path / "other").mkdir()
    changed = packed_from(package_with(tmp_path / "other", mass_spring=text), "mass_spring")
    first, second, third = host(toy), host(changed), host(toy)
    assert first.description.guid != second.description.guid
    assert [one["end.position[1]"] for one in (first, second, third)] == [0.2, 0.4, 0.2]


def test_hundreds_of_instances_live_in_one_process(toy: Path, host: Host) -> None:
    made = [host(toy) for _ in range(200)]      # pythonfmu 0.7 by itself: heap corruption after about five
    assert [one.step(0.0, 1e-3) for one in made] == [OK] * 200
    assert len({one["end.position[1]"] for one in made}) == 1


def test_the_same_sources_give_the_same_bytes(tmp_path: Path) -> None:
    packed = []
    for name in ("once", "again"):
        (tmp_path / name).mkdir()
        packed.append(packed_from(package_with(tmp_path / name, mass_spring=TOY.read_text()), "mass_spring").read_bytes())
    assert packed[0] == packed[1]


def test_terminals_name_variables_that_exist_and_the_documentation_is_there(fmus: dict[str, Path]) -> None:
    for name, fmu in fmus.items():
        with zipfile.ZipFile(fmu) as archive:
            description = ElementTree.fromstring(archive.read("modelDescription.xml"))
            terminals = ElementTree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
            page = archive.read("documentation/index.html").decode()
        variables = {variable.get("name") for variable in description.iter("ScalarVariable")}
        members = [(terminal.get("name"), member) for terminal in terminals.iter("Terminal")
                   for member in terminal.iter("TerminalMemberVariable")]
        assert members, name
        for port, member in members:
            assert member.get("variableName") == f"{port}.{member.get('memberName')}"
            assert member.get("variableName") in variables
        assert f"<h1>{name}</h1>" in page


def test_every_real_has_a_unit_and_every_output_its_dependencies(fmus: dict[str, Path]) -> None:
    for name, fmu in fmus.items():
        with zipfile.ZipFile(fmu) as archive:
            root = ElementTree.fromstring(archive.read("modelDescription.xml"))
        units = {unit.get("name") for unit in root.iter("Unit")}
        assert {real.get("unit") for real in root.iter("Real")} == units, name
        variables = list(root.iter("ScalarVariable"))
        outputs = {i for i, variable in enumerate(variables, 1) if variable.get("causality") == "output"}
        for part in ("Outputs", "InitialUnknowns"):
            unknowns = root.findall(f"ModelStructure/{part}/Unknown")
            assert {int(unknown.get("index", "0")) for unknown in unknowns} == outputs, name
            assert all(unknown.get("dependencies") is not None for unknown in unknowns), name
