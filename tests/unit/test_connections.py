"""Connections that choose elements, convert units of measure, turn frames or change signs; and overlays that swap a unit."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_samples import oscillator
from scipy.spatial.transform import Rotation

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.errors import ScenarioError, WiringError
from orchestrator.master.converter import Derived
from orchestrator.master.slave import Interface, Kind, Variable
from orchestrator.scenario.conversion import Alteration, linear_map
from orchestrator.scenario.expand import Connection, expand
from orchestrator.scenario.model import ScenarioTable
from orchestrator.scenario.read import check_table, merge
from orchestrator.scenario.wiring import Wiring
from orchestrator.simulation import run_scenario


def si(factor: float = 1.0, offset: float = 0.0, **exponents: float) -> tuple[float, ...]:
    return (*(exponents.get(base, 0.0) for base in ("kg", "m", "s", "A", "K", "mol", "cd", "rad")), factor, offset)


UNITS = {
    "m": si(m=1), "km": si(1e3, m=1), "N": si(kg=1, m=1, s=-2), "kN": si(1e3, kg=1, m=1, s=-2), "rad": si(rad=1),
    "deg": si(np.pi / 180, rad=1), "K": si(K=1), "degC": si(1.0, 273.15, K=1), "degF": si(5 / 9, 459.67 * 5 / 9, K=1),
}  # fmt: skip
TURN = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
MIRROR = ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0))


def variable(name: str, causality: str, unit: str = "", kind: Kind = Kind.REAL) -> Variable:
    return Variable(name, kind, causality, unit, UNITS.get(unit))


def interface(*entries: tuple[Any, ...]) -> Interface:
    """(name, causality, unit, kind) or, for a vector, with the number of elements at the end."""
    found = []
    for name, causality, unit, kind, count in entries:
        names = [name] if count == 0 else [f"{name}[{i + 1}]" for i in range(count)]
        found += [variable(n, causality, unit, kind) for n in names]
    return Interface("M", {v.name: v for v in found})


R, B, S = Kind.REAL, Kind.BOOLEAN, Kind.STRING
IMU = interface(
    *((n, "output", "deg", R, 0) for n in "pqr"),
    ("port.force", "output", "kN", R, 3), ("port.force_mean", "output", "kN", R, 3), ("port.force_slope", "output", "kN", R, 3),
    ("port.contact", "output", "", B, 0), ("count", "output", "", Kind.INTEGER, 0), ("name", "output", "", S, 0),
    ("heat", "output", "degF", R, 0),
    ("port.mass", "output", "", R, 0), ("port.quaternion", "output", "", R, 4), ("tick", "output", "", Kind.CLOCK, 0),
)  # fmt: skip
BODY = interface(
    ("rates", "input", "rad", R, 3), ("port.force", "input", "N", R, 3), ("port.force_slope", "input", "N", R, 3),
    ("port.contact", "input", "", B, 0), ("level", "input", "", R, 0), ("title", "input", "", S, 0), ("heat", "input", "degC", R, 0),
    ("port.quaternion", "input", "", R, 4), ("height", "input", "m", R, 0),
)  # fmt: skip
SCALAR = interface(("port.mass", "input", "", R, 0))


def wired(first: str, second: str, both_ways: bool = False, **asked: Any) -> Wiring:
    wiring = Wiring({"imu": IMU, "body": BODY, "scalar": SCALAR}, "case.toml")
    wiring.connect(Connection(first, second, both_ways, True, None, Alteration(**asked)))
    return wiring


def sent(wiring: Wiring, unit: int = 0, **values: float) -> dict[str, float]:
    """What arrives at each target when the source's outputs have these values."""
    derived = {it.variable.name: it for it in wiring.derived[unit]}

    def value(it: Derived) -> float:
        return sum(weight * values[source] for weight, source in zip(it.weights, it.sources, strict=True)) + it.offset

    return {k.target: value(derived[k.source]) if k.source in derived else values[k.source] for k in wiring.links}


def test_what_needs_no_conversion_is_linked_as_it_is() -> None:
    assert wired("imu.count", "body.level").derived == [[], [], []]
    assert [k.source for k in wired("imu.name", "body.title").links] == ["name"]


def test_units_of_measure_of_one_dimension_are_converted() -> None:
    wiring = wired("imu.p, imu.r, imu.q", "body.rates")
    assert sent(wiring, p=180.0, q=90.0, r=-180.0) == pytest.approx({"rates[1]": np.pi, "rates[2]": -np.pi, "rates[3]": np.pi / 2})
    assert sent(wired("imu.heat", "body.heat"), heat=212.0)["heat"] == pytest.approx(100.0)


def test_means_and_slopes_are_converted_with_their_variable_and_a_slope_has_no_offset() -> None:
    wiring = wired("imu.port.force", "body.port.force", offset=(5.0,))
    base = wiring.links[0].source.partition("[")[0]
    shifts = {it.variable.name: (it.weights, it.offset) for it in wiring.derived[0]}
    assert shifts[f"{base}[2]"] == shifts[f"{base}_mean[2]"] == ((1000.0,), 5.0)
    assert shifts[f"{base}_slope[2]"] == ((1000.0,), 0.0)


