"""Distances to the paper's Table 6, checked against distances worked out independently of this code."""

from pathlib import Path

import pytest

from orchestrator.results.comparison import compare, markdown, rms_difference
from orchestrator.results.references import References, find, load, parse

PAPER = Path(__file__).parents[2] / "scenarios" / "paper.toml"
RMS_TO_PHOTO_CM = {"rogers": 3.83, "adams": 4.22, "zupp": 4.43, "glass_zupp_like": 4.97, "glass_adams_like": 5.17}


def summary_of(strokes):
    return {
        "strokes_m": strokes,
        "penetration_m": {"+Z": 0.02, "-Z": None},
        "skid_m": {"+Z": 0.3, "-Z": None},
        "contact_times_s": {"+Z": 0.18, "+Y": 0.1, "-Z": None},
        "final_attitude_deg": {"yaw": 13.0, "pitch": None, "roll": 0.0},
    }


def test_rms_counts_only_struts_both_sides_have():
    assert rms_difference({"a": 3.0, "b": None, "c": 1.0}, {"a": 0.0, "b": 7.0, "d": 1.0}) == (3.0, 1)
    assert rms_difference({"a": None}, {"a": 1.0}) == (None, 0)


@pytest.mark.parametrize("column", RMS_TO_PHOTO_CM)
def test_each_column_of_the_paper_is_as_far_from_the_photographs_as_the_table_says(column):
    paper = load(PAPER)
    rms, struts = rms_difference(paper.strokes[column], paper.strokes["photo"])
    assert struts == 11
    assert rms * 100.0 == pytest.approx(RMS_TO_PHOTO_CM[column], abs=0.005)


def test_a_run_that_equals_a_column_is_at_no_distance_from_it():
    paper = load(PAPER)
    result = compare(summary_of(paper.strokes["zupp"]), paper, "zupp", None)
    assert result["rms_m"]["zupp"] == 0.0
    assert result["rms_struts"] == {"photo": 11} | dict.fromkeys(RMS_TO_PHOTO_CM, 12)
    assert result["rms_m"]["photo"] == result["rms_to_measured_m"]["zupp"]


def test_observables_stand_beside_the_chosen_section_and_the_measured_one():
    paper = load(PAPER)
    seen = compare(summary_of({}), paper, "glass_zupp_like", "measured_apollo11")["observables"]
    assert seen["ours"]["penetration_range_m"] == [0.02, 0.02]
    assert seen["ours"]["contact_order"] == "+Y (0.000 s), +Z (0.080 s)"
    assert seen["published"]["max_skid_m"] == 0.0701
    assert seen["measured"]["penetration_range_m"] == [0.020, 0.0762]


def test_the_markdown_table_has_a_row_for_each_strut_and_both_distances():
    paper = load(PAPER)
    summary = summary_of(paper.strokes["glass_zupp_like"])
    text = markdown("Run", summary, compare(summary, paper, "glass_zupp_like", "measured_apollo11"), paper)
    assert "| -Y.primary | 5.22 | 0.00 | 0.00 | 0.00 | 5.22 | 0.00 | 0.99 |" in text
    assert "| RMS to this run |  | 4.97 |" in text
    assert "| RMS to Photo | 4.97 | – | 3.83 | 4.43 | 4.97 | 4.22 | 5.17 |" in text


def test_without_references_there_is_still_a_comparison_to_print():
    summary = summary_of({"+Z.left": 0.01})
    nothing = References()
    assert "| +Z.left | 1.00 |" in markdown("Run", summary, compare(summary, nothing, None, None), nothing)


def test_lengths_are_read_in_the_unit_the_file_declares():
    table = {"unit": "mm", "columns": ["a"], "struts": {"x": [5.0]}}
    assert parse({"table6": table}).strokes == {"a": {"x": 0.005}}


def test_names_that_nothing_is_published_under_are_found_out():
    assert load(PAPER).unknown(["glass_zupp_like", None, "glass_zup"]) == ["glass_zup"]


def test_the_reference_file_is_looked_for_in_order(tmp_path):
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "paper.toml").touch()
    assert find("paper.toml", [tmp_path / "a", tmp_path / "b"]) == tmp_path / "b" / "paper.toml"
    assert find("other.toml", [tmp_path / "b"]) is None
    assert find(None, [tmp_path]) is None


def test_a_broken_reference_file_says_so_and_stops_nothing(tmp_path):
    (tmp_path / "paper.toml").write_text("[table6]\ncolumns = ['a', 'b']\n[table6.struts]\nx = [1.0]\n")
    broken = load(tmp_path / "paper.toml")
    assert broken.strokes == {}
    assert broken.fault.startswith("paper.toml: not usable as references (IndexError")
