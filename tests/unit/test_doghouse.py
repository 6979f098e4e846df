"""The Doghouse's search against boundaries that are known, its inputs against hand-made ones, its file against mistakes."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from orchestrator.doghouse.audit import drawn
from orchestrator.doghouse.flying import Logbook
from orchestrator.doghouse.landing import BOUNDARIES, Inputs, Margins, attitude, combinations, margins_of, overrides, start_values
from orchestrator.doghouse.model import Certified, Doghouse, read
from orchestrator.doghouse.outcome import Outcome
from orchestrator.doghouse.picture import draw
from orchestrator.doghouse.report import terminal_report
from orchestrator.doghouse.search import search
from orchestrator.doghouse.table import markdown
from orchestrator.errors import ScenarioError

PLAN = Path(__file__).parents[2] / "scenarios" / "doghouse.toml"
APOLLO = Certified(horizontal_limit_m_s=1.2192, vertical_at_zero_horizontal_m_s=3.048, vertical_at_horizontal_limit_m_s=2.1336)


class KnownBoundaries:
    """Stands in for `Flying`: a landing fails where its speed exceeds what its combination bears."""

    def __init__(self, weakest: float = 1.6) -> None:
        self.weakest = weakest
        self.flown: list[Inputs] = []

    def bears(self, one: Inputs, boundary: str) -> float:
        """Times the certified speed; the weakest combination is that of most friction, going down, tilted toward 90."""
        ease = 0.02 * (one.motion_deg != 180.0) + 0.03 * (one.tilt_toward_deg != 90.0) + 0.1 * (one.friction < 3.0)
        return self.weakest + ease + 0.05 * BOUNDARIES.index(boundary)

    def margins(self, one: Inputs) -> Margins:
        speed = math.hypot(one.horizontal_m_s, one.vertical_m_s)
        times = speed / APOLLO.speed_along(math.atan2(one.horizontal_m_s, one.vertical_m_s))
        left = {name: self.bears(one, name) - times for name in BOUNDARIES}
        return Margins(left, tuple(name for name in BOUNDARIES if left[name] < 0.0), True, True, dict.fromkeys(BOUNDARIES, "-Y.right"))

    def fly(self, scenario: object, landings: list[Inputs], stage: str) -> list[Margins]:
        self.flown += landings
        return [self.margins(one) for one in landings]


class Named:
    """Stands in for a scenario that is not flown."""

    path = Path("landing.toml")

    def overrides(self, inputs: Inputs) -> list[str]:
        return [f"body.yaw_start={inputs.heading_deg}"]


def found(plan: Doghouse, flying: KnownBoundaries, audited=()) -> Outcome:
    rays = search(plan, Named(), flying)
    cost = {"landings": 1.0, "flown_now": 1.0, "cpu_s": 1.0, "wall_s": 1.0, "workers": 1.0}
    return Outcome(plan, Named(), Named(), rays, {}, audited, cost)


def test_the_certified_envelope_is_a_wall_under_a_roof():
    assert APOLLO.speed_along(0.0) == pytest.approx(3.048)
    corner = math.atan2(1.2192, 2.1336)
    assert APOLLO.speed_along(corner) == pytest.approx(math.hypot(1.2192, 2.1336))
    assert APOLLO.speed_along(math.radians(80.0)) == pytest.approx(1.2192 / math.sin(math.radians(80.0)))
    on_the_roof = math.radians(10.0)
    speed = APOLLO.speed_along(on_the_roof)
    assert speed * math.cos(on_the_roof) == pytest.approx(APOLLO.roof(speed * math.sin(on_the_roof)))
    assert APOLLO.holds(1.2, 2.1)
    assert not APOLLO.holds(1.2, 2.2)


@pytest.mark.parametrize("boundary", BOUNDARIES)
def test_every_boundary_is_bracketed_by_the_weakest_combination(boundary):
    flying = KnownBoundaries()
    plan = read(PLAN)
    for ray in search(plan, Named(), flying):
        bracket = ray.brackets[boundary]
        bears = min(flying.bears(one, boundary) for one in ray.combinations) * ray.certified
        speeds = [math.hypot(one.horizontal_m_s, one.vertical_m_s) for one in (bracket.inside, bracket.beyond)]
        assert speeds[0] <= bears <= speeds[1]
        assert speeds[1] - speeds[0] <= plan.search.bracket_m_s + 1e-12
        assert not bracket.inside_margins.fails(boundary)
        assert bracket.beyond_margins.fails(boundary)
        assert all(not flying.margins(one.at(ray.angle, speeds[0])).fails(boundary) for one in ray.combinations)


def test_a_boundary_no_rung_reaches_is_told_and_not_invented():
    outcome = found(read(PLAN), KnownBoundaries(weakest=5.0))
    summary = outcome.as_dict()
    assert all(not points for points in summary["boundaries"].values())
    assert len(summary["not_reached"]) == 4 * len(read(PLAN).search.rays_deg)
    assert summary["all_outside"] is True
    assert {row["times_certified"] for row in summary["rungs"]} == {1.3, 2.0}
    assert all(sum(row["failed"].values()) == 0 for row in summary["rungs"])


def test_a_boundary_inside_the_envelope_is_named_with_its_landing_and_reason(tmp_path):
    outcome = found(read(PLAN), KnownBoundaries(weakest=0.9))
    summary = outcome.as_dict()
    assert summary["all_outside"] is False
    first = next(point for point in summary["inside_certified"] if point["unit"] == "deg")
    assert first["times_certified"] < 0.93
    assert first["inputs"]["friction"] == 3.0
    assert first["beyond"]["why"].startswith("goes over the edge")
    console = Console(width=160, record=True)
    console.print(terminal_report(outcome, tmp_path))
    assert "tip over inside the envelope: heading" in console.export_text()
    assert "| tip over |" in markdown(outcome)
    assert draw(outcome, tmp_path / "doghouse.png").stat().st_size > 20_000


def test_a_failure_at_random_inside_the_envelope_denies_that_all_lies_outside(tmp_path):
    plan = read(PLAN)
    tipped = Margins(dict.fromkeys(BOUNDARIES, -1.0), ("tip_over",), True, False)
    outcome = found(plan, KnownBoundaries(), [(drawn(plan)[0], tipped)])
    outcome.write(tmp_path)
    summary = json.loads((tmp_path / "doghouse.json").read_text())
    assert summary["all_outside"] is False
    assert summary["audit"]["failed"][0]["failed"] == ["tip_over"]
    assert summary["not_trusted"] == 0
    assert set(summary["boundaries"]["tip_over"][0]) >= {"horizontal_m_s", "vertical_m_s", "inputs", "margin"}
    console = Console(width=160, record=True)
    console.print(terminal_report(outcome, tmp_path))
    assert "1 landings inside the certified envelope fail" in console.export_text()


def test_a_landing_that_cannot_be_flown_is_held_to_fail():
    lost = margins_of({}, "the unit gave up")
    assert all(lost.fails(name) for name in BOUNDARIES)
    assert lost.error == "the unit gave up"


def test_what_could_not_be_flown_is_flown_again_by_the_next_call(tmp_path):
    """A worker that died, a time limit: nothing that the landing would repeat."""
    logbook = Logbook(tmp_path / "landings.jsonl")
    logbook.put("lost", margins_of({}, "the unit gave up"), 1.0)
    logbook.put("flown", margins_of({"stable": True}, "", trusted=False), 1.0)
    again = Logbook(tmp_path / "landings.jsonl")
    assert logbook.get("lost") is not None
    assert again.get("lost") is None
    assert again.get("flown").trusted is False


def test_a_vehicle_that_turns_too_fast_to_stay_inside_has_no_margin_left():
    margins = margins_of({"failure.failed": "tip_over", "failure.tip_over.least_angle_deg": 3.0}, "")
    assert margins.left["tip_over"] == 0.0
    assert margins.fails("tip_over")


@pytest.mark.parametrize("motion", [0.0, 90.0, 180.0])
def test_speeds_in_the_body_turn_back_into_those_over_the_ground(motion):
    one = Inputs(1.2, 2.1, 45.0, motion, 6.0, 90.0, 0.33)
    values = start_values(one)
    over_ground = attitude(one).apply(values["velocity"])
    expected = [-2.1, 1.2 * math.sin(math.radians(motion)), 1.2 * math.cos(math.radians(motion))]
    assert over_ground == pytest.approx(expected, abs=1e-12)


def test_a_tilt_leans_the_axis_toward_its_direction_whatever_the_heading():
    for heading in (0.0, 45.0, -130.0):
        axis = attitude(Inputs(0.0, 0.0, heading, 0.0, 6.0, 90.0, 1.0)).apply([1.0, 0.0, 0.0])
        assert axis == pytest.approx([math.cos(math.radians(6.0)), math.sin(math.radians(6.0)), 0.0], abs=1e-12)


def test_the_angles_are_those_of_the_321_sequence():
    one = Inputs(0.0, 0.0, 30.0, 0.0, 6.0, 200.0, 1.0)
    yaw, pitch, roll = (start_values(one)[name][0] for name in ("yaw", "pitch", "roll"))

    def turn(axis: int, angle: float) -> np.ndarray:
        c, s = math.cos(angle), math.sin(angle)
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        matrix = np.eye(3)
        matrix[i, i] = matrix[j, j] = c
        matrix[i, j], matrix[j, i] = -s, s
        return matrix

    assert turn(2, roll) @ turn(1, pitch) @ turn(0, yaw) == pytest.approx(attitude(one).as_matrix(), abs=1e-12)


def test_one_number_goes_to_every_address_and_a_vector_to_its_elements():
    places = {name: [f"b.{name}"] for name in ("yaw", "pitch", "roll")}
    places |= {"velocity": ["b.v[1]", "b.v[2]", "b.v[3]"], "friction": ["s.f[1]", "s.f[2]"]}
    given = overrides(Inputs(0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.5), places)
    assert given == ["b.v[1]=-2.0", "b.v[2]=0.0", "b.v[3]=0.0", "b.yaw=0.0", "b.pitch=0.0", "b.roll=0.0", "s.f[1]=0.5", "s.f[2]=0.5"]


def test_straight_down_there_is_one_direction_of_motion():
    varies = read(PLAN).varies
    assert len(combinations(varies)) == len(varies.motion_deg) * len(combinations(varies, without_motion=True))


def test_landings_at_random_lie_inside_the_envelope_and_are_the_same_every_time():
    plan = read(PLAN)
    assert len(drawn(plan)) == plan.audit.landings
    assert all(plan.certified.holds(one.horizontal_m_s, one.vertical_m_s) for one in drawn(plan))
    assert drawn(plan) == drawn(plan)


def test_a_line_half_written_is_flown_again(tmp_path):
    book = Logbook(tmp_path / "landings.jsonl")
    margins = Margins(dict.fromkeys(BOUNDARIES, 1.0), (), True, True, {"tip_over": "+Z | +Y"}, 0.3)
    book.put("a", margins, 0.5)
    with book.path.open("a") as file:
        file.write('{"key": "b", "left"')
    again = Logbook(book.path)
    assert again.get("a") == margins
    assert again.cost["a"] == 0.5
    assert again.get("b") is None


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("bracket_m_s", "braket_m_s", 'unknown key; did you mean "bracket_m_s"?'),
        ("rungs = [1.3, 2.0]", "rungs = [2.0, 1.3]", "must rise"),
        ("friction = [0.33, 1.0, 3.0]", "friction = [-1.0]", "greater than 0"),
        ('yaw = "lander.yaw_start"', 'yow = "lander.yaw_start"', 'did you mean "yaw"?'),
    ],
)
def test_a_mistake_in_the_plan_is_one_line(tmp_path, old, new, said):
    text = PLAN.read_text()
    assert old in text
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(text.replace(old, new, 1))
    with pytest.raises(ScenarioError) as caught:
        read(wrong)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)
