"""A law that no effect of the library has is found at its port.

Setup      the Zupp-like touchdown of Apollo 11 by the twin's FMU, Apollo's channels every 40 ms for 2.4 s with white noise; hidden is
           F_n += c (δ/0.01 m) (|δ̇|/0.1 m/s)² while sinking; nuisances as published, drawn at random; the library has friction only
Tolerance  the port must be right and the hidden form in the class; c within four standard deviations where the form itself was named.
           In a like case (c = 53 N), whose base fit was no false minimum, the port led by 25 in ln evidence, the form in a class of two
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.effects.library import load_library
from orchestrator.diagnosis.found_term import write_effect
from orchestrator.diagnosis.measured.landing import Measured, Prior, Scalar, Series
from orchestrator.diagnosis.problem import Model
from orchestrator.diagnosis.setup import Setup, set_up
from orchestrator.diagnosis.stages import align, run_search
from orchestrator.diagnosis.terms.dictionary import dictionary, in_scenario
from orchestrator.diagnosis.terms.find_term import find_term
from orchestrator.diagnosis.terms.found import as_term, to_outcome

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
SCENARIO = SCENARIOS / "apollo11_zupp.toml"
HIDDEN, COEFFICIENT = "normal_depth1_rate2_sinking", 80.0
AXES = ("yaw", "pitch", "roll")


def blank() -> Measured:
    """Apollo's channels and what was known before the landing."""
    times = np.arange(0.0, 2.4, 0.04)
    zeros = np.zeros((len(times), 3))
    series = [
        Series(name, tuple(f"{name}.{axis}" for axis in AXES), times, zeros, np.full(3, sigma), None, (unit,) * 3)
        for name, sigma, unit in (("rates", 0.0017, "rad/s"), ("attitude", 0.0009, "rad"))
    ]
    sizes = {"stroke.{}.right": 0.00635, "stroke.{}.left": 0.00635, "stroke.{}.primary": 0.00635, "penetration.{}": 0.01, "skid.{}": 0.01}
    names = {name.format(leg): sigma for leg in ("+Z", "+Y", "-Z", "-Y") for name, sigma in sizes.items()}
    values = [Scalar(name, "value", 0.0, sigma, -np.inf, np.inf, "m") for name, sigma in names.items()]
    known = (
        ("velocity_body", [-0.573, -0.6147, -0.213], 0.03, "m/s"),
        ("attitude", [0.2634, 0.01646, 0.04442], 0.0035, "rad"),
        ("rates", [-0.0108, 0.0, -0.05], 0.00175, "rad/s"),
        ("soil.friction", [0.33], 0.03, ""),
    )
    priors = [Prior(name, np.array(mean), np.full(len(mean), sigma), None, unit) for name, mean, sigma, unit in known]
    return Measured("hidden term", "made", Path("landing"), series, values, priors)


def landed(setup: Setup, measured: Measured) -> Measured:
    """The data that the hidden law leaves."""
    random = np.random.default_rng(11)
    _, hypothesis = in_scenario(dictionary(), setup.addresses)[HIDDEN]
    coordinates = [*setup.nuisances[:-1], *hypothesis.coordinates]
    z = np.append(random.standard_normal(len(coordinates) - 1), COEFFICIENT / hypothesis.coordinates[0].sigma)
    lander = setup.make()
    rows = Model(setup.landings, coordinates, lander).predict(z)
    lander.close()
    assert rows is not None
    place = iter(setup.landings.observations[0].places)
    series = []
    for one in measured.series:
        columns = [rows[next(place)] + one.sigma[i] * random.standard_normal(len(one.times)) for i in range(3)]
        series.append(replace(one, values=np.column_stack(columns)))
    values = [replace(one, value=float(rows[next(place)][0] + one.sigma * random.standard_normal())) for one in measured.values]
    return replace(measured, series=series, values=values)


@pytest.mark.long
@pytest.mark.xfail(
    strict=False,
    reason="from a base fit in a false minimum a torque on the body was found; since terms climb: no result in 330 s on a loaded machine",
)
def test_a_hidden_law_of_the_soil_is_found_at_its_port(tmp_path: Path) -> None:
    blueprint = draw_up(read_scenario(SCENARIO), SCENARIO)
    effects = {name: effect for name, effect in load_library([SCENARIOS / "candidates"]).items() if name == "friction"}
    first = set_up(blueprint, [blank()], effects, SCENARIOS / "tolerances.toml")
    setup = set_up(blueprint, [landed(first, blank())], effects, SCENARIOS / "tolerances.toml")
    crew = Crew(setup.make)
    assert align(setup, crew) == ""
    state = run_search(setup, crew, 0, None, setup.hypotheses)
    flown = crew.flown
    found = find_term(state, setup, crew, 0)
    assert found is not None
    assert crew.flown - flown < 900
    assert found.term.port == next(iter(found.ports)) == "soil.normal"
    assert HIDDEN in [found.term.name, *(rival.term.name for rival in found.rivals)]
    assert found.adequate
    if found.term.name == HIDDEN:
        assert found.coefficient.value == pytest.approx(COEFFICIENT, abs=4.0 * found.coefficient.sigma)
    assert state.fits[found.name] is found.fit
    assert found.hypothesis in state.hypotheses
    assert to_outcome(found)["unit"] == "soil"
    assert write_effect(tmp_path, as_term(found, setup.addresses)).is_file()
    crew.close()
