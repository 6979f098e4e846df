"""What a host that is not Python needs to run FMUs that are: `orchestrator host-env`.

The binary of an FMU made with pythonfmu calls Python's C functions and brings no Python: it takes the one it finds in the process. A host
that is no Python interpreter must therefore load libpython itself before the FMU (LD_PRELOAD), and the interpreter so started must be told
where its own library (PYTHONHOME) and the packages the units use, numpy and numba, are (PYTHONPATH).
"""

from __future__ import annotations

import os
import sys
import sysconfig
from pathlib import Path
from typing import Annotated

import typer

from orchestrator.errors import UserError

_SYSTEM = ("/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/lib64", "/usr/lib", "/usr/local/lib")
_PRELOAD = "DYLD_INSERT_LIBRARIES" if sys.platform == "darwin" else "LD_PRELOAD"


def python_library() -> Path | None:
    """The shared library of the Python that runs this; None where there is none."""
    folders = [str(sysconfig.get_config_var("LIBDIR")), f"{sys.base_prefix}/lib", *_SYSTEM]
    ending = "dylib" if sys.platform == "darwin" else "so.1.0"
    names = [str(sysconfig.get_config_var("INSTSONAME")), f"libpython{sys.version_info.major}.{sys.version_info.minor}.{ending}"]
    for folder in folders:
        for name in names:
            path = Path(folder) / name
            if path.suffix != ".a" and path.is_file():
                return path
    return None


def host_environment() -> dict[str, str]:
    """The variables; UserError where this Python cannot be loaded into another program."""
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    library = python_library()
    if library is None:
        raise UserError(
            f"host-env: {sys.executable} brings no shared libpython{version}, which the units need in a host that is not Python;"
            f" install it (Debian: libpython{version}) or use a Python built with --enable-shared"
        )
    packages = dict.fromkeys(sysconfig.get_paths()[name] for name in ("purelib", "platlib"))
    return {_PRELOAD: str(library), "PYTHONHOME": sys.base_prefix, "PYTHONPATH": os.pathsep.join(packages)}


def host_env(
    command: Annotated[list[str] | None, typer.Argument(help="A host to start with this environment; without, it is printed.")] = None,
) -> None:
    """What a host that is not Python (C++, a simulation tool) needs in its environment to run our FMUs.

    `env $(orchestrator host-env) ./my_host` or `orchestrator host-env ./my_host its arguments`. docs/hosts.md says why.
    """
    variables = host_environment()
    if command:
        try:
            os.execvpe(command[0], command, {**os.environ, **variables})
        except OSError as error:
            raise UserError(f"host-env {command[0]}: cannot be started ({error.strerror}); give the path of a program") from None
    for name, value in variables.items():
        typer.echo(f"{name}={value}")
