"""The built FMUs, one toy unit, and whoever drives them."""

import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fmpy import extract
from hosted import PACKAGE, Hosted, package_with, packed_from
from lander.shell.main_script import source_digest
from lander.units import unit_files

ROOT = Path(__file__).resolve().parents[2]
TOY = Path(__file__).with_name("mass_spring.py")


def is_of_these_sources(fmu: Path) -> bool:
    """Whether an FMU was built from the package as it is now."""
    if not fmu.exists():
        return False
    with zipfile.ZipFile(fmu) as archive:
        return archive.read("resources/slavemodule.txt").decode().endswith(source_digest(PACKAGE))


def names() -> list[str]:
    """The units' names, without importing them."""
    return ["".join(word.capitalize() for word in file.split("_")) for file in unit_files()]


@pytest.fixture(scope="session")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Every FMU by name: those in build/fmus if they are of the present sources, else built for this session."""
    built = {name: ROOT / "build" / "fmus" / f"{name}.fmu" for name in names()}
    if not all(is_of_these_sources(fmu) for fmu in built.values()):
        folder = tmp_path_factory.mktemp("fmus")
        command = [sys.executable, str(ROOT / "build_fmus.py"), "--no-warm", "--out", str(folder)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        built = {name: folder / f"{name}.fmu" for name in names()}
    return built


@pytest.fixture(scope="session")
def toy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of the mass on a spring."""
    return packed_from(package_with(tmp_path_factory.mktemp("toy"), mass_spring=TOY.read_text()), "mass_spring")


@pytest.fixture(scope="session")
def unpacked(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Path], Path]:
    """Unpack an FMU once: a binary that is loaded must not be written again."""
    folders: dict[Path, Path] = {}

    def folder_of(fmu: Path) -> Path:
        if fmu not in folders:
            folders[fmu] = tmp_path_factory.mktemp(fmu.stem)
            extract(str(fmu), unzipdir=str(folders[fmu]))
        return folders[fmu]

    return folder_of


@pytest.fixture
def host(unpacked: Callable[[Path], Path]) -> Iterator[Callable[..., Hosted]]:
    """Make instances of FMUs; they are freed at the test's end."""
    made: list[Hosted] = []

    def make(fmu: Path, **options: object) -> Hosted:
        made.append(Hosted(unpacked(fmu), **options))  # type: ignore[arg-type]
        return made[-1]

    yield make
    for one in made:
        one.slave.freeInstance()
