"""The report: written for every verdict, well-formed, sufficient to itself, and true to diagnosis.json."""

import csv
import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from report_samples import ODD, VERDICTS, bare, channel, distinction, landing, odd_landing, outcome
from rich.console import Console

from orchestrator.diagnosis.report import (
    Distinction,
    terminal_distinguish,
    terminal_summary,
    verdict_sentence,
    write_distinction,
    write_report,
)
from orchestrator.diagnosis.report.courses import RestValue
from orchestrator.diagnosis.report.file_names import FileNames
from orchestrator.diagnosis.report.numbers import chance, number, percent, signed, with_sigma
from orchestrator.diagnosis.report.plot_dots import missed, rest_picture
from orchestrator.diagnosis.report.plot_where import where_picture
from orchestrator.diagnosis.report.template import flat, in_words
from orchestrator.diagnosis.report.words import caution, command

VOID = {"meta", "br", "link", "img", "hr"}
SENTENCES = {
    "nothing_missing": "Nothing is missing that these data could show.",
    "effect": "Missing: soil damping at all pads, 98 %. Closes 93 % of the gap on a landing it was not fitted to.",
    "effects": "Missing: soil damping at all pads and RCS pulse, 96 %. Closes 93 % of the gap on a landing it was not fitted to.",
    "cannot_tell": (
        "These data cannot tell soil damping at all pads from inertial drag of the soil: measure penetration.+Z to within 0.20 cm."
    ),
    "none_of_my_effects": "Something is missing that is not in the library: pad normal, quadratic in sink rate.",
    "numerics": "The numerics are not fine enough to judge.",
    "data_fault": "The data are at fault: rates.yaw stands still for 40 samples.",
}


