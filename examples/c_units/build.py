"""Builds the units in C as FMUs: `python examples/c_units/build.py` writes them to build/foreign.

    Gnc2.fmu, Gnc3.fmu     guidance, FMI 2.0 and 3.0 from one source
    Soil2.fmu              regolith without rollback (canGetAndSetFMUstate is false)
    Sensor3.fmu            rate gyro in degrees a second, FMI 3.0

Takes a C compiler (gcc, what CC names, or `pip install ziglang`) and FMI's headers, which come with FMPy. A unit of your own: a table in
tables.py, a C file with unit_start and unit_step (unit.h), and a line in UNITS.
"""

import argparse
import hashlib
import re
import tempfile
from pathlib import Path

from c_library import compile_library, pack
from description import model_description, places, terminals
from tables import GNC, SENSOR, SOIL, Table

HERE = Path(__file__).resolve().parent
UNITS = (
    ("Gnc2", "gnc.c", GNC, 2, True),
    ("Gnc3", "gnc.c", GNC, 3, True),
    ("Soil2", "soil.c", SOIL, 2, False),
    ("Sensor3", "sensor.c", SENSOR, 3, True),
)
"""Name, source, variables, FMI, whether its state can be kept."""


def names_header(table: Table, token: str) -> str:
    """Places, start values and sizes for the C source."""
    named = {re.sub(r"\W", "_", name).upper(): place for name, place in places(table).items()}
    starts = [start for variable in table.variables for start in variable.starts]
    sizes = [size for variable in table.variables for size in (variable.size, *[1] * (variable.size - 1))]
    return (
        f'#define TOKEN "{token}"\nenum {{ {", ".join(f"{name} = {place}" for name, place in named.items())}, VALUES = {len(starts)} }};\n'
        f"static const double START[VALUES] = {{{', '.join(map(repr, starts))}}};\n"
        f"static const int SIZE[VALUES] = {{{', '.join(map(str, sizes))}}};\n"
    )


def build(name: str, source: str, table: Table, fmi: int, states: bool, out: Path) -> Path:
    shell = HERE / f"fmi{fmi}.c"
    content = b"".join(file.read_bytes() for file in (HERE / source, shell, HERE / "unit.h")) + repr((table, states)).encode()
    token = "{" + hashlib.sha256(content).hexdigest()[:32] + "}"
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        (scratch / "names.h").write_text(names_header(table, token))
        library = scratch / f"{name}.so"
        flags = [f"-I{HERE}", f"-I{scratch}", *(["-DSTATES"] if states else [])]
        compile_library(library, [HERE / source, shell], fmi, flags)
        drawn = {"terminalsAndIcons/terminalsAndIcons.xml": terminals(table, fmi)}
        return pack(out / f"{name}.fmu", model_description(name, table, token, fmi, states), library, fmi, drawn)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--out", type=Path, default=HERE.parents[1] / "build" / "foreign", help="folder for the FMUs")
    out = parser.parse_args().out
    for entry in UNITS:
        print(build(*entry, out))


if __name__ == "__main__":
    main()
