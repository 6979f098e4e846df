"""An .ssp that knows nothing of this project, in SSP 1.0 and 2.0."""

import importlib.resources
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from lxml import etree
from ssp_runs import packed
from ssp_samples import plain_ssp, texts

from orchestrator.blueprint import Blueprint, draw_up, read_scenario
from orchestrator.errors import OrchestratorError
from orchestrator.master.slave import Variable
from orchestrator.simulation import run_scenario
from orchestrator.ssp.archive import schema_fault
from orchestrator.ssp.export import Contents
from orchestrator.ssp.values import Parameter, _in_unit
from orchestrator.ssp.ways import Way

both = pytest.mark.parametrize("version", ["1.0", "2.0"])
METRES, MILLIMETRES = ((0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, factor, 0.0) for factor in (1.0, 1e-3))
TWO = importlib.resources.files("pyssp_standard") / "resources" / "ssp2"


def drawn(ssp: Path) -> Blueprint:
    return draw_up(read_scenario(ssp), ssp)


def values(ssp: Path) -> dict[str, dict[str, object]]:
    blueprint = drawn(ssp)
    return dict(zip(blueprint.interfaces, map(dict, blueprint.values), strict=True))


def test_the_fixture_itself_is_valid_by_the_schemas_of_both_versions() -> None:
    for text in texts("1.0").values():
        assert schema_fault(etree.fromstring(text.encode())) == ""
    schemas = {"ssd": "Description", "ssv": "ParameterValues", "ssm": "ParameterMapping"}
    for name, text in texts("2.0").items():
        schema = etree.XMLSchema(file=str(TWO / f"SystemStructure{schemas[name[-3:]]}.xsd"))
        schema.assertValid(etree.fromstring(text.encode()))


@both
def test_systems_in_systems_become_units_under_their_paths(tmp_path: Path, version: str) -> None:
    blueprint = drawn(plain_ssp(tmp_path, version))
    assert list(blueprint.interfaces) == ["first", "inner_part_second"]
    assert blueprint.scenario.table.stop_time == 0.1


@both
def test_a_connection_through_a_system_is_transformed_and_converted_on_the_way(tmp_path: Path, version: str) -> None:
    connection = drawn(plain_ssp(tmp_path, version)).scenario.connections[0]
    assert (connection.first, connection.second) == ("first.x", "inner_part_second.u")
    result = run_scenario(plain_ssp(tmp_path, version), (), {"master": {"max_interval": 1e-3}})
    t = result.times                                          # x1 = 1.5 t m, from u1 = 0.5 m; u2 = 2·1000·x1 + 1 mm; x2' = 1 + u2
    assert result.columns["first.x"] == pytest.approx(1.5 * t, abs=1e-12)
    assert result.columns["inner_part_second.x"][-1] == pytest.approx(2.0 * t[-1] + 1500.0 * t[-1] ** 2, rel=0.02)   # held over 1 ms


@both
def test_values_come_from_files_prefixed_mapped_and_converted_and_the_outer_level_wins(tmp_path: Path, version: str) -> None:
    found = values(plain_ssp(tmp_path, version))
    assert found["first"] == {"u": 0.5, "wall": 0.04}         # u by way of the system's own connector, which nothing feeds
    assert found["inner_part_second"] == {"wall": pytest.approx(0.5), "error_from": 8.0}      # 2 x 250 ms over the 1 s set inside


def test_a_parameter_is_converted_before_it_is_transformed(tmp_path: Path) -> None:
    """SystemStructureCommon.xsd: "prior to the application of the linear transformation": 500 mm, doubled, and 0.1 m more are 1.1 m."""
    given, wanted = Parameter("p", 500.0, "mm", MILLIMETRES, Way(2.0, 0.1)), Variable("p", unit="m", dimension=METRES)
    archive: Any = SimpleNamespace(where="x.ssp")
    assert _in_unit(archive, "u.p", given, wanted) == pytest.approx(1.1)


def test_a_suppressed_unit_conversion_leaves_the_transformation_alone(tmp_path: Path) -> None:
    change = ('endConnector="in">', 'endConnector="in" suppressUnitConversion="true">')
    result = run_scenario(plain_ssp(tmp_path, changed=change), (), {"master": {"max_interval": 1e-3}})
    t = result.times[-1]                                      # u2 = 2·x1 + 1
    assert result.columns["inner_part_second.x"][-1] == pytest.approx(2.0 * t + 1.5 * t * t, rel=0.02)


