"""Build every FMU of this project, each in a process of its own.

    python build_fmus.py                      all units, into build/fmus
    python build_fmus.py GearLeg --out DIR    some of them, elsewhere

    python build_fmus.py --reference RateSensor   run its reference experiment anew and keep the result in fmus/reference
    python build_fmus.py --icons                  draw the icons anew and keep them in fmus/icons

After building, each FMU is run for one step, so that numba's compiled code is in the user's cache (--no-warm leaves
that out). As many units at a time as there are cores. The same sources give the same bytes.
"""

import argparse
import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT / "fmus"))

FOLDER = ROOT / "build" / "fmus"
DEAREST = "lunar_lander"  # compiles longest, so that it goes first


def files_by_name() -> dict[str, str]:
    """The file of each unit by the unit's name in lower case: gearleg → gear_leg."""
    folder = ROOT / "fmus" / "lander" / "units"
    return {file.stem.replace("_", ""): file.stem for file in sorted(folder.glob("*.py")) if not file.stem.startswith("_")}


def pack(file: str, folder: Path) -> None:
    """Pack one unit; in a process of its own."""
    from lander.shell.packing import packed
    from lander.units import unit_in

    print(packed(unit_in(file), folder))


def refer(file: str) -> None:
    """Write a unit's reference experiment; a unit without stimulus has none."""
    from lander.shell.reference import FOLDER, reference_text
    from lander.units import unit_in

    unit = unit_in(file)
    if unit.stimulus(unit.experiment[0]):
        FOLDER.mkdir(exist_ok=True)
        (FOLDER / f"{unit.__name__}.csv").write_text(reference_text(unit), "utf-8")


def draw_icons() -> None:
    """Draw every icon anew."""
    sys.path.insert(0, str(ROOT / "fmus" / "icons"))
    from drawings import draw_all

    draw_all()


def warm(fmu: Path) -> None:
    """Instantiate an FMU and do one step of it; in a process of its own, which ends at once: see PyState in pythonfmu."""
    from fmpy import extract, read_model_description
    from fmpy.fmi2 import FMU2Slave

    description = read_model_description(str(fmu))
    unit = FMU2Slave(guid=description.guid, unzipDirectory=extract(str(fmu)), instanceName="warm",
                     modelIdentifier=description.coSimulation.modelIdentifier)
    unit.instantiate(loggingOn=True)
    unit.setupExperiment(startTime=0.0)
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    unit.doStep(0.0, float(description.defaultExperiment.stepSize))
    unit.freeInstance()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


def run_alone(job: str, argument: str, folder: Path, plain: bool) -> tuple[bool, str]:
    """One job in a process of its own: whether it went well, and its last line."""
    environment = dict(os.environ, LANDER_PLAIN_PYTHON="1") if plain else dict(os.environ)
    result = subprocess.run([sys.executable, __file__, "--job", job, argument, "--out", str(folder)],
                            capture_output=True, text=True, env=environment, check=False)
    lines = (result.stdout + result.stderr).strip().splitlines()
    return result.returncode == 0, lines[-1] if lines else f"ended with {result.returncode}"


def build(file: str, folder: Path, warming: bool) -> bool:
    """Build one unit and warm it; one line says how it went."""
    begin = time.perf_counter()
    good, line = run_alone("pack", file, folder, plain=True)      # packing needs no compiled laws
    if not good:
        print(f"{file}: not built: {line}", flush=True)
        return False
    path, said = Path(line), ""
    if warming:
        good, line = run_alone("warm", str(path), folder, plain=False)
        said = ", one step run" if good else f", but one step failed: {line}"
    shown = path.relative_to(ROOT) if path.is_relative_to(ROOT) else path
    print(f"{shown}: {path.stat().st_size / 1e3:.0f} kB, {time.perf_counter() - begin:.1f} s{said}", flush=True)
    return good


def main() -> int:
    """The command line: 0 when all was built, 1 when something was not, 2 for an unknown name."""
    parser = argparse.ArgumentParser(description="Build the FMUs.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="units to build; all without")
    parser.add_argument("--out", type=Path, default=FOLDER, help="where to (default build/fmus)")
    parser.add_argument("--no-warm", action="store_true", help="leave the compiled code to the first run")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="units at a time (default: one a core)")
    parser.add_argument("--reference", action="store_true", help="write the reference experiments anew")
    parser.add_argument("--icons", action="store_true", help="draw the icons anew")
    parser.add_argument("--job", choices=("pack", "refer", "warm"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.jobs < 1:
        parser.error(f"--jobs {options.jobs}: must be 1 or more")
    if options.job:
        {"pack": lambda it: pack(it, options.out), "refer": refer, "warm": lambda it: warm(Path(it))}[options.job](options.names[0])
        return 0
    if options.icons:
        draw_icons()
    known = files_by_name()
    for name in options.names:
        if name.lower().replace("_", "") not in known:
            print(f"{name}: no such unit; there are {', '.join(known.values())}")
            return 2
    chosen = [known[name.lower().replace("_", "")] for name in options.names] or list(known.values())
    if options.reference:
        for file in chosen:
            good, line = run_alone("refer", file, FOLDER, plain=False)
            if not good:
                print(f"{file}: no reference: {line}")
                return 1
    in_order = sorted(chosen, key=lambda file: file != DEAREST)
    with ThreadPoolExecutor(options.jobs) as pool:
        results = list(pool.map(lambda file: build(file, options.out.resolve(), not options.no_warm), in_order))
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
