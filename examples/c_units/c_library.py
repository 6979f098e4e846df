"""C sources -> an FMU's binary, and the parts of an FMU -> its file."""

import os
import re
import shutil
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import fmpy

HEADERS = Path(fmpy.__file__).parent / "c-code"


def compiler() -> list[str]:
    """What CC names, gcc or cc; on a machine without any the one that the package ziglang brings."""
    found = shutil.which(os.environ.get("CC", "gcc")) or shutil.which("cc")
    if found is not None:
        return [found]
    if find_spec("ziglang") is None:
        sys.exit("error: no C compiler: gcc is not on the PATH; pip install ziglang brings one, or name yours in CC")
    return [sys.executable, "-m", "ziglang", "cc", "-fno-sanitize=undefined"]


def compile_library(library: Path, sources: list[Path], fmi: int, flags: list[str] | None = None) -> None:
    """The sources, and every function of FMI's header that they do not define as one that returns an error."""
    declared = re.findall(r"TYPE\s+(fmi\d\w+);", (HEADERS / f"fmi{fmi}Functions.h").read_text())
    weak = '__attribute__((weak)) {} {}(void) {{ return {}; }}\n'
    rest = library.with_name("rest.c")
    rest.write_text("".join(weak.format("void*", n, 0) if "Instantiate" in n else weak.format("int", n, 3) for n in declared))
    command = [*compiler(), "-shared", "-fPIC", "-O2", "-w", *(flags or []), f"-I{HEADERS}", "-o", str(library)]
    subprocess.run([*command, *map(str, sources), str(rest), "-lm"], check=True)


def pack(fmu: Path, description: bytes, library: Path, fmi: int, further: dict[str, bytes] | None = None) -> Path:
    """The .fmu, with dates that do not change."""
    folder = fmpy.platform_tuple if fmi == 3 else fmpy.platform
    binary = f"binaries/{folder}/{fmu.stem}{fmpy.sharedLibraryExtension}"
    files = {"modelDescription.xml": description, binary: library.read_bytes()}
    with zipfile.ZipFile(fmu, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in (files | (further or {})).items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return fmu