def test_a_fixed_step_left_for_another_host_is_the_longest_interval(tmp_path: Path) -> None:
    step = (
        '<common:Annotations><common:Annotation type="com.opensimulationplatform">'
        '<osp:Algorithm xmlns:osp="http://opensimulationplatform.com/SSP/OSPAnnotations"><osp:FixedStepAlgorithm baseStepSize="2.5e-3"/>'
        "</osp:Algorithm></common:Annotation></common:Annotations></structure:DefaultExperiment>"
    ).replace("common:Annotations", "structure:Annotations")
    ssp = plain_ssp(tmp_path, changed=('stopTime="0.1"/>', f'stopTime="0.1">{step}'))
    assert read_scenario(ssp).table.master.max_interval == 2.5e-3


@pytest.mark.parametrize(("changed", "line"), [
    (('unit="ms"', 'unit="m"'), "plain.ssp: inner part.second.wall: is given in m, expects s; give it in that unit"),
    (('name="error_from"', 'name="errors_from"'),
     'plain.ssp: inner part.second: the FMU has no variable "errors_from"; did you mean "error_from"?'),
    (("resources/InMillimetres.fmu", "resources/InMillimeters.fmu"),
     'plain.ssp: inner part.second: "resources/InMillimeters.fmu" is not in the archive; did you mean "resources/InMillimetres.fmu"?'),
    (("resources/InMillimetres.fmu", "../InMillimetres.fmu"),
     'plain.ssp: inner part.second: source "../InMillimetres.fmu" is not inside the archive; put the file in and name it relative'),
    (('endElement="second"', 'endElement="secund"'),
     'plain.ssp: connection of inner part.secund.u: no element "secund"; did you mean "second"?'),
    (('endConnector="in"', 'endConnector="input"'),
     'plain.ssp: connection of inner part.input: no connector "input" there; did you mean "in"?'),
    (('name="x" kind="output"', 'name="x" kind="inout"'),
     "plain.ssp: first.x -> inner part.in: connects inout and input, this master connects outputs to inputs; remove it"),
    (('source="resources/InMillimetres.fmu"', 'source="resources/InMillimetres.fmu" type="application/x-ssp-package"'),
     'plain.ssp: inner part.second: is "application/x-ssp-package" from "resources/InMillimetres.fmu", this reader takes FMUs;'
     " put the system itself in its place"),
    (('<structure:Connections>\n      <structure:Connection startConnector="drive"',
      '<structure:SignalDictionaries><structure:SignalDictionary name="d"/></structure:SignalDictionaries>'
      '<structure:Connections>\n      <structure:Connection startConnector="drive"'),
     "plain.ssp: not valid SSP 1.0: line 51: Element 'Connections': This element is not expected. Expected is one of"
     " ( SystemGeometry, GraphicalElements, Annotations ); correct it there"),
    (("</structure:Connections>\n  </structure:System>",
      '</structure:Connections><structure:SignalDictionaries><structure:SignalDictionary name="d"/></structure:SignalDictionaries>'
      "</structure:System>"), "plain.ssp: system: uses a signal dictionary; connect the components themselves"),
    (('<common:LinearTransformation factor="2.0" offset="1.0"/>',
      '<common:IntegerMappingTransformation><common:MapEntry source="1" target="2"/></common:IntegerMappingTransformation>'),
     "plain.ssp: connection of first.x: has a IntegerMappingTransformation, this reader knows linear ones; do it in a unit"),
    (('startTime="0" stopTime="0.1"', 'startTime="0"'), "plain.ssp: does not say how long to run; give --stop-time SECONDS"),
])  # fmt: skip
def test_what_cannot_be_read_is_one_line_with_its_place(tmp_path: Path, changed: tuple[str, str], line: str) -> None:
    with pytest.raises(OrchestratorError) as caught:
        drawn(plain_ssp(tmp_path, changed=changed))
    assert str(caught.value) == line


def test_an_archive_without_a_description_says_so(tmp_path: Path) -> None:
    with pytest.raises(OrchestratorError, match=r"holds no SystemStructure\.ssd; is it an \.ssp\?"):
        drawn(packed(tmp_path / "empty.ssp", {"readme.txt": "nothing"}))


def test_two_units_of_one_file_name_are_two_in_an_archive() -> None:
    contents = Contents()
    members = [contents.fmu(Path(folder) / "my-gnc.fmu", folder) for folder in ("a", "b", "a")]
    assert members == ["resources/my-gnc.fmu", "resources/my-gnc-2.fmu", "resources/my-gnc.fmu"]
    assert contents.files[members[1]] == Path("b/my-gnc.fmu")
