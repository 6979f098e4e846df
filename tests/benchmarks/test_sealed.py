"""The sealed cases: made again from a seed, out of the diagnosis' reach, and scored by rules that hand-made verdicts follow."""

import json
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))

from sealed import diagnoses, report, scoring, sealing, targets
from sealed.closure import _revised
from sealed.energy import energy, scaled_to
from sealed.hidden import Signatures
from sealed.instruments import noisy, observation, public
from sealed.kinds import SHARES, Plan, counts, plans
from sealed.make import FINE, _write_manifest, complete, made, make, scenes_of, unchanged
from sealed.pool import one_method, pooled
from sealed.scene import base_of, centred
from sealed.vehicle import ZUPP, Vehicle
from sealed.wilson import wilson

from orchestrator.diagnosis.fit import GAIN
from orchestrator.diagnosis.landing import TwinLander
from orchestrator.diagnosis.measured import read_measured


@pytest.fixture(scope="module")
def vehicle() -> Vehicle:
    return Vehicle()


@pytest.fixture(scope="module")
def lander(vehicle: Vehicle) -> Iterator[TwinLander]:
    lander = vehicle.lander(FINE)
    yield lander
    lander.close()


# Making


def test_a_set_is_the_same_from_the_same_seed(vehicle: Vehicle, tmp_path: Path) -> None:
    plan = plans(1, 7, ("null coloured",))[0]
    keys = [made(vehicle, plan, 7, tmp_path / name) for name in ("a", "b")]
    assert {k: v for k, v in keys[0].items() if k != "salt"} == {k: v for k, v in keys[1].items() if k != "salt"}
    files = sorted(path.relative_to(tmp_path / "a") for path in (tmp_path / "a").rglob("*.*"))
    assert len(files) == 6
    assert all((tmp_path / "a" / it).read_bytes() == (tmp_path / "b" / it).read_bytes() for it in files)


def test_what_is_handed_over_reads_and_is_near_the_truth(vehicle: Vehicle, tmp_path: Path) -> None:
    plan = plans(1, 8, ("null white",))[0]
    key = made(vehicle, plan, 8, tmp_path)
    for name in ("fit", "holdout"):
        measured = read_measured(tmp_path / name)
        assert {it.name for it in measured.series} == {"rates", "attitude"}
        assert len(measured.values) == 20
        rates = next(it for it in measured.series if it.name == "rates")
        n = len(rates.times)
        clean = np.array(key[name]["clean"])[: 3 * n].reshape(3, n)
        order = [rates.channels.index(f"rates.{axis}") for axis in ("yaw", "pitch", "roll")]
        assert np.std(rates.values[:, order].T - clean) == pytest.approx(0.0017, rel=0.2)


def test_bounds_hold_the_truth_and_do_not_count_as_values(vehicle: Vehicle) -> None:
    """200 draws: laid round a noisy reading, one bound in twenty left the truth outside."""
    plan = plans(1, 8, ("null white",))[0]
    scene = scenes_of(vehicle, plan, [8, 1, 0])[0]
    bounded = tuple(f"penetration.{leg}" for leg in vehicle.addresses.legs)
    sampling = replace(scene.sampling, intervals=bounded)
    seen = observation(vehicle, sampling)
    clean = np.full(seen.size, 0.05)
    for seed in range(50):
        rows = noisy(np.random.default_rng(seed), vehicle, sampling, clean)
        given = public(vehicle, replace(sampling, shuffle=seed), rows, scene.known, "")
        for it in given.values:
            if it.name in bounded:
                feet = {"m": 1.0, "ft": 0.3048}[it.unit]
                assert it.kind == "interval"
                assert feet * it.low < 0.05 < feet * it.high
    assert {reading.sigma for reading in seen.readings if reading.name in bounded} == {1.0}


def test_what_no_diagnosis_looks_for_stays_true_where_an_effect_is_sized(vehicle: Vehicle) -> None:
    scene = scenes_of(vehicle, plans(1, 8, ("null white",))[0], [8, 1, 0])[0]
    there = centred(vehicle, scene)
    unseen = {c.name for c in scene.coordinates} - {c.name for c in there.coordinates}
    assert unseen == {"gear.joint_damping", "gear.damping_ratio", "gear.primary_strut_mass", "gear.footpad_mass"}
    whole = vehicle.values(scene.coordinates, scene.z)
    kept = base_of(vehicle, there) | vehicle.values(there.coordinates, there.z)
    assert {name: kept[name] for name in whole} == pytest.approx(whole, rel=1e-12)
    names = {c.name for c in vehicle.tolerances()}
    assert len(names) == 12
    assert not names & unseen


