"""A found term as an FMU: in FMPy's hands it does what the unit does with the same parameters set, bit for bit."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from hosted import Hosted
from lander.shell.unit import Unit
from lander.units import unit_in

from orchestrator.diagnosis.term_fmu import build_term_fmu
from orchestrator.errors import UnitError

CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "RegolithContact": ("regolith_contact", {"normal_term": 900.0, "normal_term_rate": 2.0, "normal_term_phase": 1}),
    "GearLeg": ("gear_leg", {"strut_term": 300.0, "strut_term_phase": 3, "cg_offset": [0.0, 0.05]}),
    "BodyTerm": ("body_term", {"coefficient": -80.0, "axis": 5, "basis": 6}),
    "RateSensor": ("rate_sensor", {"time_constant": 0.1, "bias": [0.0, 0.01, 0.0]}),
}
STEPS = 20


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest, fmus: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path, Path]:
    unit = request.param
    folder = tmp_path_factory.mktemp("terms")
    return unit, fmus[unit], build_term_fmu(folder, fmus[unit], CASES[unit][1], f"Found{unit}")


def set_all(hosted: Hosted, parameters: Mapping[str, Any]) -> None:
    for name, value in parameters.items():
        for variable, number in [(f"{name}[{i}]", it) for i, it in enumerate(value, 1)] if isinstance(value, list) else [(name, value)]:
            hosted[variable] = number


def stepped(hosted: Hosted, unit: type[Unit], parameters: Mapping[str, Any]) -> np.ndarray:
    """All real outputs over the unit's reference experiment."""
    set_all(hosted, parameters)
    hosted.slave.exitInitializationMode()
    step, rows = unit.experiment[2], []
    for k in range(STEPS):
        for name, value in unit.stimulus(k * step).items():
            set_all(hosted, {name: list(value) if isinstance(value, tuple) else value})
        hosted.slave.doStep(k * step, step)
        rows.append(hosted.slave.getReal(hosted.references("Real", "output")))
    hosted.slave.freeInstance()
    return np.array(rows)


def test_it_does_what_the_unit_does_with_the_parameters_set(case: tuple[str, Path, Path], unpacked: Callable[[Path], Path]) -> None:
    name, original, found = case
    file, parameters = CASES[name]
    unit = unit_in(file)
    ours = stepped(Hosted(unpacked(found), initialise=False), unit, {})
    theirs = stepped(Hosted(unpacked(original), initialise=False), unit, parameters)
    plain = stepped(Hosted(unpacked(original), initialise=False), unit, {})
    assert (ours == theirs).all()
    assert not (ours == plain).all()


def test_its_description_says_what_it_is(case: tuple[str, Path, Path]) -> None:
    name, original, found = case
    ours, theirs = fmpy.read_model_description(str(found)), fmpy.read_model_description(str(original))
    assert validate_fmu(str(found)) == []
    assert (ours.modelName, ours.coSimulation.modelIdentifier) == (f"Found{name}", f"Found{name}")
    assert ours.guid != theirs.guid
    first, value = next(iter(CASES[name][1].items()))
    assert f"{first} = {value:g}" in ours.description
    starts = {it.name: it.start for it in ours.modelVariables}
    assert float(starts[first]) == value


def test_the_same_term_gives_the_same_bytes(fmus: dict[str, Path], tmp_path: Path) -> None:
    parameters = {"coefficient": 5.0}
    one, two = (build_term_fmu(tmp_path / folder, fmus["BodyTerm"], parameters, "Push") for folder in ("a", "b"))
    assert one.read_bytes() == two.read_bytes()
    assert build_term_fmu(tmp_path, fmus["BodyTerm"], {"coefficient": 6.0}, "Push").read_bytes() != one.read_bytes()


@pytest.mark.parametrize(
    ("parameters", "name", "says"),
    [
        ({"coefficient": 1.0}, "my term", "my term: is no name"),
        ({"axis": 9}, "T", "above its maximum 6"),
        ({"axes": 1}, "T", 'did you mean "axis"'),
    ],
)
def test_what_cannot_be_built_is_refused_in_one_line(fmus: dict[str, Path], tmp_path: Path, parameters: Any, name: str, says: str) -> None:
    with pytest.raises(UnitError, match=says):
        build_term_fmu(tmp_path, fmus["BodyTerm"], parameters, name)
