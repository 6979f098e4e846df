"""An FMU in the hands of FMPy, by names of variables; and packages with one file changed, packed into FMUs."""

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import lander
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    calloc,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    free,
)

PACKAGE = Path(lander.__file__).parent
OK, DISCARD = 0, 2


class Hosted:
    """One instance of an FMU that is unpacked in a folder."""

    def __init__(self, folder: Path, name: str = "it", initialise: bool = True, **start: float) -> None:
        self.description = read_model_description(str(folder))
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        self.log: list[str] = []
        self.slave = FMU2Slave(guid=self.description.guid, unzipDirectory=str(folder), instanceName=name,
                               modelIdentifier=self.description.coSimulation.modelIdentifier)
        self.slave.instantiate(callbacks=self.callbacks(), loggingOn=True)
        self.begin(initialise, **start)

    def begin(self, initialise: bool = True, **start: float) -> None:
        """From instantiated to ready to step."""
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        for name, value in start.items():
            self[name] = value
        if initialise:
            self.slave.exitInitializationMode()

    def callbacks(self) -> fmi2CallbackFunctions:
        """A logger that keeps the messages."""
        def keep(environment: Any, name: bytes, status: int, category: bytes, message: bytes) -> None:
            self.log.append(message.decode())
        functions = fmi2CallbackFunctions()
        functions.logger = fmi2CallbackLoggerTYPE(keep)
        functions.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
        functions.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        return functions

    def references(self, kind: str, *causalities: str) -> list[int]:
        return [v.valueReference for v in self.description.modelVariables if v.type == kind and v.causality in causalities]

    def __getitem__(self, name: str) -> Any:
        variable = self.variables[name]
        value = getattr(self.slave, f"get{variable.type}")([variable.valueReference])[0]
        return value.decode() if isinstance(value, bytes) else value

    def __setitem__(self, name: str, value: float) -> None:
        variable = self.variables[name]
        getattr(self.slave, f"set{variable.type}")([variable.valueReference], [value if variable.type == "Real" else int(value)])

    def everything(self) -> list[float]:
        """All Real variables, for comparison to the last bit."""
        values: list[float] = self.slave.getReal(self.references("Real", "parameter", "input", "output", "local"))
        return values

    def step(self, time: float, step: float) -> int:
        """The status of a doStep."""
        try:
            self.slave.doStep(time, step)
        except FMICallException as error:
            status: int = error.status
            return status
        return OK

    def bytes_of_state(self) -> bytes:
        state = self.slave.getFMUState()
        content = bytes(self.slave.serializeFMUState(state))
        self.slave.freeFMUState(state)
        return content


def package_with(folder: Path, **units: str) -> Path:
    """A folder with a copy of the package in which some files of `units` are other text."""
    shutil.copytree(PACKAGE, folder / "lander", ignore=shutil.ignore_patterns("__pycache__"))
    for file, text in units.items():
        (folder / "lander" / "units" / f"{file}.py").write_text(text)
    return folder


def packed_from(folder: Path, file: str) -> Path:
    """The FMU of units/FILE.py of the package in a folder, packed by a process of its own."""
    code = (f"import sys; sys.path.insert(0, {str(folder)!r}); from pathlib import Path; from lander.shell.packing import packed;"
            f"from lander.units import unit_in; print(packed(unit_in({file!r}), Path({str(folder)!r})))")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return Path(done.stdout.strip())


__all__ = ["DISCARD", "OK", "PACKAGE", "Hosted", "package_with", "packed_from"]