def test_kinds_add_up_and_their_order_says_nothing() -> None:
    assert sum(SHARES.values()) == pytest.approx(1.0)
    assert sum(counts(37).values()) == 37
    kinds = [plan.kind for plan in plans(100, 1)]
    assert kinds != sorted(kinds, key=list(SHARES).index)
    assert 10 <= sum(plan.path == "units" for plan in plans(100, 1)) <= 40


def test_keys_inside_the_set_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="give a folder outside"):
        make(tmp_path / "set", tmp_path / "set" / "keys", 1, 1)


def test_a_part_holds_the_cases_that_the_whole_set_has_at_their_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Plan] = []
    module = import_module("sealed.make")
    monkeypatch.setattr(module, "ProcessPoolExecutor", lambda jobs, *_, **__: ThreadPoolExecutor(jobs))
    monkeypatch.setattr(module, "_make_one", lambda plan, *_: made.append(plan) or plan.number)
    (tmp_path / "set").mkdir()
    make(tmp_path / "set", tmp_path / "keys", 20, 5, part=slice(8, 11))
    assert made == plans(20, 5)[8:11]
    assert [plan.number for plan in made] == [8, 9, 10]


def test_signature_energy_equals_the_dense_formula(vehicle: Vehicle, lander: TwinLander) -> None:
    plan = plans(1, 9, ("single 25",))[0]
    signatures = Signatures(vehicle, scenes_of(vehicle, plan, [9, 1, 0])[0], lander)
    signature = signatures.signature([vehicle.effects["step_-Y"]], [[0.5]])
    assert signature is not None
    covariance = np.eye(len(signature)) + signatures.slopes @ signatures.slopes.T
    dense = signature @ np.linalg.solve(covariance, signature)
    assert dense > 1.0
    assert signatures.energy([vehicle.effects["step_-Y"]], [[0.5]]) == pytest.approx(dense, rel=1e-9)


@pytest.mark.slow
def test_nuisances_fitted_anew_leave_what_slopes_say_of_a_linear_effect_and_lower_any(vehicle: Vehicle, lander: TwinLander) -> None:
    """A gyro's cross axis changes the readings in proportion, and no contact: fitting anew must agree with the closed form (8 %: a
    fit ends where new slopes gain less than 1 of φ, which is 2 of λ, here 4 %; and kinks within reach of the nuisances: 5.5 % measured).
    A step under one pad changes the order of contacts; slopes bound nothing there, but nuisances leave less than the whole signature.
    """
    plan = plans(1, 9, ("single 25",))[0]
    signatures = Signatures(vehicle, scenes_of(vehicle, plan, [9, 1, 0])[0], lander)
    gyro, step = [vehicle.effects["gyro_cross_axis"]], [vehicle.effects["step_-Y"]]
    z = [[1.0] * len(gyro[0].parameters)]
    by_slopes, left = signatures.energy(gyro, z), signatures.from_truth(gyro, z)
    assert by_slopes is not None
    assert left == pytest.approx(by_slopes, rel=0.08)
    own = signatures.from_truth(gyro, z, gyro[0])
    assert own is not None
    # what its own prior asks of the effect is z'z = 3, a little less with the nuisances' help; a fit may end 2 of λ short of its minimum
    assert 2.0 < own <= 3.0 + 2.0 * GAIN  # measured 3.39, on another processor below 3
    whole, fitted = signatures.signature(step, [[0.2]]), signatures.from_truth(step, [[0.2]])
    assert whole is not None
    assert fitted is not None
    assert 0.0 < fitted < 0.8 * float(whole @ whole)


@pytest.mark.parametrize(
    ("nearby", "climbed", "left"), [(59.5, 28.9, 28.9), (9.2, 30.0, 9.2), (None, 4.0, 4.0), (7.0, None, 7.0), (None, None, None)]
)
def test_what_is_left_is_the_best_minimum_found(monkeypatch: pytest.MonkeyPatch, nearby: float, climbed: float, left: float) -> None:
    """The step of the first: ground that tilts explains half of what is left beside the true nuisances."""
    monkeypatch.setattr(Signatures, "from_truth", lambda *_: nearby)
    monkeypatch.setattr(Signatures, "_by_climb", lambda *_: climbed)
    assert Signatures.left(object.__new__(Signatures), [], []) == left