def test_elements_are_chosen_one_by_one_by_range_or_in_any_order() -> None:
    def names(first: str, second: str) -> list[tuple[str, str]]:
        wiring = Wiring({"imu": IMU, "body": BODY}, "case.toml")
        wiring.connect(Connection(first, second, False, True))
        return [(wiring.derived[0][at].sources[0], k.target) for at, k in enumerate(wiring.links)]

    assert names("imu.port.force[3]", "body.port.force[1]") == [("port.force[3]", "port.force[1]")]
    assert names("imu.port.force[2:3]", "body.port.force[1:2]")[1] == ("port.force[3]", "port.force[2]")
    assert [one for one, _ in names("imu.port.force[3,1,2]", "body.port.force")] == ["port.force[3]", "port.force[1]", "port.force[2]"]


def test_a_frame_turns_vectors_quaternions_and_matrices_alike() -> None:
    """An attitude, a vector seen in it and a matrix acting on it are turned one by one and still belong together."""
    turn = Rotation.from_euler("zyx", [0.3, -0.7, 1.1])
    asked = Alteration(frame=tuple(map(tuple, turn.as_matrix())))
    made = {
        name: linear_map([variable(f"{name}[{i}]", "output") for i in range(n)], [variable("t", "input")] * n, asked, "").weights
        for name, n in (("vector", 3), ("matrix", 9), ("pad.quaternion", 4))
    }
    attitude, inner, matrix = Rotation.from_euler("xyz", [0.2, 0.4, -0.9]), np.array([1.0, -2.0, 3.0]), np.arange(9.0).reshape(3, 3)
    seen = attitude.apply(inner)
    w, x, y, z = made["pad.quaternion"] @ np.roll(attitude.as_quat(), 1)
    assert Rotation.from_quat([x, y, z, w]).apply(inner) == pytest.approx(made["vector"] @ seen)
    turned = (made["matrix"] @ matrix.ravel()).reshape(3, 3)
    assert turned @ (made["vector"] @ seen) == pytest.approx(made["vector"] @ (matrix @ seen))


def test_ports_are_turned_both_ways() -> None:
    wiring = wired("imu.port", "body.port", both_ways=True, frame=TURN)
    forces = {f"port.force[{i}]": float(i) for i in (1, 2, 3)} | {"port.contact": 1.0} | {f"port.quaternion[{i}]": 0.0 for i in range(1, 5)}
    arrived = sent(wiring, **forces)
    assert [arrived[f"port.force[{i}]"] for i in (1, 2, 3)] == [3000.0, 1000.0, 2000.0]
    assert arrived["port.contact"] == 1.0
    back = Alteration(TURN).back().frame
    assert np.array(back) @ np.array(TURN) == pytest.approx(np.eye(3))


REFUSED = {
    ("imu.port.force[4]", "body.level", False): "imu.port.force[4]: asks for element 4 of 3; give 1 to 3",
    ("imu.port.force[3:1]", "body.level", False): "[3:1] names no elements; give e.g. [2], [1:3] or [3,1,2]",
    ("imu.p, body.level", "body.rates", False): "body.level: is of causality input",
    ("imu.p", "body.height", False): "imu.p -> body.height: sends deg, expects m; connect variables that measure the same",
    ("imu.tick", "body.level", False): "sends Clock, which this master does not exchange",
    ("imu.name", "body.level", False): "sends String, expects Real",
    ("imu.port.contact", "body.level", False): "sends Boolean, expects Real",
}


@pytest.mark.parametrize(("ends", "message"), REFUSED.items())
def test_what_cannot_be_connected_is_said_in_one_line(ends: tuple[str, str, bool], message: str) -> None:
    with pytest.raises(WiringError) as caught:
        wired(*ends)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


ALTERED = {
    ("imu.port", "scalar.port", True, Alteration(frame=TURN)): "frame turns a vector of 3, a matrix of 9 by rows, or a quaternion of 4",
    ("imu.port", "body.port", True, Alteration(frame=MIRROR)): "frame mirrors (its determinant is -1), which torques and rates",
    ("imu.port.quaternion", "body.port.quaternion", False, Alteration(frame=MIRROR)): "which no quaternion can; give a rotation",
    ("imu.port.force", "body.port.force", False, Alteration(scale=(1.0, 2.0))): "scale has 2 numbers, expects 1 or 3",
    ("imu.name", "body.title", False, Alteration(scale=(2.0,))): "expects String, which takes no frame, scale or offset",
}


@pytest.mark.parametrize(("asked", "message"), ALTERED.items())
def test_a_frame_scale_or_offset_that_has_no_meaning_is_refused(asked: tuple[str, str, bool, Alteration], message: str) -> None:
    first, second, both_ways, altered = asked
    wiring = Wiring({"imu": IMU, "body": BODY, "scalar": SCALAR}, "case.toml")
    with pytest.raises(WiringError) as caught:
        wiring.connect(Connection(first, second, both_ways, True, None, altered))
    assert message in str(caught.value)


