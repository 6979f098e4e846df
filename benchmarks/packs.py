"""Benchmark units become FMUs: packed with the project's shell, from a copy of its package that has the unit's file added."""

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HERE = ROOT / "benchmarks"
PACKAGE = ROOT / "fmus" / "lander"
FOLDER = ROOT / "build" / "benchmarks" / "fmus"
CODE = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from lander.shell.packing import packed
from lander.units import unit_in
for file in sys.argv[3:]:
    packed(unit_in(file), Path(sys.argv[2]))
"""


def quarter_vehicle_fmus() -> dict[str, Path]:
    """Both FMUs of the quarter vehicle."""
    source = HERE / "quarter_vehicle"
    return packed({file.stem: file.read_text("utf-8") for file in source.glob("*.py")}, ["quarter_vehicle", "quarter_soil"], FOLDER)


def packed(texts: dict[str, str], units: Sequence[str], folder: Path) -> dict[str, Path]:
    """FMUs of the unit files in `units`, by unit name; `texts` are all files to add, by stem."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as copy:
        shutil.copytree(PACKAGE, Path(copy) / "lander", ignore=shutil.ignore_patterns("__pycache__"))
        for stem, text in texts.items():
            (Path(copy) / "lander" / "units" / f"{stem}.py").write_text(text, "utf-8")
        command = [sys.executable, "-c", CODE, copy, str(folder), *units]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"benchmark units: not packed: {done.stderr.strip().splitlines()[-1]}")
    return {name: folder / f"{name}.fmu" for name in ("".join(word.capitalize() for word in unit.split("_")) for unit in units)}
