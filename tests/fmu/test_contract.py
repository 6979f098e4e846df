"""What a unit's description claims is true of the unit: dependencies of its initial values, its reference experiment."""

import csv
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hosted import OK, Hosted
from lander.units import unit_files

Host = Callable[..., Hosted]
NAMES = ["".join(word.capitalize() for word in file.split("_")) for file in unit_files()]


@pytest.mark.parametrize("name", NAMES)
def test_initial_outputs_depend_on_no_input_but_the_declared_ones(name: str, fmus: dict[str, Path], host: Host) -> None:
    one = host(fmus[name], initialise=False)
    variables = one.description.modelVariables
    outputs = [unknown for unknown in one.description.initialUnknowns if unknown.variable.type == "Real"]
    references = [unknown.variable.valueReference for unknown in outputs]
    declared = {unknown.variable.name: {known.name for known in unknown.dependencies} for unknown in outputs}
    before, undeclared = one.slave.getReal(references), set()
    for variable in [v for v in variables if v.causality == "input" and v.type == "Real"]:
        start = one[variable.name]
        one[variable.name] = start + 1e-2
        after = one.slave.getReal(references)
        one[variable.name] = start
        undeclared |= {(unknown.variable.name, variable.name) for unknown, old, new in zip(outputs, before, after, strict=True)
                       if old != new and variable.name not in declared[unknown.variable.name]}
    assert not undeclared, f"{name}: give `initially` or `depends`: {sorted(undeclared)[:5]} and {max(0, len(undeclared) - 5)} more"


@pytest.mark.parametrize("name", NAMES)
def test_the_reference_experiment_gives_its_result(name: str, fmus: dict[str, Path], host: Host) -> None:
    """Tolerance 1e-9 of a column's largest value: another machine's library functions differ in the last bits."""
    with zipfile.ZipFile(fmus[name]) as archive:
        lines = archive.read("documentation/reference.csv").decode().splitlines()
    one = host(fmus[name], initialise=False)
    for line in lines:
        if line.startswith("# "):
            parameter, _, value = line[2:].partition(" = ")
            one[parameter] = float(value)
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    inputs = [column for column in rows[0] if column != "time" and one.variables[column].causality == "input"]
    outputs = [column for column in rows[0] if column != "time" and column not in inputs]
    results, times = [], [float(row["time"]) for row in rows]
    for n, row in enumerate(rows):
        for column in inputs:
            one[column] = float(row[column])
        if n == 0:
            one.slave.exitInitializationMode()
        results.append([float(one[column]) for column in outputs])
        if n + 1 < len(rows):
            assert one.step(times[n], float(one.description.defaultExperiment.stepSize)) == OK, one.log
    expected = np.array([[float(row[column]) for column in outputs] for row in rows])
    error = np.abs(np.array(results) - expected).max(axis=0)
    scale = np.abs(expected).max(axis=0)
    assert [column for i, column in enumerate(outputs) if error[i] > 1e-9 * scale[i]] == []
