"""The script that an FMU's binary runs: it loads the package beside it under a name unique to its content.

All Python FMUs of a process share one interpreter, so that two versions of one package must not share one name. The
package is loaded from a folder per user, named by its content, where numba's cache outlives the FMU's unpacking; the
environment variable LANDER_UNITS_CACHE names another folder, or with an empty value none. pythonfmu runs this script at
every instantiation. It must be complete in itself: the packing copies its text and adds a last line.
"""

import contextlib
import hashlib
import importlib
import importlib.util
import os
import shutil
import sys
import tempfile
from pathlib import Path
from types import ModuleType
from typing import Any


def source_digest(package: Path) -> str:
    """Twelve hexadecimal digits from the names and bytes of a package's Python files."""
    digest = hashlib.sha256()
    for file in sorted(package.rglob("*.py"), key=lambda file: file.relative_to(package).as_posix()):
        content = file.read_bytes()
        digest.update(f"{file.relative_to(package).as_posix()}\n{len(content)}\n".encode() + content)
    return digest.hexdigest()[:12]


def cached_copy(package: Path, digest: str) -> Path:
    """The package's copy in the user's cache, made if need be; the package itself where that cannot be."""
    default = Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()) / "lander-units"
    folder = os.environ.get("LANDER_UNITS_CACHE", str(default))
    if not folder:
        return package
    copy = Path(folder) / digest / package.name
    try:
        if not copy.is_dir():
            copy.parent.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryDirectory(dir=copy.parent.parent) as unfinished:
                shutil.copytree(package, Path(unfinished) / digest / package.name, ignore=shutil.ignore_patterns("__pycache__"))
                with contextlib.suppress(OSError):  # another process was first
                    (Path(unfinished) / digest).rename(copy.parent)
        return copy if source_digest(copy) == digest else package
    except (OSError, RuntimeError):
        return package


def loaded(package: Path, name: str) -> ModuleType:
    """The package in a folder as the module `name`."""
    spec = importlib.util.spec_from_file_location(name, package / "__init__.py", submodule_search_locations=[str(package)])
    if spec is None or spec.loader is None:
        raise ImportError(f"no package in {package}")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def unit_class(namespace: dict[str, Any], file: str, unit: str, digest: str) -> type:
    """The class of a unit from the package beside the script with this namespace.

    pythonfmu 0.7's binary gives back, at each instantiation, a reference to the namespace that it does not own, and after
    five of them frees it in use. So one is added each time. It also leaves the resources on sys.path each time.
    """
    name, resources = f"lander_{digest}", Path(namespace["__file__"]).parent
    if name not in sys.modules:
        loaded(cached_copy(resources / "lander", digest), name)
    vars(sys.modules[name]).setdefault("held_namespaces", []).append(namespace)
    found: type = getattr(importlib.import_module(f"{name}.units.{file}"), unit)  # finds pythonfmu in the resources where the host has none
    sys.path[:] = [entry for entry in sys.path if entry != str(resources)]
    return found
