"""Hidden effects found from data alone, by the command line with the whole library: as many cases at a time as there are cores."""

import json
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from os import cpu_count
from pathlib import Path
from typing import Any

import pytest
from conftest import orchestrator
from hidden_landings import Case, Vehicle, write

pytestmark = [pytest.mark.slow, pytest.mark.together]


TWINS = ("telemetry_lowpass", "clock_offset")
CASES = {  # the dearest first
    "a law outside the library": Case("outside_yaw_angle", 300.0, 14, "none_of_my_effects"),
    "one of two that look alike": Case("clock_offset", 30.0, 18, "cannot_tell", TWINS, one_recorder=False, held_out=False),
    "the same, told apart by a second landing": Case("clock_offset", 30.0, 18, "effect", TWINS[1:], one_recorder=False),
    "the other of the two, where noise misleads": Case("telemetry_lowpass", 30.0, 15, "cannot_tell", TWINS, one_recorder=False),
    "a force in the soil": Case("soil_damping", 400.0, 11, "effect", ("soil_damping",)),
    "a sensor's axes": Case("gyro_cross_axis", 150.0, 12, "effect", ("gyro_cross_axis",)),
    "nothing": Case("", 0.0, 13, "nothing_missing"),
}
BUDGET = 8000  # landings: beyond them only what the verdict needs, no law for what is outside the library
Diagnosis = dict[str, Any]


@pytest.fixture(scope="module")
def diagnoses(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Future[Diagnosis]]]:
    """Of the cases asked for, one process each: a search is serial in parts."""
    vehicle, begun = Vehicle(), {}
    asked = {item.callspec.params["what"] for item in request.session.items if item.path == request.path}  # type: ignore[attr-defined]
    with ThreadPoolExecutor(cpu_count() or 1) as pool:
        for what, case in CASES.items():
            if what not in asked:
                continue
            folder = tmp_path_factory.mktemp(case.effect or "nothing")
            write(vehicle, case, folder)
            begun[what] = pool.submit(diagnosed, folder, case)
        yield begun


def diagnosed(folder: Path, case: Case) -> Diagnosis:
    held = ("--holdout", folder / "holdout") if case.held_out else ()
    done = orchestrator(
        "diagnose", "apollo11_zupp", "--measured", folder / "fit", *held, "--out", folder / "out",
        "--verdict-only", "--workers", 1, "--budget", BUDGET, limit=7200.0,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return dict(json.loads((folder / "out" / "diagnosis.json").read_text("utf-8")))


MISSED = {
    "the other of the two, where noise misleads": "hidden telemetry_lowpass 5.66 ms, λ 30; said clock_offset with probability 0.98:"
    " χ² 859.5 of 920 against 871.2, 4.0 ahead in ln evidence; without noise the filter is 3 better in φ: no twin by its clean data",
}
"""Cases that a search was seen to get wrong, with what it said; not in CI, ten minutes of a core each."""
LONG = ("the same, told apart by a second landing",)


def cases() -> list[Any]:
    marks = {what: [pytest.mark.long, pytest.mark.xfail(reason=why, strict=False)] for what, why in MISSED.items()}
    marks |= {what: [pytest.mark.long] for what in LONG}
    return [pytest.param(what, marks=marks.get(what, [])) for what in CASES]


@pytest.mark.parametrize("what", cases())
def test_what_is_hidden_gets_its_verdict(what: str, diagnoses: dict[str, Future[Diagnosis]]) -> None:
    case, found = CASES[what], diagnoses[what].result()
    told = [(c["name"], round(c["log_evidence"], 1), round(c["adequacy"], 4), c["holdout_gain"]) for c in found["candidates"][:4]]
    if case.verdict == "cannot_tell" and found["verdict"] == "effect":      # of twins the right set is right, or the right name
        assert tuple(effect["name"] for effect in found["effects"]) == (case.effect,), told
        return
    assert found["verdict"] == case.verdict, told
    if case.verdict == "effect":
        assert tuple(effect["name"] for effect in found["effects"]) == case.names, told
        # the twins' held-out landing has no gap: without the effect, too, its chi-square is less than its readings
        assert what in LONG or found["gap"]["closure"] >= 0.8, found["gap"]
    if case.verdict == "none_of_my_effects":
        assert found["term"]["port"] == "body", found["term"]["words"]
        assert found["term"]["closure"] >= 0.8, found["gap"]
    if case.verdict == "cannot_tell":
        assert set(found["cannot_tell"]["names"]) >= set(case.names), told
