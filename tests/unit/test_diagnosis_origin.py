"""Where a diagnosis' numbers come from: everything that could change them is in its provenance."""

from pathlib import Path
from shutil import copy, copytree

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.origin import flown_units, provenance

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "scenarios" / "measured" / "example_soil" / "fit"


def test_a_unit_from_elsewhere_is_among_those_flown(tmp_path: Path) -> None:
    """Else a task store would give back what another unit flew."""
    own, scenario = tmp_path / "my_leg.fmu", tmp_path / "mine.toml"
    copy(ROOT / "build" / "fmus" / "GearLeg.fmu", own)
    scenario.write_text(f'extends = "{ROOT}/scenarios/apollo11_zupp.toml"\n[units.leg1]\nfmu = "{own}"\n', "utf-8")
    units = flown_units(Addresses(draw_up(read_scenario(scenario), scenario)))
    assert own.resolve() in units
    assert len(set(units)) == len(units) > 5


def test_provenance_changes_with_scenario_data_and_units(tmp_path: Path) -> None:
    data, unit, scenario = tmp_path / "data", tmp_path / "unit.fmu", tmp_path / "mine.toml"
    copytree(DATA, data)
    unit.write_bytes(b"one")
    base = tmp_path / "base.toml"
    base.write_text('title = "one"\nstop_time = 3.0\n', "utf-8")
    scenario.write_text('extends = "base.toml"\n', "utf-8")
    said = [provenance(scenario, [data], [unit], {"seed": 1})]
    for changed, text in ((base, 'title = "two"\nstop_time = 3.0\n'), (data / "rates.csv", "time_s\n"), (unit, "two")):
        changed.write_text(text, "utf-8")
        said.append(provenance(scenario, [data], [unit], {"seed": 1}))
    for name, before, after in zip(("scenario", "data", "units"), said, said[1:], strict=False):
        assert {key for key in before if before[key] != after[key]} == {name}
    assert said[0]["packages"]["lander-touchdown"]
