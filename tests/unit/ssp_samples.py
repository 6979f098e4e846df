"""A plain SSP as another tool might write it: systems in systems, values in files of their own, a mapping, a linear transformation."""

import zipfile
from pathlib import Path

from fmi_c_sample import c_sample
from ssp_runs import packed

DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<structure:SystemStructureDescription xmlns:structure="http://ssp-standard.org/SSP1/SystemStructureDescription"
    xmlns:common="http://ssp-standard.org/SSP1/SystemStructureCommon"
    xmlns:set="http://ssp-standard.org/SSP1/SystemStructureParameterValues"
    version="VERSION" name="plain">
  <structure:System name="root">
    <structure:Connectors>
      <structure:Connector name="drive" kind="input"><common:REAL unit="m"/></structure:Connector>
    </structure:Connectors>
    <structure:ParameterBindings>
      <structure:ParameterBinding source="extra/shared.ssv">
        <structure:ParameterMapping source="extra/shared.ssm"/>
      </structure:ParameterBinding>
      <structure:ParameterBinding source="extra/first.ssv" prefix="first."/>
    </structure:ParameterBindings>
    <structure:Elements>
      <structure:Component name="first" source="resources/Integrator%20one.fmu">
        <structure:Connectors>
          <structure:Connector name="u" kind="input"><common:REAL unit="m"/></structure:Connector>
          <structure:Connector name="x" kind="output"><common:REAL unit="m"/></structure:Connector>
        </structure:Connectors>
      </structure:Component>
      <structure:System name="inner part">
        <structure:Connectors>
          <structure:Connector name="in" kind="input"><common:REAL unit="m"/></structure:Connector>
        </structure:Connectors>
        <structure:Elements>
          <structure:Component name="second" source="resources/InMillimetres.fmu">
            <structure:Connectors>
              <structure:Connector name="u" kind="input"><common:REAL unit="mm"/></structure:Connector>
            </structure:Connectors>
            <structure:ParameterBindings>
              <structure:ParameterBinding>
                <structure:ParameterValues>
                  <set:ParameterSet version="VERSION" name="inline">
                    <set:Parameters>
                      <set:Parameter name="wall"><set:REAL value="1.0"/></set:Parameter>
                      <set:Parameter name="error_from"><set:REAL value="8.0"/></set:Parameter>
                    </set:Parameters>
                  </set:ParameterSet>
                </structure:ParameterValues>
              </structure:ParameterBinding>
            </structure:ParameterBindings>
          </structure:Component>
        </structure:Elements>
        <structure:Connections>
          <structure:Connection startConnector="in" endElement="second" endConnector="u"/>
        </structure:Connections>
      </structure:System>
    </structure:Elements>
    <structure:Connections>
      <structure:Connection startConnector="drive" endElement="first" endConnector="u"/>
      <structure:Connection startElement="first" startConnector="x" endElement="inner part" endConnector="in">
        <common:LinearTransformation factor="2.0" offset="1.0"/>
      </structure:Connection>
    </structure:Connections>
  </structure:System>
  <structure:Units>
    <common:Unit name="m"><common:BaseUnit m="1"/></common:Unit>
    <common:Unit name="mm"><common:BaseUnit m="1" factor="1e-3"/></common:Unit>
  </structure:Units>
  <structure:DefaultExperiment startTime="0" stopTime="0.1"/>
</structure:SystemStructureDescription>
"""
SHARED = """<?xml version="1.0" encoding="UTF-8"?>
<ParameterSet xmlns="http://ssp-standard.org/SSP1/SystemStructureParameterValues"
    xmlns:common="http://ssp-standard.org/SSP1/SystemStructureCommon" version="VERSION" name="shared">
  <Parameters>
    <Parameter name="the wall"><REAL value="250" unit="ms"/></Parameter>
    <Parameter name="drive"><REAL value="0.5" unit="m"/></Parameter>
    <Parameter name="not ours"><REAL value="1"/></Parameter>
  </Parameters>
  <Units><common:Unit name="ms"><common:BaseUnit s="1" factor="1e-3"/></common:Unit>
  <common:Unit name="m"><common:BaseUnit m="1"/></common:Unit></Units>
</ParameterSet>
"""
MAPPING = """<?xml version="1.0" encoding="UTF-8"?>
<ParameterMapping xmlns="http://ssp-standard.org/SSP1/SystemStructureParameterMapping"
    xmlns:common="http://ssp-standard.org/SSP1/SystemStructureCommon" version="VERSION">
  <MappingEntry source="the wall" target="inner part.second.wall"><common:LinearTransformation factor="2"/></MappingEntry>
  <MappingEntry source="drive" target="drive"/>
</ParameterMapping>
"""
FIRST = """<?xml version="1.0" encoding="UTF-8"?>
<ParameterSet xmlns="http://ssp-standard.org/SSP1/SystemStructureParameterValues" version="VERSION" name="of the first">
  <Parameters>
    <Parameter name="wall"><REAL value="0.04"/></Parameter>
    <Parameter name="what others have"><REAL value="1"/></Parameter>
  </Parameters>
</ParameterSet>
"""


def texts(version: str = "1.0") -> dict[str, str]:
    """The documents, in the words of a version."""
    documents = {"SystemStructure.ssd": DESCRIPTION, "extra/shared.ssv": SHARED, "extra/shared.ssm": MAPPING, "extra/first.ssv": FIRST}
    real = "Real" if version.startswith("1") else "Float64"
    return {name: text.replace("VERSION", version).replace("REAL", real) for name, text in documents.items()}


def plain_ssp(folder: Path, version: str = "1.0", changed: tuple[str, str] = ("", "")) -> Path:
    """The .ssp: x' = 1 + u twice, u in m and in mm, steps that end at each multiple of `wall` s. One text may be changed."""
    documents = texts(version)
    assert any(changed[0] in text for text in documents.values())
    documents = {name: text.replace(*changed) if changed[0] else text for name, text in documents.items()}
    fmus = {"resources/Integrator one.fmu": in_unit(folder, "m"), "resources/InMillimetres.fmu": in_unit(folder, "mm")}
    return packed(folder / "plain.ssp", dict(documents), fmus)


def in_unit(folder: Path, unit: str) -> Path:
    """The C sample with a unit of measure on u and x, and one on its walls."""
    units = (
        '<UnitDefinitions><Unit name="m"><BaseUnit m="1"/></Unit><Unit name="mm"><BaseUnit m="1" factor="1e-3"/></Unit>'
        '<Unit name="s"><BaseUnit s="1"/></Unit></UnitDefinitions>\n  <ModelVariables>'
    )
    fmu = folder / f"in_{unit}.fmu"
    with zipfile.ZipFile(c_sample()) as old, zipfile.ZipFile(fmu, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name == "modelDescription.xml":
                text = content.decode().replace("<ModelVariables>", units).replace('<Real start="1e9"/>', '<Real start="1e9" unit="s"/>')
                text = text.replace('<Real start="0"/>', f'<Real start="0" unit="{unit}"/>').replace("<Real/>", f'<Real unit="{unit}"/>')
                content = text.encode()
            new.writestr(name, content)
    return fmu