class Page(HTMLParser):
    """Checks that every element is closed in turn, and keeps what a reader gets."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.values: list[str] = []
        self.links: list[str] = []
        self.texts: list[str] = []
        self.labels: list[str | None] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if tag not in VOID:
            self.open.append(tag)
        if tag == "data":
            self.values.append(given["value"] or "")
        if tag == "svg":
            self.labels.append(given.get("aria-label"))
        self.links += [value or "" for name, value in attrs if name in ("href", "src", "xlink:href")]

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.links += [value or "" for name, value in attrs if name in ("href", "src", "xlink:href")]

    def handle_endtag(self, tag: str) -> None:
        assert self.open, f"</{tag}> closes nothing"
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def read(path: Path) -> Page:
    text = path.read_text("utf-8")
    page = Page(text)
    assert page.open == []
    assert re.findall(r"https?:|//[a-z]|@import|<script|url\((?!#)", text) == []
    assert all(link.startswith(("#", "data:image/")) for link in page.links)
    return page


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("effect")
    write_report(folder, outcome("effect"), [landing("a"), landing("b/c +Z", "holdout")])
    return folder


@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_verdict_has_its_sentence_first_and_a_page(verdict: str, tmp_path: Path) -> None:
    assert verdict_sentence(outcome(verdict)) == SENTENCES[verdict]
    page = read(write_report(tmp_path, outcome(verdict), []))
    text = "".join(page.texts).replace("\u00a0", " ")
    assert SENTENCES[verdict] in text
    assert "orchestrator " in text
    assert "prove" not in text


def test_what_is_in_every_pair_that_is_left_is_said_to_be_missing(tmp_path: Path) -> None:
    told = outcome("cannot_tell")
    told.cannot_tell.names = ["soil_damping", "step_+Y", "step_-Z"]
    told.titles |= {"step_+Y": "A step under pad +Y", "step_-Z": "A step under pad -Z"}
    told.cannot_tell.answers = ["soil_damping + step_+Y", "soil_damping + step_-Z"]
    assert verdict_sentence(told).startswith(
        "Missing: soil damping at all pads, and one effect more."
        " These data cannot tell a step under pad +Y from a step under pad -Z: measure"
    )
    alone = replace(told, cannot_tell=replace(told.cannot_tell, answers=["soil_damping + step_+Y", "soil_damping"]))
    assert verdict_sentence(alone).startswith(
        "These data cannot tell soil damping at all pads with a step under pad +Y from soil damping at all pads: measure"
    )
    page = read(write_report(tmp_path, told, []))
    assert "What would decide between a step under pad +Y and a step under pad -Z" in "".join(page.texts).replace("\u00a0", " ")


@pytest.mark.parametrize(("verdict", "said"), [("effect", False), ("none_of_my_effects", False), ("cannot_tell", True)])
def test_a_gap_that_only_a_candidate_closes_is_not_said_to_be_closed_in_the_scenario(verdict: str, said: bool, tmp_path: Path) -> None:
    page = "".join(read(write_report(tmp_path, outcome(verdict), [])).texts).replace("\u00a0", " ")
    assert ("93 % by the best candidate, which is not added" in page) == said


@pytest.mark.parametrize("verdict", VERDICTS)
def test_missing_numbers_and_odd_names_harm_no_page(verdict: str, tmp_path: Path) -> None:
    page = read(write_report(tmp_path, bare(verdict), [odd_landing(), replace(odd_landing(), kind="holdout")]))
    assert not re.search(r"\b(nan|None|inf|Undefined)\b", "".join(page.texts))
    assert ODD in "".join(page.texts)
    assert {p.parent.name for p in tmp_path.rglob("*.*")} == {tmp_path.name, "courses", "figures"}


def test_an_empty_landing_and_no_candidate_still_make_a_page(tmp_path: Path) -> None:
    empty = replace(outcome("nothing_missing"), candidates=[], where=[], nuisances={}, noise={}, checks={})
    page = read(write_report(tmp_path, empty, [replace(landing(), channels=[], rest=[], contacts=[])]))
    assert page.labels == []


def test_numbers_of_the_json_stand_in_the_page_in_full(written: Path) -> None:
    page, tree = read(written / "report.html"), json.loads((written / "diagnosis.json").read_text("utf-8"))
    numbers = [tree["gap"][key] for key in ("fit_before", "fit_after", "holdout_before", "holdout_after", "closure")]
    numbers += [tree["simulations"], tree["readings"], tree["seconds"], tree["chi2_null"], tree["adequacy_null"]]
    for row in tree["candidates"]:
        numbers += [row[key] for key in ("log_evidence", "chi2", "probability", "adequacy", "holdout_gain") if row[key] is not None]
    numbers += [e["parameters"]["damping"]["value"] for e in tree["effects"]] + [
        w[k] for w in tree["where"] for k in ("from_s", "to_s", "sigmas")
    ]
    numbers += [tree["nuisances"]["soil.friction"][key] for key in ("value", "pull")] + list(tree["noise"]["rates.yaw"].values())
    assert {repr(value) for value in numbers} <= set(page.values)
    assert tree["sentence"] == SENTENCES["effect"]


def test_figures_stand_in_the_page_with_words_for_who_cannot_see_them(written: Path) -> None:
    page = read(written / "report.html")
    stems = {p.stem for p in (written / "figures").glob("*.png")}
    assert stems == {"where", "rivals", "nuisances", "rest", "a_rates", "a_attitude", "b-c-+Z_rates", "b-c-+Z_attitude", "b-c-+Z_rest"}
    assert len(page.labels) == len(stems)
    assert all(label and len(label) > 20 for label in page.labels)
    text = "".join(page.texts)
    assert all(f"figures/{stem}.png" in text for stem in stems)


def test_held_out_landings_have_a_section_of_their_own(written: Path) -> None:
    text = (written / "report.html").read_text("utf-8")
    assert text.index("Before and after") < text.index("On landings it was not fitted to") < text.index("The rivals")


def test_colours_of_figures_are_left_to_the_page(written: Path) -> None:
    body = (written / "report.html").read_text("utf-8").split("</style>")[1].lower()
    assert re.findall(r"#(?:222222|d55e00|0072b2|e6e6e6|b8b8b8)", body) == []
    assert "dejavu" not in body


def test_courses_are_kept_as_csv_in_si(written: Path) -> None:
    with (written / "courses" / "index.csv").open(encoding="utf-8") as file:
        index = list(csv.DictReader(file))
    assert [row["file"] for row in index][:2] == ["a_rates.yaw.csv", "a_rates.pitch.csv"]
    assert {row["unit"] for row in index} == {"rad/s", "rad", ""}
    with (written / "courses" / "a_rates.yaw.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    made = channel()
    assert np.array([float(r["time_s"]) for r in rows]) == pytest.approx(made.times, abs=1e-9)
    assert [float(r["measured"]) for r in rows if r["measured"]] == pytest.approx(made.data.tolist(), abs=1e-9)
    assert [float(r["time_s"]) for r in rows if r["measured"]] == pytest.approx(made.data_times.tolist(), abs=1e-9)
    assert [float(r["before"]) for r in rows if r["before"]] == pytest.approx(made.before.tolist(), abs=1e-9)


def test_the_report_says_whether_a_check_passed(tmp_path: Path) -> None:
    interval = {"channels": {}, "worst": 0.3, "halved": 3, "ok": False}
    for ok, said in ((True, "passed"), (False, "not passed")):
        found = outcome("effect")
        found.checks = {"chi2": {"null": 900.0}, "twin": {"worst": 0.04, "ok": ok}, "interval": interval}
        write_report(tmp_path, found, [])
        texts = [text.strip() for text in read(tmp_path / "report.html").texts]
        assert texts[texts.index("twin") :].index(said) < texts[texts.index("twin") :].index("interval")


def test_windows_are_drawn_on_the_data_s_clock() -> None:
    """They count from first contact, the residual's strip by the data's clock: here 50 s at first contact."""
    course = replace(landing("a"), shift=50.0)
    for one in course.channels:
        one.data_times = one.data_times + 50.0
    (window,) = [w for w in outcome("effect").where if w.channel == "rates.yaw"]
    picture = where_picture([window], course, {})
    assert picture is not None
    (box,) = [patch for patch in picture.figure.axes[0].patches if patch.get_width() > 0.01]
    assert (box.get_x(), box.get_x() + box.get_width()) == pytest.approx((50.0 + window.from_s, 50.0 + window.to_s))


def test_an_interval_open_to_a_side_can_be_missed() -> None:
    depth = RestValue("penetration.+Y", "m", 0.5, low=-np.inf, high=0.05, edge=0.0025)
    assert missed(depth, 0.04) == 0.0
    assert missed(depth, 0.055) == pytest.approx(-2.0)


def test_of_a_verdict_that_became_numerics_nothing_of_the_search_is_told_and_nothing_is_to_be_run() -> None:
    found = replace(outcome("effect"), verdict="numerics", sentence="")
    assert verdict_sentence(found) == "The numerics are not fine enough to judge."
    assert command(found).startswith("orchestrator diagnose ")


def test_checks_and_terms_are_told_with_their_deviation() -> None:
    assert flat({"coefficient": {"value": 151234.0, "sigma": 4000.0, "unit": "N.s2/m2"}}) == [
        ("coefficient", "151\u202f200 ± 4\u202f000 N·s²/m²")
    ]
    assert in_words({"largest_shift": 0.04, "rivals": ["v", 2], "none": None}) == "largest shift 0.04, rivals v, 2, none –"
    assert [in_words(value) for value in (True, 1200.0, 3e-9, float("nan"))] == ["yes", "1\u202f200", "3.000e−09", "–"]


def test_names_of_files_are_given_out_once() -> None:
    names = FileNames()
    stems = [names.stem("a/b", "+Z"), names.stem("A b", "+z"), names.stem("a", "-Z"), names.stem("../x"), names.stem("")]
    assert stems == ["a-b_+Z", "A-b_+z_2", "a_-Z", "_-x", "unnamed"]


def test_the_terminal_tells_sentence_rivals_gap_where_and_files(tmp_path: Path) -> None:
    console = Console(record=True, width=140, file=(tmp_path / "out").open("w", encoding="utf-8"))
    console.print(terminal_summary(outcome("effect"), Path("out")))
    text = console.export_text()
    for words in (
        SENTENCES["effect"],
        "+812.3",
        "6.31 → 1.06 σ",
        "rates.pitch",
        "orchestrator run out/revised.toml",
        "3187 landings",
        "report.html",
    ):
        assert words in text
    for verdict in VERDICTS:
        console.print(terminal_summary(bare(verdict)))
        console.print(terminal_summary(outcome(verdict)))


@pytest.mark.parametrize(
    ("verdict", "told"),
    [
        ("cannot_tell", ("penetration.+Z", "0.20 cm", "differs by 3 sigma")),
        ("data_fault", ("rates.yaw", "stands still for 40 samples", "0.400", "0.800")),
    ],
)
def test_the_terminal_says_what_would_decide_and_what_is_at_fault(tmp_path: Path, verdict: str, told: tuple[str, ...]) -> None:
    console = Console(record=True, width=140, file=(tmp_path / "out").open("w", encoding="utf-8"))
    console.print(terminal_summary(outcome(verdict)))
    text = console.export_text()
    assert "below" not in text
    for words in told:
        assert text.count(words) >= 1, text


def test_distinguish_orders_likeness_and_names_the_sensor(tmp_path: Path) -> None:
    table = distinction()
    page = read(write_distinction(tmp_path, table))
    text = "".join(page.texts)
    assert "These data could show 2 of 4 effects; 2 of them cannot be told from another." in text
    assert "Soil damping / Inertial drag" in text
    assert abs(table.order().index(0) - table.order().index(1)) == 1
    assert json.loads((tmp_path / "distinguish.json").read_text("utf-8"))["effects"][0]["lambda"] == 2300.5
    assert (tmp_path / "figures" / "likeness.png").is_file()
    console = Console(record=True, width=140, file=(tmp_path / "out").open("w", encoding="utf-8"))
    console.print(terminal_distinguish(table, tmp_path))
    assert "penetration.+Z" in console.export_text()


@pytest.mark.parametrize("count", [0, 1, 2])
def test_distinguish_of_few_effects_is_written(count: int, tmp_path: Path) -> None:
    full = distinction()
    read(write_distinction(tmp_path, Distinction("s", [], full.effects[:count], full.cosine[:count, :count], [])))


def test_numbers_are_written_as_a_person_reads_them() -> None:
    assert number(41234.5, 4) == "41\u202f230"
    assert number(-0.01234) == "−0.0123"
    assert number(float("nan")) == number(None) == "–"
    assert with_sigma(41234.5, 1312.0) == "41\u202f200 ± 1\u202f300"
    assert with_sigma(0.0312, 0.0041) == "0.0312 ± 0.0041"
    assert signed(-4.04) == "−4.0"
    assert (percent(0.931), percent(0.9999), chance(0.9999), chance(1e-9)) == ("93 %", "100 %", "> 99.9 %", "< 0.1 %")


def test_a_value_between_its_bounds_misses_nothing() -> None:
    stroke, depth = landing().rest
    assert missed(depth, 0.03) == 0.0
    assert missed(depth, 0.012) > 0.0 > missed(depth, 0.09)  # type: ignore[operator]
    assert missed(stroke, 0.1016 + 0.00635) == pytest.approx(-1.0)
    assert missed(stroke, None) is None


def test_where_no_stretch_of_a_channel_stands_out_the_picture_says_so() -> None:
    found = outcome("effect").where
    marked, plain = (where_picture(windows, landing(), {}) for windows in (found, []))
    assert found
    assert marked is not None
    assert plain is not None
    assert "the fuller the colour, the stronger" in marked.caption
    assert "in no stretch of any channel" in plain.caption


@pytest.mark.parametrize("named", [True, False])
def test_a_picture_of_values_at_rest_has_an_after_only_where_something_was_added(named: bool) -> None:
    picture = rest_picture(landing("one", "fit", named).rest)
    assert picture is not None
    (legend,) = picture.figure.legends
    assert ("after" in [text.get_text() for text in legend.get_texts()]) == named


def test_pairs_are_spoken_of_where_some_were_tried() -> None:
    found = outcome("none_of_my_effects")
    assert caution(found) == "No effect of the library is consistent with the readings."
    found.candidates.append(replace(found.candidates[0], name="soil_damping + swirl"))
    assert caution(found) == "No effect of the library, and no pair of them, is consistent with the readings."
    found.term = {"instead_of": "rcs_pulse + friction"}
    said = "The readings are consistent with rcs pulse and friction, too. A law that is not in the library is more probable."
    assert caution(found) == said
