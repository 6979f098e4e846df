"""Runs that are no landing, and the table a person reads."""

import numpy as np
import pytest
from results_samples import TABLE, landing
from rich.console import Console

from orchestrator.errors import ScenarioError
from orchestrator.results import terminal_table, write
from orchestrator.results.schema import ResultsTable, read

REPORT = {"stroke": {"variable": "leg.primary.peak_stroke", "expected": 0.2838, "unit": "m", "source": "eq. 4"}}


def drop(**changes):
    times = np.linspace(0.0, 1.0, 11)
    columns = {"leg.primary.peak_stroke": 0.284 * times, "leg.primary.load": 100.0 - times}
    return landing(
        11, **({"times": times, "columns": columns, "units": {"leg.primary.load": "N"}, "results": {"report": REPORT}} | changes)
    )


def printed(summary):
    console = Console(width=100, record=True, file=None, quiet=False, force_terminal=False)
    with console.capture() as captured:
        console.print(terminal_table(summary))
    return captured.get()


def test_a_table_without_legs_is_generic_and_one_with_legs_a_touchdown():
    assert ResultsTable().resolved_kind == "generic"
    assert ResultsTable.model_validate(TABLE).resolved_kind == "touchdown"
    assert ResultsTable.model_validate(TABLE | {"kind": "generic"}).resolved_kind == "generic"


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"compair": "zupp"}, 'results.compair: unknown key; did you mean "compare"?'),
        ({"legs": {"+Z": {"leg": "a", "soil": "b", "sole": "c"}}}, 'results.legs.+Z.sole: unknown key; did you mean "soil"?'),
        ({"legs": {"+Z": {"leg": "a"}}}, "results.legs.+Z.soil: is missing; add it"),
        ({"kind": "flight"}, "results.kind: input should be 'touchdown' or 'generic'"),
    ],
)
def test_a_table_at_fault_is_told_in_one_line(table, message):
    with pytest.raises(ScenarioError) as caught:
        read(table)
    assert str(caught.value) == message


def test_a_table_at_fault_costs_a_finished_run_only_its_special_summary(tmp_path):
    summary = write(drop(results={"compair": "zupp"}), tmp_path)
    assert summary["kind"] == "generic"
    assert "results.compair" in summary["notes"][0]


def test_every_column_gets_its_last_least_and_greatest_value(tmp_path):
    summary = write(drop(), tmp_path)
    assert summary["columns"]["leg.primary.load"] == {"final": 99.0, "min": 99.0, "max": 100.0, "unit": "N"}
    assert summary["comparison"] is None
    assert (tmp_path / "figures" / "report.png").exists()


def test_a_reported_number_stands_beside_what_was_expected(tmp_path):
    row = write(drop(), tmp_path)["report"]["stroke"]
    assert row["value"] == pytest.approx(0.284)
    assert row["relative_difference"] == pytest.approx(0.284 / 0.2838 - 1.0)


def test_a_reported_number_that_was_not_recorded_is_none_and_named(tmp_path):
    summary = write(drop(columns={}), tmp_path)
    assert summary["report"]["stroke"]["value"] is None
    assert summary["report"]["stroke"]["relative_difference"] is None
    assert summary["missing"] == ["leg.primary.peak_stroke"]
    assert "not recorded: leg.primary.peak_stroke" in printed(summary)


def test_the_least_or_greatest_value_can_be_reported(tmp_path):
    report = {"load": {"variable": "leg.primary.load", "at": "max", "expected": 0.0}}
    row = write(drop(results={"report": report}), tmp_path)["report"]["load"]
    assert (row["value"], row["difference"], row["relative_difference"]) == (100.0, 100.0, None)


def test_the_screen_shows_a_landing_with_the_paper_in_brackets(tmp_path):
    text = printed(write(landing(100), tmp_path))
    assert "complete  trusted  stands" in text
    assert text.index("+Y  ") < text.index("+Z  ") < text.index("-Z  ")
    assert "(2.85)" in text
    assert "largest skid, cm" in text
    assert str(tmp_path) in text.replace("\n", "").replace(" ", "")


def test_the_screen_shows_a_failed_run_and_why(tmp_path):
    text = printed(write(landing(0, complete=False, trusted=False, message="body.fmu: refused"), tmp_path))
    assert "NOT COMPLETE  NOT TRUSTED" in text
    assert "body.fmu: refused" in text


def test_a_run_that_was_cut_short_is_not_called_standing(tmp_path):
    text = printed(write(landing(50, complete=False, trusted=False), tmp_path))
    assert "NOT COMPLETE" in text
    assert "stand" not in text


def test_the_screen_shows_reported_numbers(tmp_path):
    text = printed(write(drop(), tmp_path))
    assert "0.2838 m" in text
    assert "+0.070%" in text
    assert "eq. 4" in text
