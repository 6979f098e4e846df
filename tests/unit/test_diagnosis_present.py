"""What is written after the verdict, where the co-simulation cannot follow, and where two laws were found at once."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis import present
from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.diagnose import Diagnosis, Request
from orchestrator.diagnosis.hypothesis import joined
from orchestrator.diagnosis.landing import RATES, SPIN, Course
from orchestrator.diagnosis.observation import Observation, Track
from orchestrator.diagnosis.outcome import Estimate, Outcome
from orchestrator.diagnosis.revision import write_revision
from orchestrator.diagnosis.terms.dictionary import dictionary
from orchestrator.diagnosis.terms.found import Found
from orchestrator.errors import UnitError

ZUPP = Path(__file__).resolve().parents[2] / "scenarios" / "apollo11_zupp.toml"


def addresses_of(path: Path) -> Addresses:
    return Addresses(draw_up(read_scenario(path), path))


def test_a_verdict_is_written_also_where_the_co_simulation_fails(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def fails(*_: Any) -> None:
        raise UnitError("revised.toml: the scenario has no unit body_term; insert a BodyTerm")

    monkeypatch.setattr(present, "_proven", fails)
    monkeypatch.setattr(present, "_courses", lambda *_: [])
    some: Any = SimpleNamespace()
    request, diagnosis = Request(ZUPP, (), out=tmp_path), Diagnosis(Outcome("nothing_missing"), some, None, some)
    with pytest.raises(UnitError, match=r"insert a BodyTerm \(the search's verdict is in .*: Nothing is missing that these data"):
        present.present(request, diagnosis)
    kept = json.loads((tmp_path / "diagnosis.json").read_text("utf-8"))
    assert kept["verdict"] == "nothing_missing"
    assert "no unit body_term" in kept["warnings"][0]
    assert (tmp_path / "report.html").is_file()


def test_what_an_earlier_verdict_left_is_gone_but_not_what_this_one_was_given(tmp_path: Path) -> None:
    left = ["revised.toml", "landing_1.toml", "report.html", "before_after.csv", "figures/where.png", "courses/fit.csv", "found/term.toml"]
    kept = [".work/tasks", "notes.txt", "figures/own.svg", "found/deeper/own.toml"]
    for name in (*left, *kept):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    present.clear_earlier(Request(tmp_path / "landing_1.toml", (), effects=(tmp_path / "found",), out=tmp_path))
    assert [name for name in left if (tmp_path / name).exists()] == ["landing_1.toml", "found/term.toml"]
    assert all((tmp_path / name).exists() for name in kept)


def test_two_laws_found_at_once_are_both_revised_kept_and_have_their_units(tmp_path: Path) -> None:
    zupp, terms = addresses_of(ZUPP), {term.name: term for term in dictionary()}
    torque, soil = terms["body_Tx_constant"], next(term for term in terms.values() if term.port == "soil.normal" and not term.equals)
    hypotheses = [term.hypothesis(zupp) for term in (soil, torque)]
    assert hypotheses[0] is not None
    assert hypotheses[1] is not None
    fit: Any = None
    one, two = (Estimate(value, 10.0, unit) for value, unit in ((300.0, soil.measure), (600.0, torque.measure)))
    second = Found(torque, two, 80.0, 0.5, True, (), {}, {}, joined(*hypotheses), fit)
    found = Found(soil, one, 80.0, 0.5, True, (), {}, {}, joined(*hypotheses), fit, second=second)
    setup: Any = SimpleNamespace(addresses=zupp)
    named = present._named(Diagnosis(Outcome("none_of_my_effects"), setup, found=found), found.name)
    revised = addresses_of(write_revision(tmp_path, zupp, named))
    assert revised.base_value(soil.coefficient).tolist() == [300.0]
    assert revised.base_value(torque.coefficient).tolist() == [600.0]
    request = Request(ZUPP, (), out=tmp_path)
    for it in found.both:
        present._keep_term(request, it, setup)
    assert {path.stem for path in (tmp_path / "found").glob("*.toml")} == {soil.name, torque.name}
    assert len(list((tmp_path / "found").glob("*.fmu"))) == 2


def test_a_simulated_course_is_drawn_when_the_fitted_clocks_say_it_was() -> None:
    """A course that counts s since first contact; the clock has 50 s there, as fitted 30 ms more, and in this series 20 ms."""
    times = np.arange(0.0, 1.0, 0.05)
    track = Track("rates", "rates.yaw", "rates.yaw", 50.0 + times, np.zeros(len(times)), 0.01, None)
    observation = Observation([track], [])
    observation.shift = 50.0
    zeros = np.zeros(len(times))
    course = Course(np.arange(0.0, 1.2, 0.05), {name: np.arange(0.0, 1.2, 0.05) for name in (*RATES, *SPIN)}, {})
    late = {"time.origin": 0.03, "clock.rates": 0.02}
    drawn = present._channel(observation, 0, [(course, {}), (course, late), (None, {})], zeros, None, None)
    inside = (drawn.times > 50.1) & (drawn.times < 50.9)
    assert drawn.before_fitted is not None
    assert (drawn.times - drawn.before)[inside] == pytest.approx(50.0, abs=1e-3)
    assert (drawn.times - drawn.before_fitted)[inside] == pytest.approx(50.05, abs=1e-3)
    assert drawn.unit == "rad/s"