def test_an_effect_is_sized_by_the_climb_where_that_leaves_less(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice as much stays beside the true nuisances, at any size: judged by that where it is far off, the sizes go to and fro."""
    signatures = object.__new__(Signatures)
    monkeypatch.setattr(Signatures, "_along", lambda *_: lambda k: (k,))
    monkeypatch.setattr(Signatures, "energy", lambda _, effects, z: 200.0 * z[0][0] ** 2)
    monkeypatch.setattr(Signatures, "from_truth", lambda _, effects, z: 100.0 * z[0][0] ** 2)
    monkeypatch.setattr(Signatures, "_by_climb", lambda _, effects, z: 50.0 * z[0][0] ** 2)
    found = signatures.sized_by_what_is_left(None, 49.0, np.random.default_rng(0))  # type: ignore[arg-type]
    assert found is not None
    assert found.energy == pytest.approx(49.0, rel=0.25)
    assert found.energy == pytest.approx(50.0 * found.z[0][0] ** 2)


def test_nuisances_that_explain_everything_leave_no_energy() -> None:
    column = np.array([1.0, 2.0, 2.0])
    assert energy(column, 1e6 * column[:, None]) == pytest.approx(0.0, abs=1e-9)
    assert energy(column, np.zeros((3, 1))) == 9.0


def test_a_size_is_found_for_an_energy_or_refused() -> None:
    found = scaled_to(25.0, lambda k: 40.0 * k**2 / (1.0 + k), 3.0)
    assert found is not None
    assert found[1] == pytest.approx(25.0, rel=0.05)
    assert scaled_to(25.0, lambda k: k**2, 3.0) is None
    flown = scaled_to(25.0, lambda k: 100.0 * k**2 if k < 1.0 else None, 3.0)
    assert flown is not None
    assert flown[0] == pytest.approx(0.5, rel=0.02)


# Sealing

PEEK = """
import json, os, pathlib, sys
pathlib.Path("out/diagnosis.json").write_text(json.dumps({"verdict": "nothing_missing", "simulations": 3, "seen": sorted(os.environ),
    "argv": sys.argv, "cwd": os.getcwd(), "here": sorted(os.listdir("."))}))
if len(sys.argv) > 1:
    open(sys.argv[1]).read()
"""


def diagnosed(tmp_path: Path, *arguments: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """A stand-in for the diagnosis, run as a real one: its record and what it wrote."""
    for name in ("fit", "holdout"):
        (tmp_path / "set" / "cases" / "000" / name).mkdir(parents=True)
    (tmp_path / "keys").mkdir()
    (tmp_path / "keys" / "000.json").write_text("{}")
    (tmp_path / "peek.py").write_text(PEEK)
    command = (sys.executable, str(tmp_path / "peek.py"), *arguments)
    assert diagnoses.run(tmp_path / "set", tmp_path / "results", sealing.Diagnosis(ZUPP, 0, command), 1) == []
    place = tmp_path / "results" / "000"
    return json.loads((place / "run.json").read_text()), json.loads((place / "diagnosis.json").read_text())


def test_a_diagnosis_is_told_nothing_of_the_set_and_opens_no_key(tmp_path: Path) -> None:
    record, said = diagnosed(tmp_path)
    assert record["watched"]
    assert record["simulations"] == 3
    assert scoring.opened_keys(record, tmp_path / "keys") == []
    assert not any(str(tmp_path / "set") in path for path in record["opened"])
    assert set(said["here"]) <= {"fit", "holdout", "out", "opened.txt"}
    assert str(tmp_path) not in said["cwd"]
    assert set(said["seen"]) <= {*sealing.KEPT, "PYTHONPATH", "SEALED_OPENED", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "LC_CTYPE", "PWD"}
    assert diagnoses.missing(tmp_path / "set", tmp_path / "results") == []


def test_a_diagnosis_that_opens_a_key_is_void(tmp_path: Path) -> None:
    record, _ = diagnosed(tmp_path, str(tmp_path / "keys" / "000.json"))
    assert scoring.opened_keys(record, tmp_path / "keys") == [str(tmp_path / "keys" / "000.json")]
    with pytest.raises(report.UnsealedError, match="is void"):
        report.scores_of(tmp_path / "keys", tmp_path / "results", recompute=False)


# Scoring


def key(kind: str = "single 49", *names: str) -> dict[str, Any]:
    effect = {"port": "soil.normal", "fixed": {"soil.normal_term_rate": 2.0}, "parameters": {"x": 2.0}, "prior": {"x": 1.0}}
    return {"kind": kind, "lambda": 49.0, "effects": [{"name": name, **effect} for name in names]}


def named(*names: str, probability: float = 0.95) -> dict[str, Any]:
    parameters = {"x": {"value": 2.2, "sigma": 0.1, "unit": "1"}}
    effects = [{"name": name, "probability": probability, "parameters": parameters} for name in names]
    return {"verdict": "effect" if len(names) == 1 else "effects", "effects": effects, "gap": {"closure": 0.9}, "simulations": 5}


@pytest.mark.parametrize(
    ("said", "answer"),
    [
        (named("a"), "right"),
        (named("b"), "wrong"),
        (named("a", "b"), "wrong"),
        ({"verdict": "cannot_tell", "cannot_tell": {"names": ["b", "a"]}}, "set"),
        ({"verdict": "cannot_tell", "cannot_tell": {"names": ["b", "c"]}}, "wrong set"),
        ({"verdict": "cannot_tell"}, "abstained"),
        ({"verdict": "none_of_my_effects"}, "refused"),
        ({"verdict": "nothing_missing"}, "nothing"),
        ({"verdict": "numerics"}, "unjudged"),
        (None, "unjudged"),
    ],
)
def test_every_verdict_is_one_answer(said: dict[str, Any] | None, answer: str) -> None:
    assert scoring.scored("000", key("single 49", "a"), said).answer == answer


def test_pairs_are_right_together_and_in_a_set() -> None:
    both = key("two", "a", "b")
    assert scoring.scored("0", both, named("b", "a")).answer == "right"
    assert scoring.scored("0", both, named("a")).hits == 1
    for answers, answer in ((["a + c", "b + a"], "set"), (["a + c", "b + c"], "wrong set"), (["a", "b"], "wrong set")):
        said = {"verdict": "cannot_tell", "cannot_tell": {"names": ["a", "b", "c"], "answers": answers}}
        score = scoring.scored("0", both, said)
        assert (score.answer, score.hits) == (answer, 2)


@pytest.mark.parametrize("kind", ["outside", "twin", "decoy"])
def test_a_case_without_a_diagnosis_counts_against_every_target(kind: str) -> None:
    rows = [row for row in targets.table([scoring.scored("0", key(kind, "a"), None)]) if row["n"]]
    assert [row["met"] for row in rows] == ["missed"] * len(rows)


def test_two_laws_of_a_verdict_are_both_in_its_closure() -> None:
    one = {"port": "soil.normal", "fixed": {"soil.normal_term_depth": 1.0}, "coefficient": {"value": 300.0}}
    both = {"verdict": "none_of_my_effects", "term": {**one, "second": {**one, "port": "body", "coefficient": {"value": -50.0}}}}
    vehicle: Any = SimpleNamespace(effects={})
    found = _revised(vehicle, both)
    assert [(effect.port, list(z)) for effect, z in found] == [("soil.normal", [1.0]), ("body", [-1.0])]
    assert found[0][0].name != found[1][0].name


def test_a_key_that_was_changed_is_refused(tmp_path: Path) -> None:
    keys, out = tmp_path / "keys", tmp_path / "set"
    keys.mkdir()
    out.mkdir()
    (keys / "000.json").write_text("{}")
    _write_manifest(out, keys, 1)
    (keys / "001.json").write_text("{}")
    _write_manifest(out, keys, 2)
    (keys / "000.json").write_text("{ }")
    (keys / "001.json").rename(keys / "002.json")
    (keys / "000.json").write_text("{}")
    with pytest.raises(ValueError, match="case 001 is in the set alone; give the keys"):
        complete(keys, out / "set.json")
    (keys / "002.json").rename(keys / "001.json")
    complete(keys, out / "set.json")
    (keys / "000.json").write_text("{ }")
    for told in (lambda: _write_manifest(out, keys, 2), lambda: unchanged(keys, out / "set.json")):
        with pytest.raises(ValueError, match="the key of case 000 is not the one"):
            told()


def test_parameters_are_compared_in_prior_and_stated_sigma() -> None:
    score = scoring.scored("0", key("single 49", "a"), named("a"))
    assert score.errors["a.x"] == pytest.approx(0.1)
    assert score.pulls["a.x"] == pytest.approx(2.0)


def test_a_law_outside_the_library_is_known_by_port_and_exponents() -> None:
    law = key("outside", "law")
    term = {"port": "soil.normal", "fixed": {"soil.normal_term_rate": 2, "soil.normal_term_depth": 0}}
    other = {"port": "soil.normal", "fixed": {"soil.normal_term_rate": 1}}
    found = scoring.scored("0", law, {"verdict": "none_of_my_effects", "term": term})
    assert (found.port, found.form) == (True, True)
    in_class = scoring.scored("0", law, {"verdict": "none_of_my_effects", "term": {**other, "rivals": [term]}})
    assert (in_class.port, in_class.form) == (True, True)
    wrong = scoring.scored("0", law, {"verdict": "none_of_my_effects", "term": other})
    assert (wrong.port, wrong.form) == (True, False)


@pytest.mark.parametrize(
    ("kind", "names", "port", "answer"),
    [
        ("outside", ["a", "found"], "soil.normal", "set"),
        ("outside", ["a", "found"], "body", "wrong set"),
        ("outside", ["a", "b"], "soil.normal", "wrong set"),
        ("single 49", ["hidden", "found"], "body", "set"),
        ("single 49", ["a", "found"], "body", "wrong set"),
    ],
)
def test_a_law_outside_may_stand_in_a_set(kind: str, names: list[str], port: str, answer: str) -> None:
    said = {"verdict": "cannot_tell", "cannot_tell": {"names": names}, "term": {"name": "found", "port": port}}
    assert scoring.scored("0", key(kind, "hidden"), said).answer == answer


@pytest.mark.parametrize(
    ("hits", "n", "low", "high"),
    # Newcombe (1998), Statistics in Medicine 17, 857, table I, method 3
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718), (29, 29, 0.8830, 1.0)],
)
def test_wilson_bounds_are_those_published(hits: int, n: int, low: float, high: float) -> None:
    assert wilson(hits, n) == pytest.approx((low, high), abs=5e-5)


def test_the_table_has_every_target_and_says_what_was_met(tmp_path: Path) -> None:
    nothing = {"verdict": "nothing_missing", "simulations": 9}
    scores = [scoring.scored("0", key("null white"), nothing, {"seconds": 60.0}), scoring.scored("1", key("null white"), named("a"))]
    scores += [scoring.scored("2", key("single 49", "a"), named("a")), scoring.scored("3", key("decoy"), nothing)]
    rows = {row["on sealed cases"]: row for row in targets.table(scores)}
    assert len(rows) == len(targets.TARGETS) + 3
    assert (rows["false alarm on nulls, white noise"]["figure"], rows["false alarm on nulls, white noise"]["met"]) == (0.5, "missed")
    assert rows["right name at λ 49"]["met"] == "met"
    assert rows["decoys given a name"]["met"] == "met"
    assert rows["two effects: both"]["met"] == "no case"
    assert rows["named with probability 0.9 or more and right"]["n"] == 2
    assert [row["case"] for row in targets.confusion(scores)] == ["1"]
    text = report.report(scores, tmp_path)
    assert "| right name at λ 49 | at least 0.92 | 1 | 1" in text
    assert (tmp_path / report.CURVE).stat().st_size > 5000


# Pooling


def part(folder: Path, seed: int, by: str = "abc", cases: int = 2, call: str = "") -> Path:
    """A score.json of so many cases of one set."""
    mine = [key("single 49", "a") | {"seed": [seed, 1 + i, 0], "skipped": [{"effect": "b"}]} for i in range(cases)]
    scores = [scoring.scored(f"{i:03}", mine[i], named("a"), {"by": by, "command": call}) for i in range(cases)]
    report.report(scores, folder)
    return folder / "score.json"


def test_scores_of_several_sets_make_one_table(tmp_path: Path) -> None:
    """Also those whose cases have the same numbers; what a file cannot hold, NaN, comes back."""
    found = pooled([part(tmp_path / "one", 1), part(tmp_path / "two", 2, cases=3)])
    assert [score.case for score in found] == ["one/000", "one/001", "two/000", "two/001", "two/002"]
    assert found[0].truth == ("a",)
    assert np.isnan(found[0].seconds)
    rows = {row["on sealed cases"]: row for row in targets.table(found)}
    assert rows["right name at λ 49"]["n"] == 5
    assert "(times): b 5." in report.report(found, tmp_path / "all")


def test_scores_of_two_methods_are_not_pooled(tmp_path: Path) -> None:
    call = "an unknown command"
    with pytest.raises(ValueError, match=f"diagnosed by {call} of abc and by {call} of def: scores of one method only"):
        pooled([part(tmp_path / "one", 1), part(tmp_path / "two", 2, by="def")])
    with pytest.raises(ValueError, match=r"diagnosed by orchestrator diagnose of abc and by sealed\.baselines bic of abc"):
        pooled([part(tmp_path / "three", 1, call="/usr/bin/python -m orchestrator diagnose /x/zupp.toml --measured fit"),
                part(tmp_path / "four", 2, call="python3 -m sealed.baselines bic")])  # fmt: skip
    with pytest.raises(ValueError, match=r"diagnosed by abc\+, no commit as it stands"):
        pooled([part(tmp_path / "five", 1, by="abc+"), part(tmp_path / "six", 2, by="abc+")])


def test_a_folder_of_results_by_two_methods_makes_no_table(tmp_path: Path) -> None:
    scores = [scoring.scored(str(i), key("null white"), named("a"), {"by": by}) for i, by in enumerate(("abc", "def"))]
    with pytest.raises(ValueError, match="scores of one method only make a table"):
        one_method(scores)


def test_the_law_that_is_plowing_by_another_name_counts_nowhere() -> None:
    odd = scoring.scored("0", key("outside", "outside_tangent_slide"), named("plowing"))
    assert all(row["n"] == 0 for row in targets.table([odd]) if "minutes" not in row["on sealed cases"])
    assert "1 of a law that is plowing by another name is left out" in report._head([odd])


@pytest.mark.parametrize(
    ("verdict", "names", "refuses"),
    [
        ("none_of_my_effects", [], True),
        ("nothing_missing", [], False),
        ("cannot_tell", ["a", "b"], False),
        ("cannot_tell", ["a", "found"], True),
    ],
)
def test_who_says_nothing_or_names_the_library_refuses_nothing(verdict: str, names: list[str], refuses: bool) -> None:
    said = {"verdict": verdict, "cannot_tell": {"names": names}, "term": {"name": "found", "port": "soil.normal"}}
    rows = {row["on sealed cases"]: row for row in targets.table([scoring.scored("0", key("outside", "hidden"), said)])}
    assert rows["outside the library: refuses a library name"]["figure"] == float(refuses)


def test_a_law_found_by_a_run_that_cannot_be_trusted_has_no_right_port() -> None:
    said = {"verdict": "numerics", "term": {"name": "found", "port": "soil.normal"}, "gap": {"closure": 0.9}}
    rows = {row["on sealed cases"]: row for row in targets.table([scoring.scored("0", key("outside", "hidden"), said)])}
    assert rows["outside the library: right port"]["figure"] == 0.0
    assert rows["the same, outside the library"]["n"] == 0


def test_a_result_of_which_nobody_noted_what_was_opened_is_void(tmp_path: Path) -> None:
    (tmp_path / "keys").mkdir()
    (tmp_path / "results" / "000").mkdir(parents=True)
    (tmp_path / "keys" / "000.json").write_text(json.dumps(key("null white")))
    (tmp_path / "results" / "000" / "diagnosis.json").write_text('{"verdict": "nothing_missing"}')
    with pytest.raises(report.UnsealedError, match="nobody noted"):
        report.scores_of(tmp_path / "keys", tmp_path / "results", recompute=False)


def test_a_case_counts_once(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="two/000 is one/000: one case, made with seed 1"):
        pooled([part(tmp_path / "one", 1), part(tmp_path / "two", 1)])


def test_the_command_pools_and_leaves_the_parts_alone(tmp_path: Path) -> None:
    one, two = part(tmp_path / "one", 1), part(tmp_path / "two", 2)
    run, before = Path(scoring.__file__).parent / "run.py", one.read_bytes()
    said = [
        subprocess.run([sys.executable, str(run), "pool", str(one), str(two), "--out", str(tmp_path / out)], capture_output=True, text=True)
        for out in ("all", "one")
    ]
    assert [it.returncode for it in said] == [0, 2], said
    assert "| right name at λ 49 | at least 0.92 | 4 | 1" in said[0].stdout
    assert "give another --out" in said[1].stderr
    assert one.read_bytes() == before
    assert len(json.loads((tmp_path / "all" / "score.json").read_text())) == 4


@pytest.mark.parametrize("text", ["", "{}", "[3]", '[{"case": "000"}]'])
def test_what_is_no_score_is_refused_by_name(tmp_path: Path, text: str) -> None:
    (tmp_path / "score.json").write_text(text)
    with pytest.raises(ValueError, match=r"score\.json: "):
        pooled([tmp_path / "score.json"])
