"""A scenario written as an .ssp and run again."""

import json
from pathlib import Path

import pytest
from checkpoint_runs import orchestrator, run
from fmi_samples import oscillator
from lxml import etree
from ssp_runs import columns, description, exported, packed, same_bits
from ssp_samples import in_unit

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.errors import OrchestratorError
from orchestrator.fmi.unpack import private_folder
from orchestrator.ssp.archive import parsed, schema_fault
from orchestrator.terrain.hand_over import MAP

ROOT = Path(__file__).resolve().parents[2]
APOLLO = ROOT / "scenarios" / "apollo11_zupp.toml"
DROP = ROOT / "scenarios" / "footpad_drop.toml"
built = pytest.mark.skipif(not (ROOT / "build" / "fmus" / "GearLeg.fmu").exists(), reason="python build_fmus.py first")


@built
def test_a_landing_from_an_ssp_has_the_same_bits_and_starts_solved(tmp_path: Path) -> None:
    ssp = exported(APOLLO, tmp_path / "apollo.ssp")
    whole = columns(APOLLO, 0.1)
    assert max(whole["soil+Y.penetration"]) > 0.0             # a foot has touched
    same_bits(whole, columns(ssp, 0.1))
    one, other = (draw_up(read_scenario(path), path).scenario.as_run() for path in (APOLLO, ssp))
    assert [one[key] for key in ("connections", "master", "start", "record")] == [
        other[key] for key in ("connections", "master", "start", "record")
    ]
    assert Path(other["results"]["references"]).read_bytes() == (APOLLO.parent / "paper.toml").read_bytes()
    position = float(_given(ssp)["body", "position_start[1]"])
    assert position == whole["body.body.position[1]"][0]      # solved in the file, for hosts that cannot
    for i in (1, 2, 3, 4):                                    # a connected input starts at what feeds it
        assert float(_given(ssp).get(("leg+Z", f"body.quaternion[{i}]"), 0.0)) == whole[f"body.body.quaternion[{i}]"][0]


@built
def test_a_changed_parameter_solves_the_start_condition_again(tmp_path: Path) -> None:
    ssp, change = exported(APOLLO, tmp_path / "apollo.ssp"), ("body.pitch_start=0.05",)
    one, other = columns(APOLLO, 0.01, change), columns(ssp, 0.01, change)
    assert min(other[f"soil{leg}.gap"][0] for leg in ("+Z", "+Y", "-Z", "-Y")) == pytest.approx(0.0, abs=1e-9)   # m
    assert other["body.body.position[1]"][0] == pytest.approx(one["body.body.position[1]"][0], abs=1e-9)         # m


@built
def test_nothing_in_the_file_points_at_this_machine(tmp_path: Path) -> None:
    ssp = exported(ROOT / "scenarios" / "apollo11_dem.toml", tmp_path / "dem.ssp")
    text = etree.tostring(description(ssp))
    assert str(ROOT).encode() not in text
    assert str(private_folder()).encode() not in text
    given = next(path for (unit, name), path in _given(ssp).items() if name == MAP and unit == "soil+Y")
    assert given.startswith("resources/")                     # for tools that know no [terrain]
    ground = read_scenario(ssp).table.terrain
    assert ground is not None
    assert Path(ground.file or "").read_bytes() == (ROOT / "scenarios" / "terrain" / "site.npy").read_bytes()
    unpacked = draw_up(read_scenario(ssp), ssp)
    heights = {Path(str(values[MAP])) for values in unpacked.values if MAP in values}
    assert len(heights) == 1
    assert next(iter(heights)).is_file()
    assert next(iter(heights)).parent != private_folder()


def _given(ssp: Path) -> dict[tuple[str, str], str]:
    return {
        (component.get("name"), parameter.get("name")): parameter[0].get("value")
        for component in description(ssp).iter("{*}Component") for parameter in component.iter("{*}Parameter")
    }  # fmt: skip


def test_every_description_is_valid_by_the_standards_schema_and_a_mutilated_one_is_not(tmp_path: Path) -> None:
    root = description(exported(oscillator(tmp_path), tmp_path / "system.ssp"))
    assert schema_fault(root) == ""
    root.remove(root[0])
    assert "System" in schema_fault(root)


def test_the_same_scenario_gives_the_same_file(tmp_path: Path) -> None:
    scenario = oscillator(tmp_path)
    one, other = (exported(scenario, tmp_path / name) for name in ("one.ssp", "other.ssp"))
    assert one.read_bytes() == other.read_bytes()


def test_a_variant_stands_beside_the_default_and_runs_by_its_name(tmp_path: Path) -> None:
    scenario, heavy = oscillator(tmp_path), tmp_path / "heavy.toml"
    heavy.write_text("[units.b.parameters]\nmass = 9.0\n")
    ssp = exported(scenario, tmp_path / "both.ssp", "--variant", f"heavy={heavy}")
    assert schema_fault(description(ssp, "heavy.ssd")) == ""
    (tmp_path / "over.toml").write_text('extends = "both.ssp#heavy.ssd"\n')
    expected = columns(scenario, overrides=["b.mass=9.0"])
    same_bits(expected, columns(ssp, variant="heavy"))
    same_bits(expected, columns(tmp_path / "over.toml"))
    same_bits(columns(scenario), columns(ssp))
    with pytest.raises(OrchestratorError, match='no variant "hevy"; did you mean "heavy"'):
        read_scenario(ssp, variant="hevy")


