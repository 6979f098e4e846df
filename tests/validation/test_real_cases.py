"""The real cases of docs/real-cases.md: data as shipped, and a verdict that forces no name."""

from pathlib import Path

import pytest

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.diagnose import Request, diagnose
from orchestrator.diagnosis.measured import faults, read_measured
from orchestrator.diagnosis.setup import set_up
from orchestrator.results.references import load
from orchestrator.scenario.locate import find_scenario

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
MEASURED = SCENARIOS / "measured"
FOLDERS = sorted(path.parent for path in MEASURED.rglob("landing.toml"))
OF_TABLE_6 = {"apollo11_photographs": "photo", "glass_zupp_like": "glass_zupp_like", "glass_adams_like": "glass_adams_like"}


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda path: str(path.relative_to(MEASURED)))
def test_every_shipped_folder_reads_without_a_fault_and_says_where_it_is_from(folder: Path) -> None:
    measured = read_measured(folder)
    assert measured.title
    assert measured.source
    assert not faults(measured)


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda path: str(path.relative_to(MEASURED)))
def test_every_shipped_folder_names_what_its_scenario_has(folder: Path) -> None:
    path = find_scenario("apollo11_adams" if "adams" in folder.name else "apollo11_zupp")
    setup = set_up(draw_up(read_scenario(path, ()), path), [read_measured(folder)], {}, SCENARIOS / "tolerances.toml")
    assert setup.landings.size > 0
    assert len(setup.nuisances) > 1


@pytest.mark.parametrize(("name", "column"), OF_TABLE_6.items())
def test_strokes_are_those_of_table_6(name: str, column: str) -> None:
    strokes = load(SCENARIOS / "paper.toml").strokes[column]
    printed = {f"stroke.{strut}": stroke for strut, stroke in strokes.items() if stroke is not None}
    given = {one.name: one.value for one in read_measured(MEASURED / name).values if one.name.startswith("stroke.")}
    assert given == pytest.approx(printed, abs=1e-9)


@pytest.mark.long
def test_photographed_strokes_force_no_name(tmp_path: Path) -> None:
    """-Z left is 11.43 cm in the photographs and about 0 in every simulation: whatever the library offers must not be named for it."""
    found = diagnose(Request(find_scenario("apollo11_zupp"), [MEASURED / "apollo11_photographs"], out=tmp_path, workers=1)).outcome
    assert found.verdict in ("none_of_my_effects", "cannot_tell", "data_fault", "nothing_missing")
    assert not found.effects
