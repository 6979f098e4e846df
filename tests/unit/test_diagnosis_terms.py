"""Generic terms: the dictionary, and the regression on a lander that is linear and costs nothing."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.landing import Course
from orchestrator.diagnosis.observation import Observation, Track
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.search import Search
from orchestrator.diagnosis.terms.dictionary import dictionary
from orchestrator.diagnosis.terms.find_term import told_of, with_second
from orchestrator.diagnosis.terms.found import Found, to_outcome
from orchestrator.diagnosis.terms.linear import View, White, linear, port_evidence, whitened
from orchestrator.diagnosis.terms.regress import Regression, regressed
from orchestrator.diagnosis.terms.term import Term

Array = NDArray[np.float64]
TERMS = {term.name: term for term in dictionary()}
STOP, SIGMA = 4.0, 0.05
TIMES = np.arange(0.02, STOP - 0.02, 0.02)
QUADRATIC, TIMES_DEPTH, LINEAR = "normal_depth0_rate2_sinking", "normal_depth1_rate2_sinking", "normal_depth0_rate1_sinking"
SLIP, STRUT, TILT = "tangent_depth0_speed1_slide0_slip", "struts_stroke1_rate0_against_stroke", "body_Tz_tilt"
FREQUENCIES = {LINEAR: 3.0, SLIP: 4.3, STRUT: 5.9, TILT: 7.1, QUADRATIC: 9.2}


def shape(name: str, t: Array) -> Array:
    """Of a term's signature; two of them are alike."""
    if name == TIMES_DEPTH:
        return shape(QUADRATIC, t) + 0.03 * np.cos(11.0 * t)
    return np.exp(-0.5 * t) * np.sin(FREQUENCIES[name] * t)


class LinearLander:
    """y = n sin 2t + Σ c/sigma shape: every term's signature in proportion to its coefficient."""

    varies = False

    def land(
        self, values: Mapping[str, float], grid: Array, columns: Sequence[str], final: Sequence[str], beside: object = None
    ) -> Course:
        y = values["n"] * np.sin(2.0 * grid)
        for name in (*FREQUENCIES, TIMES_DEPTH):
            term = TERMS[name]
            if all(values.get(address) == value for address, value in term.fixed):
                y = y + values.get(term.coefficient, 0.0) / term.sigma * shape(name, grid)
        return Course(grid, {"y": y}, {})

    def close(self) -> None: ...


def hypothesis(term: Term) -> Hypothesis:
    coordinate = Coordinate(term.name, ((term.coefficient, 1.0),), term.sigma, fixed=tuple((a, float(v)) for a, v in term.fixed))
    return Hypothesis(term.name, (coordinate,))


def regression(hidden: str, size: float, also: str = SLIP, also_size: float = 0.0) -> Regression:
    """Of data in which `hidden` has the coefficient size times its prior's sigma, and another term its own."""
    signal = size * shape(hidden, TIMES) + also_size * shape(also, TIMES)
    y = 0.7 * np.sin(2.0 * TIMES) + signal + SIGMA * np.random.default_rng(5).standard_normal(len(TIMES))
    landings = Landings([Observation([Track("s", "y", "y", TIMES, y, SIGMA, 0.0)], [])], [{"n": 0.0}], [STOP])
    search = Search(landings, [Coordinate("n", (("n", 1.0),), 1.0)], [], Crew(LinearLander))
    terms = {name: TERMS[name] for name in (*FREQUENCIES, TIMES_DEPTH)}
    return Regression(search, terms, {name: hypothesis(term) for name, term in terms.items()})


def found(hidden: str, size: float, offered: Sequence[str] = (*FREQUENCIES, TIMES_DEPTH)) -> Found:
    known = regression(hidden, size)
    base = known.search.base()
    winner = regressed(known, base, None, offered)
    assert winner is not None
    return told_of(known, winner, set(offered), base.log_evidence, 0)


def test_the_dictionary_holds_sixty_to_a_hundred_terms_each_once() -> None:
    assert 60 <= len(TERMS) == len(dictionary()) <= 100
    assert len({(t.coefficient, t.fixed) for t in dictionary()}) == len(TERMS)
    assert len({t.dependence for t in dictionary()}) == len(TERMS)
    assert {t.port for t in dictionary()} == {"soil.normal", "soil.tangential", "strut", "body", "sensor"}


def test_a_name_can_stand_in_a_pair_and_on_a_file() -> None:
    assert all(name.replace("_", "").isalnum() for name in TERMS)


def test_a_term_says_where_how_when_and_what_it_does_to_the_energy() -> None:
    term = TERMS["normal_depth0_rate2_sinking"]
    assert term.words(1.0) == "pad normal, quadratic in sink rate, while sinking, dissipative"
    assert term.formula == "F_n += c (|δ̇|/0.1 m/s)² while sinking"
    assert term.equals == "inertial_drag"


