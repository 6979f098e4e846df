"""Units: one file an FMU. A file in this folder that defines one Unit is found by itself; nothing is to be registered."""

import importlib
from collections.abc import Iterator
from pathlib import Path

from ..shell import Unit


def unit_files() -> list[str]:
    """The names of the modules in this folder."""
    return sorted(file.stem for file in Path(__file__).parent.glob("*.py") if not file.stem.startswith("_"))


def unit_in(file: str) -> type[Unit]:
    """The one Unit that a module of this folder defines."""
    module = importlib.import_module(f".{file}", __name__)
    found = [it for it in vars(module).values() if isinstance(it, type) and issubclass(it, Unit) and it.__module__ == module.__name__]
    if len(found) != 1:
        raise ImportError(f"units/{file}.py defines {len(found)} units, expects one")
    return found[0]


def units() -> Iterator[type[Unit]]:
    """All units; a file that cannot be imported raises."""
    return (unit_in(file) for file in unit_files())
