"""The run directory: what is in it, that other tools read it, and that half a run is kept."""

import csv
import json
import tomllib

import numpy as np
import pyarrow.parquet as pq
import pytest
from fmpy.util import read_csv
from PIL import Image
from results_samples import TABLE, landing

from orchestrator.results import write

TOUCHDOWN_KEYS = {
    "title", "complete", "trusted", "stable", "contact_times_s", "peak_rates_deg_s", "final_attitude_deg", "penetration_m", "skid_m",
    "strokes_m", "energy", "ledger", "master", "comparison",
}  # fmt: skip


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    out = tmp_path_factory.mktemp("run")
    result = landing(300)
    return result, write(result, out), out


def test_summary_has_the_agreed_keys_and_is_what_the_file_holds(written):
    _, summary, out = written
    assert set(summary) >= TOUCHDOWN_KEYS
    assert json.loads((out / "summary.json").read_text(encoding="utf-8")) == summary
    assert summary["missing"] == []
    assert summary["master"]["share_outside_units"] == pytest.approx(0.25)


def test_fmpy_reads_the_history_with_every_digit(written):
    result, _, out = written
    history = read_csv(out / "history.csv")
    assert history.dtype.names == ("time", *result.columns)
    assert all(np.array_equal(history[name], column) for name, column in result.columns.items())
    assert np.array_equal(history["time"], result.times)


def test_the_history_is_rfc_4180(written):
    _, _, out = written
    lines = (out / "history.csv").read_bytes().split(b"\r\n")
    assert lines[-1] == b""
    assert len({line.count(b",") for line in lines[:-1]}) == 1
    assert b"\n" not in b"".join(lines)


def test_parquet_returns_the_same_bits_and_the_units(written):
    result, _, out = written
    table = pq.read_table(out / "history.parquet")
    assert all(table[name].to_numpy().tobytes() == column.tobytes() for name, column in result.columns.items())
    assert table.schema.field("body.energy.kinetic").metadata[b"unit"] == b"J"
    assert table.schema.field("time").metadata[b"unit"] == b"s"


def test_the_solver_log_has_a_row_an_attempt(written):
    result, _, out = written
    with (out / "solver_log.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(result.log)
    assert sum(row["accepted"] == "0" for row in rows) == 4
    assert float(rows[0]["interval"]) == result.log[0].interval


def test_the_scenario_comes_back_from_its_file(written):
    result, _, out = written
    assert tomllib.loads((out / "scenario.toml").read_text(encoding="utf-8")) == result.scenario


def test_unset_and_numpy_values_do_not_stop_the_scenario(tmp_path):
    scenario = {"a": None, "b": np.float64(0.1), "c": (1, 2), "d": {"e": np.array([1.5])}}
    write(landing(3, scenario=scenario, results={}), tmp_path)
    assert tomllib.loads((tmp_path / "scenario.toml").read_text(encoding="utf-8")) == {"b": 0.1, "c": [1, 2], "d": {"e": [1.5]}}


def test_inputs_name_the_versions(written):
    _, _, out = written
    inputs = json.loads((out / "inputs.json").read_text(encoding="utf-8"))
    assert inputs["units"]["body"]["guid"] == "{guid}"
    assert {"numpy", "fmpy", "pythonfmu"} <= set(inputs["packages"])


def test_every_figure_is_a_picture(written):
    _, _, out = written
    pictures = {path.stem: Image.open(path).size for path in (out / "figures").glob("*.png")}
    assert set(pictures) == {"motion", "pads", "struts", "energy", "intervals"}
    assert all(width > 1000 and height > 500 for width, height in pictures.values())


def test_without_figures_those_of_an_earlier_run_go(tmp_path):
    (tmp_path / "figures").mkdir()
    for name in ("motion.png", "notes.txt"):
        (tmp_path / "figures" / name).write_text("of an earlier run", encoding="utf-8")
    write(landing(3), tmp_path, figures=False)
    assert [path.name for path in (tmp_path / "figures").iterdir()] == ["notes.txt"]
    assert (tmp_path / "history.csv").is_file()


@pytest.mark.parametrize("rows", [0, 1, 2])
def test_a_run_that_stopped_early_leaves_what_it_has(rows, tmp_path):
    result = landing(rows, complete=False, trusted=False, interrupted=True, message="interrupted at 0.0 s")
    summary = write(result, tmp_path)
    assert (summary["complete"], summary["message"]) == (False, "interrupted at 0.0 s")
    assert (tmp_path / "history.parquet").stat().st_size > 0
    assert (tmp_path / "summary.json").exists()


def test_a_run_in_which_a_unit_died_is_written_with_its_nan(tmp_path):
    result = landing(50)
    result.columns["leg+Z.left.load"][-1] = np.nan
    summary = write(result, tmp_path)
    assert summary["stable"] is False


def test_a_run_without_any_of_the_named_columns_names_them(tmp_path):
    result = landing(20, columns={"other.x": np.zeros(20)})
    summary = write(result, tmp_path)
    assert "body.attitude.yaw" in summary["missing"]
    assert summary["energy"] is None
    assert set(summary["strokes_m"].values()) == {None}


def test_a_column_nobody_published_is_noted(tmp_path):
    summary = write(landing(5, results=TABLE | {"compare": "glass_zup"}), tmp_path)
    assert "'glass_zup'" in summary["notes"][0]


def test_the_references_travel_with_the_run(written):
    _, summary, out = written
    assert summary["comparison"]["source"]
    assert (out / "paper.toml").exists()
    assert (out / "comparison.md").read_text(encoding="utf-8").startswith("# A made-up landing")