MIRRORED = "\n".join(
    f'[[connections]]\nfrom = "{one}"\nto = "{other}"\nscale = -1'
    for mass in "ab"
    for one, other in ((f"{mass}.end.velocity", f"spring.{mass}.velocity"), (f"spring.{mass}.force", f"{mass}.end.force"))
)


def test_a_mirrored_spring_swings_to_the_same_bits(tmp_path: Path) -> None:
    """Means, slopes and error estimates pass through the changed sign too, or the steps would differ."""
    plain = run_scenario(oscillator(tmp_path))
    mirrored = tmp_path / "mirrored"
    mirrored.mkdir()
    ports = {f'[[connections]]\nports = ["{m}.end", "spring.{m}"]': "" for m in "ab"}
    path = oscillator(mirrored, f"\n[units.spring.parameters]\nstretch_start = -0.2\n{MIRRORED}\n", **ports)
    result = run_scenario(path)
    assert result.times.tolist() == plain.times.tolist()
    assert (result.columns["a.position"] == plain.columns["a.position"]).all()
    assert (result.columns["spring.stretch"] == -plain.columns["spring.stretch"]).all()
    assert [row.estimate for row in result.log] == [row.estimate for row in plain.log]
    again = run_scenario(path, (), {"record": {"variables": ["a.*"]}})
    assert (again.columns["a.position"] == plain.columns["a.position"]).all()


def test_the_scenario_as_run_says_what_a_connection_altered(tmp_path: Path) -> None:
    ports = {f'[[connections]]\nports = ["{m}.end", "spring.{m}"]': "" for m in "ab"}
    path = oscillator(tmp_path, MIRRORED, **ports)
    scenario = read_scenario(path)
    assert scenario.as_run()["connections"][0] == {"from": "a.end.velocity", "to": "spring.a.velocity", "slope": True, "scale": [-1.0]}
    again = expand(check_table(scenario.as_run(), "again"), "again")
    assert again.connections == scenario.connections
    assert draw_up(again, path).links == draw_up(scenario, path).links


BASE: dict[str, Any] = {
    "stop_time": 1.0,
    "each": {"leg": ["+Z", "+Y"]},
    "units": {
        "guidance": {"fmu": "GuidanceControl", "once": True, "parameters": {"thrust_start": 5.0}},
        "leg{leg}": {"fmu": "GearLeg", "parameters": {"azimuth": {"+Z": 0.0, "+Y": 1.5}, "mass": 3.0}},
    },
    "connections": [{"ports": ["guidance.engine", "body.engine"]}, {"from": "leg{leg}.contact", "to": "guidance.contact{leg#}"}],
}


def overlaid(overlay: dict[str, Any]) -> ScenarioTable:
    return check_table(merge(BASE, overlay), "overlay")


def test_another_fmu_is_another_unit_and_takes_nothing_of_the_old_ones_table() -> None:
    swapped = overlaid({"units": {"guidance": {"fmu": "gnc.fmu"}}}).units["guidance"]
    assert (swapped.parameters, swapped.once) == ({}, False)
    kept = overlaid({"units": {"guidance": {"fmu": "GuidanceControl", "parameters": {"decay_time": 1.0}}}}).units["guidance"]
    assert (kept.parameters, kept.once) == ({"thrust_start": 5.0, "decay_time": 1.0}, True)


def test_one_of_several_alike_can_be_replaced_or_given_other_values() -> None:
    other = expand(overlaid({"units": {"leg+Y": {"fmu": "MyLeg", "parameters": {"azimuth": 1.6}}}}), "overlay")
    assert [(u.name, u.fmu, u.parameters) for u in other.units] == [
        ("guidance", "GuidanceControl", {"thrust_start": 5.0}),
        ("leg+Z", "GearLeg", {"azimuth": 0.0, "mass": 3.0}),
        ("leg+Y", "MyLeg", {"azimuth": 1.6}),
    ]
    same = expand(overlaid({"units": {"leg+Z": {"fmu": "GearLeg", "parameters": {"mass": 4.0}}}}), "overlay")
    assert [u.parameters for u in same.units][1:] == [{"azimuth": 0.0, "mass": 4.0}, {"azimuth": 1.5, "mass": 3.0}]


def test_an_overlay_takes_connections_of_its_base_away() -> None:
    table = overlaid({"disconnect": ["guidance.contact*"], "connections": [{"from": "leg+Z.contact", "to": "guidance.touch"}]})
    assert [c.ports or (c.source, c.target) for c in table.connections] == [
        ["guidance.engine", "body.engine"], ("leg+Z.contact", "guidance.touch"),
    ]  # fmt: skip
    assert overlaid({"disconnect": ["guidance"]}).connections == []
    with pytest.raises(ScenarioError, match=r'disconnect: "guidanc" is an end of no connection of the base; did you mean'):
        overlaid({"disconnect": ["guidanc"]})