def test_a_resisting_term_with_the_wrong_sign_is_called_active() -> None:
    for term in dictionary():
        if term.positive == "dissipative":
            assert term.energy(-1.0) == "active"
    assert TERMS["body_Fy_speed"].energy(-1.0) == "dissipative"


def test_a_standard_deviation_is_the_same_force_at_the_reference_point() -> None:
    for term in dictionary():
        if term.port == "soil.normal":
            powers = dict(term.fixed)
            assert term.sigma * 5.0 ** powers["soil.normal_term_depth"] * 3.0 ** powers["soil.normal_term_rate"] == pytest.approx(2000.0)


def test_a_linear_gain_is_the_difference_of_two_exact_evidences() -> None:
    random = np.random.default_rng(2)
    jacobian, columns, residual, z = (random.standard_normal(size) for size in ((40, 3), (40, 2), 40, 3))
    white = White(("a", "b"), jacobian, 2.0 * columns, residual, z)
    got = linear(white)

    def exact(jacobian: Array, z: Array) -> float:
        # the residual is r at z: r + J z = J z' + noise with z' ~ N(0, 1)
        covariance = np.eye(40) + jacobian @ jacobian.T
        data = white.residual + jacobian @ z
        return float(-0.5 * data @ np.linalg.solve(covariance, data) - 0.5 * np.linalg.slogdet(covariance)[1])

    assert got.null == pytest.approx(exact(white.jacobian, white.z), rel=1e-9)
    for i in range(2):
        with_term = exact(np.column_stack([white.jacobian, white.columns[:, i]]), np.append(white.z, 0.0))
        assert got.evidence[i] == pytest.approx(with_term, rel=1e-9)


def test_a_port_gains_nothing_by_having_more_terms() -> None:
    got = port_evidence({"a": 4.0, "b": 4.0, "c": 4.0, "d": 5.0}, {"a": "strut", "b": "strut", "c": "strut", "d": "body"})
    assert got == {"body": 5.0, "strut": pytest.approx(4.0)}
    assert list(got) == ["body", "strut"]


@pytest.mark.parametrize("hidden", [SLIP, STRUT, TILT, LINEAR])
def test_the_regression_finds_the_term_and_its_port(hidden: str) -> None:
    one = found(hidden, 0.6)
    assert one.term.name == hidden
    assert one.adequate
    assert not one.rivals
    assert next(iter(one.ports)) == TERMS[hidden].port
    assert one.coefficient.value == pytest.approx(0.6 * TERMS[hidden].sigma, abs=3.0 * one.coefficient.sigma)
    assert one.stability["port"] == 1.0


def test_forms_that_look_alike_are_given_as_one_class() -> None:
    one = found(QUADRATIC, 0.6)
    members = {one.term.name, *(rival.term.name for rival in one.rivals)}
    assert members == {QUADRATIC, TIMES_DEPTH}
    tree = to_outcome(one)
    assert len(tree["class"]) == 2
    assert "another form" in tree["sentence"]
    assert [rival["fixed"]["soil.normal_term_rate"] for rival in tree["rivals"]] == [2.0]
    json.dumps(tree)


def test_a_law_of_the_library_that_was_refused_is_not_offered_as_new_but_named() -> None:
    one = found(QUADRATIC, 0.6, [*(n for n in FREQUENCIES if n != QUADRATIC), TIMES_DEPTH])
    assert one.term.name == TIMES_DEPTH
    assert QUADRATIC not in [rival.term.name for rival in one.rivals]
    assert to_outcome(one)["known_as"] == ["inertial_drag"]


def test_a_wrong_sign_is_told_as_active() -> None:
    assert found(SLIP, -0.6).energy == "active"


def test_a_second_term_stands_beside_the_first_where_one_is_not_enough() -> None:
    known = regression(STRUT, 0.6, SLIP, 0.4)
    base = known.search.base()
    offered = [*FREQUENCIES]
    winner = regressed(known, base, None, offered)
    assert winner == STRUT
    alone = told_of(known, winner, set(offered), base.log_evidence, 0)
    assert not alone.adequate
    both = with_second(known, alone, offered, base.log_evidence)
    assert both.second is not None
    assert both.second.term.name == SLIP
    assert both.adequate
    assert both.name == f"{STRUT} + {SLIP}"
    assert both.second.coefficient.value == pytest.approx(0.4 * TERMS[SLIP].sigma, rel=0.1)
    assert to_outcome(both)["second"]["port"] == "soil.tangential"


def test_a_view_without_terms_still_has_nuisances() -> None:
    known = regression(SLIP, 0.0)
    base = known.search.base()
    white = whitened(known.search.landings, known.search.nuisances, View(base.z, base.predicted, base.slopes))
    assert linear(white).null == pytest.approx(base.log_evidence, abs=0.5)