def test_a_connection_changed_in_the_file_is_changed_in_the_run(tmp_path: Path) -> None:
    ssp = exported(oscillator(tmp_path), tmp_path / "cut.ssp")
    root = description(ssp)
    cut = next(c for c in root.iter("{*}Connection") if c.get("endElement") == "b" and c.get("endConnector") == "end.force")
    cut.getparent().remove(cut)
    packed(ssp, {"SystemStructure.ssd": etree.tostring(root)})
    result = columns(ssp)
    force, mass = -20.0, 2.0                                  # N: the spring's at the start, where the input stays; kg
    assert result["b.end.velocity"] == pytest.approx(force / mass * result["time"], rel=1e-9)


def test_a_system_without_our_annotation_finds_the_joined_ports_by_itself(tmp_path: Path) -> None:
    scenario = oscillator(tmp_path)
    ssp = exported(scenario, tmp_path / "plain.ssp")
    root = description(ssp)
    root.remove(root.findall("{*}Annotations")[-1])
    packed(ssp, {"SystemStructure.ssd": etree.tostring(root)})
    plain = draw_up(read_scenario(ssp), ssp)
    assert [set(c.as_run()["ports"]) for c in plain.scenario.connections] == [{"spring.a", "a.end"}, {"spring.b", "b.end"}]
    assert columns(ssp)["b.position"][-1] == pytest.approx(columns(scenario)["b.position"][-1], abs=1e-5)    # m: other intervals


def test_a_scaled_and_converted_connection_is_written_with_its_factor_and_comes_back_to_the_same_bits(tmp_path: Path) -> None:
    scenario = tmp_path / "converted.toml"
    scenario.write_text(f"""
stop_time = 0.05
[units.one]
fmu = "{in_unit(tmp_path, "m").as_posix()}"
[units.two]
fmu = "{in_unit(tmp_path, "mm").as_posix()}"
[[connections]]
from = "one.x"
to = "two.u"
scale = -0.3
offset = 0.7
""")
    ssp = exported(scenario, tmp_path / "converted.ssp")
    connection = next(description(ssp).iter("{*}Connection"))
    assert connection.get("suppressUnitConversion") == "true"          # the conversion is in the factor: few hosts do it themselves
    assert {name: float(value) for name, value in connection[0].attrib.items()} == {"factor": -300.0, "offset": 0.7}
    whole = columns(scenario)
    same_bits(whole, columns(ssp))
    root = description(ssp)
    for annotations in root.findall(".//{*}Annotations"):
        annotations.getparent().remove(annotations)
    packed(ssp, {"SystemStructure.ssd": etree.tostring(root)})
    assert columns(ssp)["two.x"] == pytest.approx(whole["two.x"], rel=1e-12)


@built
def test_a_frame_is_refused_because_the_standard_has_no_words_for_it(tmp_path: Path) -> None:
    turned = "frame = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]"
    text = DROP.read_text("utf-8").replace('ports = ["soil.pad", "body.effect1"]', f'ports = ["soil.pad", "body.effect1"]\n{turned}')
    (tmp_path / "turned.toml").write_text(f'fmus = "{(ROOT / "build" / "fmus").as_posix()}"\n{text}')
    done = orchestrator("export", "turned.toml", "--ssp", "x.ssp", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr == (
        "error: turned.toml: soil -> body.effect1.force[1]: adds up pad.force[1], pad.force[2] (a frame), which SSP has no words for;"
        " turn it in a unit\n"
    )


def test_a_run_says_which_file_it_was_of(tmp_path: Path) -> None:
    ssp = exported(oscillator(tmp_path), tmp_path / "system.ssp", "--output", "spring.stretch")
    assert "stretch" in {c.get("name") for c in description(ssp).iter("{*}Connector")}
    run(ssp, tmp_path / "out")
    inputs = json.loads((tmp_path / "out" / "inputs.json").read_text("utf-8"))
    assert inputs["scenario"] == "system.ssp"
    assert len(inputs["scenario_sha256"]) == 64


@pytest.mark.parametrize(("arguments", "line"), [
    (["export", "osc.toml", "--ssp", "x.zip"], "error: --ssp x.zip: expects a file that ends in .ssp; call it x.ssp\n"),
    (["export", "osc.toml", "--ssp", "x.ssp", "--variant", "heavy"], "error: --variant heavy: expects NAME=overlay.toml\n"),
    (["export", "osc.toml", "--ssp", "x.ssp", "--step", "0"], "error: --step 0: is not positive, expects s; give 1e-4 or so\n"),
    (["run", "none.ssp"], "error: none.ssp: no such file; `orchestrator list` shows the scenarios there are\n"),
    (["run", "broken.ssp"], None),
    (["run", "osc.toml", "--variant", "heavy"],
     "error: --variant heavy: osc.toml is a scenario file, variants are in an .ssp; leave it out\n"),
])  # fmt: skip
def test_a_wrong_request_is_one_line(arguments: list[str], line: str | None, tmp_path: Path) -> None:
    oscillator(tmp_path).rename(tmp_path / "osc.toml")
    (tmp_path / "broken.ssp").write_text("no archive")
    done = orchestrator(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert line is None or done.stderr == line


def test_a_document_that_is_no_ssp_is_refused_with_its_name(tmp_path: Path) -> None:
    for name, text, complaint in (
        ("a.ssd", "<a version='1.0'/>", r"a\.ssd: not valid SSP 1\.0: unknown root element a"),
        ("b.ssd", "<b version='3.0'/>", r'is of version "3\.0", expects 1\.0 or 2\.0'),
        ("c.ssd", "<c", "not well-formed XML"),
    ):
        (tmp_path / name).write_text(text)
        with pytest.raises(OrchestratorError, match=complaint):
            parsed(tmp_path / name, name)
