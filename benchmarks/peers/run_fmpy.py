"""FMPy: its SSP simulation, of an SSP written for the occasion."""

import shutil
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from types import SimpleNamespace
from xml.etree.ElementTree import Element, SubElement, tostring

import job
from fmpy.ssp import simulation
from fmpy.ssp.simulation import simulate_ssp

SSD, SSC = "http://ssp-standard.org/SSP1/SystemStructureDescription", "http://ssp-standard.org/SSP1/SystemStructureCommon"


def written(task, path):
    """A system structure description with the FMUs beside it."""
    root = Element("ssd:SystemStructureDescription", {"xmlns:ssd": SSD, "xmlns:ssc": SSC, "version": "1.0", "name": "benchmark"})
    system = SubElement(root, "ssd:System", {"name": "benchmark"})
    elements = SubElement(system, "ssd:Elements")
    with zipfile.ZipFile(path, "w") as archive:
        for fmu in sorted({unit["fmu"] for unit in task["units"]}):
            archive.write(fmu, f"resources/{Path(fmu).name}")
        for unit in task["units"]:
            source = f"resources/{Path(unit['fmu']).name}"
            about = {"name": unit["name"], "type": "application/x-fmu-sharedlibrary", "source": source}
            component = SubElement(elements, "ssd:Component", about)
            connectors = SubElement(component, "ssd:Connectors")
            for name, kind in sorted(ends(task, unit["name"])):
                connector = SubElement(connectors, "ssd:Connector", {"name": name, "kind": kind[0]})
                SubElement(connector, f"ssc:{kind[1]}")
        connections = SubElement(system, "ssd:Connections")
        for unit, name, _, _, target, taken, _, _ in task["links"]:
            ends_of = {"startElement": unit, "startConnector": name, "endElement": target, "endConnector": taken}
            SubElement(connections, "ssd:Connection", ends_of)
        archive.writestr("SystemStructure.ssd", tostring(root, encoding="UTF-8", xml_declaration=True))


def ends(task, unit):
    """A unit's connectors: (name, (kind, type)); what is watched is one too."""
    found = {(link[1], ("output", link[3])) for link in task["links"] if link[0] == unit}
    found |= {(link[5], ("input", link[7])) for link in task["links"] if link[4] == unit}
    return found | {(watched[1], ("output", "Real")) for watched in task["watch"] if watched[0] == unit}


def main():
    task = job.read()
    moments = {}
    instantiate, free = simulation.instantiate_fmu, simulation.free_fmu

    def instantiate_timed(*arguments, **options):
        instantiate(*arguments, **options)
        moments["begin"] = perf_counter()

    def free_timed(component):
        moments.setdefault("end", perf_counter())
        free(component)

    simulation.instantiate_fmu, simulation.free_fmu = instantiate_timed, free_timed
    start = [SimpleNamespace(name=f"{unit}.{name}", value=value) for unit, name, _, _, value in task["start"]]
    folder = TemporaryDirectory()
    path = Path(folder.name) / "benchmark.ssp"
    written(task, path)
    end = task["stop"] - 0.5 * task["step"]
    result = simulate_ssp(str(path), stop_time=end, step_size=task["step"], parameter_set=SimpleNamespace(parameters=start))
    values = {job.label(watched): [float(x) for x in result[job.label(watched)]] for watched in task["watch"]}
    shutil.rmtree(folder.name)
    # a row's values are those after the step, its time is that before it
    job.write([float(t) + task["step"] for t in result["time"]], values, moments["end"] - moments["begin"])


main()
